// From cage units to clip space.
layout(constant_id = 5) const uint kShow = kShowShaded;

// The crack picture: vertices move aside when the parity of their position's bits is odd. Two samples that are meant to be one
// and differ in the last place then part visibly.
vec3 splitByParity(vec3 q) {
    uvec3 bits = floatBitsToUint(q);
    return (bitCount(bits.x ^ bits.y ^ bits.z) & 1) != 0 ? q + scene.crackShift : q;
}

vec4 project(vec3 position) {
    if (drawsShadow != 0u) return scene.worldToShadow * vec4(position, 1.0);
    if (kShow == kShowCracks) position = splitByParity(position);
    return scene.worldToClip * vec4(position, 1.0);
}
