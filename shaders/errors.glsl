// How far triangles are from the surface that they stand for. Included after displaced.glsl.
#ifndef RELIEF_ERRORS_GLSL
#define RELIEF_ERRORS_GLSL

// A fragment at a side of a face may have its centre beside it.
vec2 pointInFace(vec2 uv) {
    uv = clamp(uv, 0.0, 1.0);
#ifdef RELIEF_TRIANGLES
    uv /= max(uv.x + uv.y, 1.0);
#endif
    return uv;
}

// The distance of a point of a triangle from the tangent plane of the surface at the same (face,u,v), positive outside: it differs
// from the distance to the surface by the square of how far along the surface the two points are apart. The surface has the full
// map, at no mip level.
float signedDistance(uint face, vec2 uv, vec3 point) {
    uv = pointInFace(uv);
    SampleLocation location = insideLocation(face, uv);
    location.level = 0.0;
    DisplacedSample there = displaced(face, uv, location);
    return dot(there.normal, point - there.q);
}

// A point of the picture in the model's own space.
vec3 positionAt(vec2 ndc, float depth) {
    vec4 position = inputs.view.fromClip * vec4(ndc, depth, 1.0);
    return position.xyz / position.w;
}

// How wide a pixel is there.
float pixelWidth(vec2 ndc, float depth) {
    return length(positionAt(ndc + vec2(0.0, 2.0 / float(inputs.view.pictureSize.y)), depth) - positionAt(ndc, depth));
}
#endif
