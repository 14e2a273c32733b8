// Waves on water: five trains of sines that run in different directions over x, y and z, the shorter the lower and the slower.
const float kBound = 0.1;

float height(vec3 p, vec2 st, float t) {
    const vec3 directions[5] = {vec3(0.8, 0.1, 0.6), vec3(-0.4, 0.3, 0.87), vec3(0.95, -0.2, -0.24),
                                vec3(-0.3, -0.9, 0.31), vec3(0.5, 0.7, -0.5)};
    float sum = 0.0, weight = 0.0, amplitude = 1.0, number = 4.0;
    for (int i = 0; i < 5; ++i) {
        // Deep water: the square of the frequency grows with the wave number.
        sum += amplitude * sin(number * dot(directions[i], p) - sqrt(9.81 * number) * 0.5 * t + 1.7 * float(i));
        weight += amplitude;
        amplitude *= 0.62;
        number *= 1.83;
    }
    return kBound * sum / weight;
}
