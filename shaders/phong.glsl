// Shading with dot products and with pictures: Hart, "Displacement Mapping" and its chapter 16, eq. 16.14 and 16.20 to 16.22.
#ifndef RELIEF_PHONG_GLSL
#define RELIEF_PHONG_GLSL

layout(set = 0, binding = kBindShading) uniform sampler2D shadingPicture; // the table, or the ball of a matcap

// What ambient and diffuse light is multiplied with the albedo by, and the highlight: c = k_a c_a + k_d c_d (n.l) + k_s c_s
// (v.r)^e (eq. 16.20), with c_a = c_d the albedo and c_s white. Dot products below 0 count as 0.
vec2 phongWeights(vec2 dots) {
    vec2 s = max(dots, vec2(0));
    vec4 k = inputs.light.phong;
    return vec2(k.x + k.y * s.x, s.y > 0.0 ? k.z * pow(s.y, k.w) : 0.0);
}

// The same from the table, at s = n.l and t = v.r (eq. 16.22); centres of texels are at 0 and 1.
vec2 tableWeights(vec2 dots) {
    float side = float(kShadingTableSide);
    return textureLod(shadingPicture, (clamp(dots, 0.0, 1.0) * (side - 1.0) + 0.5) / side, 0.0).xy;
}

// `n`: with kShadingVertexTable the two dot products.
vec3 phong(vec3 position, vec3 n, vec3 v, vec3 albedo) {
    vec3 l = inputs.light.keyDirection;
    vec2 dots = kShading == kShadingVertexTable ? n.xy : vec2(dot(n, l), dot(v, reflect(-l, n)));
    vec2 weights = kShading == kShadingPhong ? phongWeights(dots) : tableWeights(dots);
    // In shadow what is left is the ambient light, which further lights do not bring once more.
    vec2 ambient = vec2(inputs.light.phong.x, 0.0);
    vec2 lit = (weights - ambient) * keyVisibility(position, kShading == kShadingVertexTable ? v : n);
    if (!kAddsLight) lit += ambient;
    return inputs.light.keyRadiance / kPi * (albedo * lit.x + lit.y);
}

// The picture of a ball at the point that has the normal's direction as seen by the eye (eq. 16.14). The axes are those of the
// line of sight through the pixel, so that every normal that faces the eye lies in the ball.
vec3 matcap(vec3 n, vec3 v) {
    vec3 up = -vec3(inputs.view.toClip[0].y, inputs.view.toClip[1].y, inputs.view.toClip[2].y);
    vec3 right = normalize(cross(up, v));
    vec2 at = vec2(dot(n, right), dot(n, cross(v, right)));
    at /= max(1.0, length(at));
    return textureLod(shadingPicture, vec2(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y), 0.0).rgb;
}
#endif
