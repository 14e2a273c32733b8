// From a model's own space to clip space and to the world.
#ifndef RELIEF_PROJECT_GLSL
#define RELIEF_PROJECT_GLSL

layout(constant_id = kIdIsPlaced) const bool kIsPlaced = false;

vec3 worldNormal(vec3 normal) { return kIsPlaced ? inputs.view.normalToWorld * normal : normal; }

// A gradient with a slope in w.
vec4 worldGradient(vec4 gradient) { return vec4(worldNormal(gradient.xyz), gradient.w); }

// A gradient of three functions, whose columns are their derivatives along the axes.
mat3 worldGradients(mat3 gradients) { return kIsPlaced ? gradients * transpose(inputs.view.normalToWorld) : gradients; }

// The crack picture: vertices move aside when the parity of their position's bits is odd. Two samples that are meant to
// be one and differ in the last bit then separate visibly.
vec3 splitByParity(vec3 q) {
    uvec3 bits = floatBitsToUint(q);
    return (bitCount(bits.x ^ bits.y ^ bits.z) & 1) != 0 ? q + inputs.view.crackShift : q;
}

vec4 project(vec3 position) {
    if (kPass == kPassShadow) return inputs.light.toShadow * vec4(position, 1.0);
    if (kPass == kPassCracks) position = splitByParity(position);
    return inputs.view.toClip * vec4(position, 1.0);
}
#endif
