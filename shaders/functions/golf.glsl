// A golf ball's dimples: sines of x, y and z, the sum of three of them cut off from below and rounded. For cages about two to
// four units large.
const float kBound = 0.03;

float height(vec3 p, vec2 st, float t) {
    vec3 s = sin(16.0 * p);
    float wave = (s.x * s.y + s.y * s.z + s.z * s.x) / 3.0; // -1/3 to 1
    float dimple = smoothstep(0.0, 0.6, wave);
    return -kBound * dimple;
}
