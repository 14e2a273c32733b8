// A golf ball's dimples where products of sines, or of cosines, of x, y and z are large: in the cells of a body-centred cubic
// lattice. For cages some two to four units large.
const float kBound = 0.03;

float height(vec3 p, vec2 st, float t) {
    vec3 s = sin(12.0 * p), c = cos(12.0 * p);
    float wave = max(abs(s.x * s.y * s.z), abs(c.x * c.y * c.z));
    return -kBound * smoothstep(0.18, 0.75, wave);
}
