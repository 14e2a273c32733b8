// Shadows of the key light, which has the shadow map.
#ifndef RELIEF_KEY_VISIBILITY_GLSL
#define RELIEF_KEY_VISIBILITY_GLSL

layout(constant_id = kIdReadsShadowCodes) const bool kReadsShadowCodes = false; // else an image

layout(set = 0, binding = kBindShadow) uniform sampler2D shadowMap; // reversed depth from the key light
RELIEF_TABLE(kBindShadowCodes, uint, shadowCode)

// The depth of what the key light meets first, at a place in the shadow map of 0..1 each way.
float shadowDepth(vec2 at) {
    if (!kReadsShadowCodes) return textureLod(shadowMap, at, 0.0).r;
    ivec2 texel = clamp(ivec2(floor(at * float(inputs.light.shadowSide))), 0, int(inputs.light.shadowSide) - 1);
    return float(shadowCode(uint(texel.y) * inputs.light.shadowSide + uint(texel.x))) / kShadowCodes;
}

// Share of the key light that arrives: eight samples of the shadow map on a spiral, turned from pixel to pixel by interleaved
// gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014).
float keyVisibility(vec3 position, vec3 n) {
    if (inputs.light.hasShadows == 0.0) return 1.0;
    // The radius of the disc is shadowSoftness; at its rim a tilted surface lies as much deeper as the sine of its tilt.
    float tilt = length(cross(n, inputs.light.keyDirection));
    vec4 clip = inputs.light.toShadow * vec4(position + n * inputs.light.shadowBias * (0.5 + 2.0 * tilt), 1.0);
    float angle = 2.0 * kPi * fract(52.9829189 * fract(dot(vec2(gl_GlobalInvocationID.xy), vec2(0.06711056, 0.00583715))));
    vec2 spoke = inputs.light.shadowSoftness * vec2(cos(angle), sin(angle));
    const mat2 goldenTurn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
    float lit = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec2 at = clip.xy * 0.5 + 0.5 + spoke * sqrt((float(i) + 0.5) * 0.125);
        lit += shadowDepth(at) <= clip.z ? 0.125 : 0.0;
        spoke = goldenTurn * spoke;
    }
    return lit;
}
#endif
