// Light of the environment, by direction.
#ifndef RELIEF_ENVIRONMENT_GLSL
#define RELIEF_ENVIRONMENT_GLSL

layout(set = 0, binding = kBindEnvironment) uniform sampler2D environmentMap; // equirectangular

const float kPi = 3.14159265;

// Ramamoorthi and Hanrahan (2001), eq. 13, with the cosine lobe and basis constants folded into the coefficients.
vec3 irradiance(vec3 n) {
    return max(vec3(0), inputs.light.irradiance[0] + inputs.light.irradiance[1] * n.y + inputs.light.irradiance[2] * n.z +
                            inputs.light.irradiance[3] * n.x + inputs.light.irradiance[4] * (n.x * n.y) +
                            inputs.light.irradiance[5] * (n.y * n.z) + inputs.light.irradiance[6] * (3.0 * n.z * n.z - 1.0) +
                            inputs.light.irradiance[7] * (n.x * n.z) + inputs.light.irradiance[8] * (n.x * n.x - n.y * n.y));
}

// Where a direction lies in the turned environment. The azimuth of its columns grows clockwise.
vec2 equirectangular(vec3 d) {
    return vec2(atan(d.x, -d.z) / (2.0 * kPi) + 0.5 + inputs.light.environmentTurn, acos(clamp(d.y, -1.0, 1.0)) / kPi);
}

// Integrated specular albedo: Karis, "Physically Based Shading on Mobile" (2014), his fit of the split sum.
vec3 environmentBrdf(vec3 f0, float roughness, float nv) {
    vec4 r = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * ab.x + ab.y;
}
#endif
