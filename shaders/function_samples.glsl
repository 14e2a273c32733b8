// Heights of a function at points of the surface, and their slopes.
#ifndef RELIEF_FUNCTION_SAMPLES_GLSL
#define RELIEF_FUNCTION_SAMPLES_GLSL

// How far along u or v the function's slope is taken: inputs.model.heightStep on the surface at rest, no more than 1/64 of a
// patch of the base, where its tangent vanishes.
float slopeStep(vec3 tangent) {
    float size = length(tangent);
    return size > 64.0 * inputs.model.heightStep ? inputs.model.heightStep / size : 1.0 / 64.0;
}

// h by the function, and (h_u, h_v) by central differences along the tangents: h_u = (h(p + d p_u, st + d st_u) - h(p - d p_u,
// st - d st_u)) / 2d. Where fragments add all slopes, there are none here. One call in a loop: the compiler unfolds every one.
HeightSample sampleFunction(LimitFrame rest, TexFrame tex) {
    vec2 d = vec2(slopeStep(rest.pu), slopeStep(rest.pv));
    HeightSample s = HeightSample(0.0, vec2(0));
    for (uint i = 0u; i < (kNormal == kNormalLimit || kHasSlopes ? 1u : 5u); ++i) {
        float along = i == 0u ? 0.0 : (i & 1u) == 1u ? 1.0 : -1.0;
        vec2 step = along * (i < 3u ? vec2(d.x, 0.0) : vec2(0.0, d.y));
        precise vec3 p = rest.p + step.x * rest.pu + step.y * rest.pv;
        precise vec2 st = tex.st + tex.jacobian * step;
        float h = heightOfFunction(p, kHasTexCoords ? st : vec2(0));
        if (i == 0u) s.h = h;
        else s.gradient += along * h * (i < 3u ? vec2(0.5 / d.x, 0.0) : vec2(0.0, 0.5 / d.y));
    }
    return s;
}
#endif
