// Points of a pose, ten bits finer than floats (src/README.md, "Rounding").
#ifndef RELIEF_POINTS_GLSL
#define RELIEF_POINTS_GLSL

#include "shared/points.h"

// One step of a remainder, by the exponent of the largest coordinate.
float remainderStep(vec3 p) {
    uint exponent = floatBitsToUint(max(abs(p.x), max(abs(p.y), abs(p.z)))) & 0x7f800000u;
    return kRemainderStep * uintBitsToFloat(max(exponent, 64u << 23));
}

// What xyz leaves of a point.
vec3 remainderOf(vec4 point) {
    uint bits = floatBitsToUint(point.w);
    return remainderStep(point.xyz) * (vec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20) - 512.0);
}

// origin + coarse + fine, where `fine` is much shorter than the others. Both sums are exact but for the remainder's last bit
// (Knuth 1969, section 4.2.2).
vec4 finePoint(vec3 origin, vec3 coarse, vec3 fine) {
    precise vec3 sum = origin + coarse, added = sum - origin;
    precise vec3 left = (origin - (sum - added)) + (coarse - added) + fine;
    precise vec3 p = sum + left, remainder = left - (p - sum);
    uvec3 steps = uvec3(clamp(round(remainder / remainderStep(p)) + 512.0, 12.0, 1012.0));
    return vec4(p, uintBitsToFloat(steps.x | steps.y << 10 | steps.z << 20));
}

// Returns a - b, with what their floats leave.
vec3 pointDifference(vec4 a, vec4 b) {
    precise vec3 d = (a.xyz - b.xyz) + (remainderOf(a) - remainderOf(b));
    return d;
}
#endif
