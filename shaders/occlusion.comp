#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#include "seen_samples.glsl"

// How much of its half space each pixel sees past the surface around it, weighted by the cosine: horizons in the depths of
// the picture on both sides of four slices through the line of sight (Jimenez et al., "Practical Real-Time Strategies for
// Accurate Indirect Occlusion", 2016, eq. 7). Depths are those of the displaced surface.
layout(local_size_x = 8, local_size_y = 8) in;

const float kPi = 3.14159265;
const int kSlices = 4, kSteps = 12;

vec3 positionOf(vec2 pixel, float depth) {
    vec4 world = inputs.view.fromClip * vec4(pixel / vec2(inputs.view.pictureSize) * 2.0 - 1.0, depth, 1.0);
    return world.xyz / world.w;
}

// The cosine of the angle between v and the horizon on one side of the slice. Occluders fade out in the outer half of the radius.
float horizonCosine(vec3 position, vec3 v, vec2 from, vec2 stride, float jitter, float lowest) {
    float highest = lowest;
    for (int i = 0; i < kSteps; ++i) {
        // Steps grow: near occluders need the finer ones.
        float along = (float(i) + jitter) / float(kSteps);
        vec2 there = floor(from + stride * along * along + sign(stride)) + 0.5;
        if (any(lessThan(there, vec2(0))) || any(greaterThanEqual(there, vec2(inputs.view.pictureSize)))) break;
        float depth = seenAt(ivec2(there), 0).depth;
        if (depth == 0.0) continue;
        vec3 d = positionOf(there, depth) - position;
        float far = length(d) / inputs.light.occlusionRadius;
        float cosine = dot(d, v) / max(length(d), 1e-20);
        highest = max(highest, mix(cosine, lowest, clamp(2.0 * far - 1.0, 0.0, 1.0)));
    }
    return highest;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = inputs.view.pictureSize;
    if (any(greaterThanEqual(at, size))) return;
    Seen here = seenAt(at, 0);
    for (int i = 1; i < 4; ++i) {
        Seen other = seenAt(at, i);
        if (other.depth > here.depth) here = other;
    }
    int index = 2 * (at.y * size.x + at.x);
    inputs.targets.occlusion.at[index] = 1.0;
    inputs.targets.occlusion.at[index + 1] = here.depth;
    if (here.depth == 0.0) return;

    vec2 pixel = vec2(at) + 0.5;
    vec3 position = positionOf(pixel, here.depth), toEye = inputs.view.eye - position, v = normalize(toEye), n = here.normal;
    // Pixels that the radius covers at this distance, 256 at most: the length of a unit step up in the picture.
    vec3 down = vec3(inputs.view.toClip[0].y, inputs.view.toClip[1].y, inputs.view.toClip[2].y);
    float w = dot(vec4(position, 1.0), vec4(inputs.view.toClip[0].w, inputs.view.toClip[1].w, inputs.view.toClip[2].w,
                                            inputs.view.toClip[3].w));
    float radius = min(0.5 * float(size.y) * length(down) * inputs.light.occlusionRadius / max(w, 1e-20), 256.0);

    // Slices are turned from pixel to pixel; 4 x 4 pixels have all turns.
    float turn = float((at.x & 3) * 4 + (at.y & 3)) / 16.0, open = 0.0;
    float jitter = float((at.x * 5 + at.y * 3) & 3) / 4.0 + 0.25;
    for (int slice = 0; slice < kSlices; ++slice) {
        float angle = kPi * (float(slice) + turn) / float(kSlices);
        vec2 along = vec2(cos(angle), sin(angle));
        // The plane of the slice holds v and the direction along it; the normal is projected into it.
        vec3 aside = positionOf(pixel + along, here.depth) - position;
        vec3 tangent = normalize(aside - dot(aside, v) * v), axis = cross(tangent, v);
        vec3 projected = n - dot(n, axis) * axis;
        float length_ = max(length(projected), 1e-6);
        float gamma = sign(dot(projected, tangent)) * acos(clamp(dot(projected, v) / length_, -1.0, 1.0));
        // Horizons to both sides, not below the surface's own half space.
        float lowest1 = cos(gamma + 0.5 * kPi), lowest2 = cos(gamma - 0.5 * kPi);
        float h1 = acos(clamp(horizonCosine(position, v, pixel, along * radius, jitter, lowest1), -1.0, 1.0));
        float h2 = -acos(clamp(horizonCosine(position, v, pixel, -along * radius, jitter, lowest2), -1.0, 1.0));
        h1 = gamma + min(h1 - gamma, 0.5 * kPi);
        h2 = gamma + max(h2 - gamma, -0.5 * kPi);
        float arc = 0.25 * (-cos(2.0 * h1 - gamma) + cos(gamma) + 2.0 * h1 * sin(gamma)) +
                    0.25 * (-cos(2.0 * h2 - gamma) + cos(gamma) + 2.0 * h2 * sin(gamma));
        open += length_ * arc / float(kSlices);
    }
    inputs.targets.occlusion.at[index] = clamp(open, 0.0, 1.0);
}
