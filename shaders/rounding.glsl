// How numbers are rounded before they are stored in formats of fewer bits. Drivers convert to those formats each in its own
// way, some with approximate instructions of the processor, so the same picture would differ from one machine to the next.
// Rounded here to what the format holds, a number has nothing left that a driver could round.
#ifndef RELIEF_ROUNDING_GLSL
#define RELIEF_ROUNDING_GLSL

// 11 significant bits, halves away from zero: a half float (magnitudes of 6e-5 to 65504).
vec2 roundToHalf(vec2 x) { return uintBitsToFloat((floatBitsToUint(x) + 0x1000u) & 0xffffe000u); }

// packHalf2x16 of numbers that halves hold.
uint packHalves(vec2 x) { return packHalf2x16(roundToHalf(x)); }

// Colors of 0..1 in ten bits per channel: light as its square root, which spends codes on the dark as the eye does; the colors
// of --show as they are. A code's own value is written, half a code from where a conversion could go wrong.
const float kColorCodes = 1023.0;
vec3 storedColor(vec3 color, bool isLight) {
    vec3 c = clamp(color, 0.0, 1.0);
    return floor(kColorCodes * (isLight ? sqrt(c) : c) + 0.5) / kColorCodes;
}
vec3 colorOfStored(vec3 stored, bool isLight) { return isLight ? stored * stored : stored; }
#endif
