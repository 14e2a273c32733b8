// A point of the limit surface with its normal, its texture coordinates, and how far it has stretched since rest.
#ifndef RELIEF_SURFACE_POINT_GLSL
#define RELIEF_SURFACE_POINT_GLSL

#include "corners.glsl"
#include "shared/displacement.h"

// A point of the limit surface, not displaced yet.
struct SurfacePoint {
    uint face;
    vec2 uv;
    LimitFrame frame;
    TexFrame tex;
    vec3 texSecond;  // vector maps of tangent space: t_uu, t_uv and t_vv
    vec3 n;          // unit normal
    float area;      // |p_u x p_v|; at a straight corner its derivative along the diagonal
    bool isStraight; // at a straight corner: p_u and p_v are parallel and nothing can be derived from them
    float stretch;   // what heights are multiplied with: 1 unless they stretch with the surface
    vec2 logStretch; // derivatives of its logarithm by (u,v)
#ifdef RELIEF_HEIGHT_FUNCTION
    LimitFrame rest; // the frame at rest: what the function is given
#endif
};

bool spansPlane(vec3 a, vec3 b) {
    vec3 c = cross(a, b);
    return dot(c, c) > kParallel * kParallel * dot(a, a) * dot(b, b);
}

// Where p_u and p_v are parallel or vanish (coincident corners, cusps, smooth corners) they are taken a little towards
// the face's centre, a sixteenth of the leaf patch, by their own derivatives: never NaN.
void repairTangents(inout LimitFrame f, vec2 uv, float leafScale) {
    if (spansPlane(f.pu, f.pv)) return;
#ifdef RELIEF_TRIANGLES
    vec2 inwards = (vec2(1.0 / 3.0) - uv) / (16.0 * abs(leafScale));
#else
    vec2 inwards = (vec2(0.5) - uv) / (16.0 * abs(leafScale));
#endif
    f.pu += f.puu * inwards.x + f.puv * inwards.y;
    f.pv += f.puv * inwards.x + f.pvv * inwards.y;
    if (spansPlane(f.pu, f.pv)) return;
    f.pu = vec3(1, 0, 0);
    f.pv = vec3(0, 0, -1);
}

// p_u x p_v, or what stands for it where it vanishes: at straight corners its derivative along the diagonal; elsewhere p_u and
// p_v are repaired.
vec3 areaNormal(inout LimitFrame f, PatchPoints patchPoints, Leaf leaf, vec2 uv, out bool isStraight) {
    isStraight = false;
#ifdef RELIEF_MEETS_CORNERS
    if (kHasStraightCorners) {
        vec3 straight = straightCornerNormal(patchPoints, leaf.uv);
        isStraight = straight != vec3(0);
        if (isStraight) return straight;
    }
#endif
    repairTangents(f, uv, leaf.scale);
    precise vec3 normal = cross(f.pu, f.pv);
    return normal;
}

// How much the surface has grown since rest, as a length; `restNormal` is the rest pose's areaNormal.
void addStretch(inout SurfacePoint point, LimitFrame rest, vec3 restNormal) {
    precise float restArea = length(restNormal);
    precise float stretch = stretchOf(point.area, restArea);
    point.stretch = stretch;
    if (stretch >= kMostStretch || point.isStraight) return;
    LimitFrame f = point.frame;
    vec3 n0 = restNormal / restArea;
    vec2 areaSlope = vec2(areaDerivative(point.n, f.pu, f.pv, f.puu, f.puv), areaDerivative(point.n, f.pu, f.pv, f.puv, f.pvv));
    vec2 restSlope = vec2(areaDerivative(n0, rest.pu, rest.pv, rest.puu, rest.puv),
                          areaDerivative(n0, rest.pu, rest.pv, rest.puv, rest.pvv));
    point.logStretch = 0.5 * (areaSlope / point.area - restSlope / restArea);
}

// The frames of the surface, of its texture coordinates and of its rest pose at one point, as far as they are asked for.
struct PointFrames {
    LimitFrame surface, texture, rest;
};

// One call of patchFrame() in a loop: the compiler unfolds every call, and compiling is part of a cold start. Three calls
// instead cost 0.2 to 0.3 of 2.6 seconds more on Mesa's CPU driver (octopus with map, diced, no shader cache).
PointFrames evaluateInOneCall(PatchPoints patchPoints, Leaf leaf, bool wantsTexture, bool wantsRest) {
    PointFrames frames = PointFrames(kNoFrame, kNoFrame, kNoFrame);
    uint textureTurn = wantsTexture ? 1u : 0u, restTurn = textureTurn + (wantsRest ? 1u : 0u);
    for (uint turn = 0u; turn <= restTurn; ++turn) {
        bool isTexture = turn > 0u && turn == textureTurn;
        ControlPoints points = patchPoints.surface;
        if (isTexture) points = patchPoints.texture;
        else if (wantsRest && turn == restTurn) points = inPose(points, inputs.model.pointsRest);
        LimitFrame f = byFace(patchFrame(points, leaf.uv), leaf.scale);
        if (turn == 0u) frames.surface = f;
        else if (isTexture) frames.texture = f;
        else frames.rest = f;
    }
    return frames;
}

#ifndef RELIEF_TRIANGLES

// What evaluateInOneCall() gives where both patches are bicubic: code for nothing else.
PointFrames evaluateBicubic(PatchPoints patchPoints, Leaf leaf, bool wantsTexture, bool wantsRest) {
    PointFrames frames = PointFrames(byFace(bicubicFrame(patchPoints.surface, leaf.uv), leaf.scale), kNoFrame, kNoFrame);
    if (wantsTexture) frames.texture = byFace(regularTexture(patchPoints.texture, leaf.uv), leaf.scale);
    if (wantsRest) frames.rest = byFace(bicubicFrame(inPose(patchPoints.surface, inputs.model.pointsRest), leaf.uv), leaf.scale);
    return frames;
}
#endif

bool readsRest() { return kReadsRest && (kHasHeight || kHasTexGradients); }

SurfacePoint surfacePointOf(PointFrames frames, PatchPoints patchPoints, Leaf leaf, vec2 uv, bool hasTexture, bool hasRest) {
    SurfacePoint point;
    point.face = leaf.face;
    point.uv = uv;
    point.frame = frames.surface;
    point.tex = TexFrame(uv, mat2(1.0));
    if (hasTexture) point.tex = TexFrame(frames.texture.p.xy, mat2(frames.texture.pu.xy, frames.texture.pv.xy));
    point.texSecond = hasTexture ? vec3(frames.texture.puu.y, frames.texture.puv.y, frames.texture.pvv.y) : vec3(0);
    point.stretch = 1.0;
    point.logStretch = vec2(0);
    precise vec3 normal = areaNormal(point.frame, patchPoints, leaf, uv, point.isStraight);
    precise float area = length(normal);
    precise vec3 n = normal / area;
    point.area = area;
    point.n = n;
#ifdef RELIEF_HEIGHT_FUNCTION
    point.rest = hasRest ? frames.rest : frames.surface;
#endif
    if (hasRest && kStretches) {
        PatchPoints atRest = patchPoints;
        atRest.surface.array = inputs.model.pointsRest;
        bool isStraight;
        vec3 restNormal = areaNormal(frames.rest, atRest, leaf, uv, isStraight);
        addStretch(point, frames.rest, restNormal);
    }
    return point;
}

SurfacePoint surfacePoint(PatchPoints patchPoints, Leaf leaf, vec2 uv, bool wantsTexture) {
    bool hasTexture = wantsTexture && readsTexCoords(), hasRest = wantsTexture && readsRest();
    return surfacePointOf(evaluateInOneCall(patchPoints, leaf, hasTexture, hasRest), patchPoints, leaf, uv, hasTexture, hasRest);
}
#endif
