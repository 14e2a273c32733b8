// Fractal noise: six octaves of value noise, each of half the height and twice the frequency (Perlin 1985; Musgrave, "Texturing
// and Modeling", chapter 14). Lattice values come from integers, so that all devices have the same.
const float kBound = 0.1;
const int kOctaves = 6;

float latticeValue(ivec3 cell) {
    uvec3 x = uvec3(cell);
    uint h = x.x * 0x8da6b343u ^ x.y * 0xd8163841u ^ x.z * 0xcb1ab31fu;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    h ^= h >> 15u;
    return float(h >> 8u) / 8388607.5 - 1.0; // -1 to 1
}

// Twice differentiable: the weights are quintics (Perlin 2002).
float noise(vec3 p) {
    vec3 whole = floor(p), f = p - whole;
    vec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    ivec3 cell = ivec3(whole);
    float sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 side = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 share = mix(1.0 - w, w, vec3(side));
        sum += share.x * share.y * share.z * latticeValue(cell + side);
    }
    return sum;
}

float height(vec3 p, vec2 st, float t) {
    float sum = 0.0, amplitude = 0.5;
    for (int octave = 0; octave < kOctaves; ++octave) {
        sum += amplitude * noise(p + 17.31 * float(octave));
        p *= 2.0;
        amplitude *= 0.5;
    }
    return kBound * sum; // the amplitudes add up to less than 1
}
