// Points of the displaced surface by name: (face,u,v) inside a face, (edge, k, N) and corners at their owner.
#ifndef RELIEF_DISPLACED_GLSL
#define RELIEF_DISPLACED_GLSL

#include "corners.glsl"
#include "heights.glsl"
#include "locations.glsl"
#include "shared/displacement.h"

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false; // else a face's own (u,v) stand in for them
layout(constant_id = kIdHasHeight) const bool kHasHeight = false;
layout(constant_id = kIdNormal) const uint kNormal = kNormalFull;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false; // something shades with the face's own texture coordinates

// --- normals --------------------------------------------------------------------------------------------------------

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

// The direction of m, or n where it has none. m grows with the square of heights and of their slopes: the square of
// its length may be past the range of floats where m itself is not.
vec3 unitOr(vec3 m, vec3 n) {
    float largest = max(abs(m.x), max(abs(m.y), abs(m.z)));
    if (!(largest > 1e-18 && largest < 1e18)) m /= largest;
    float square = dot(m, m);
    return square > 0.0 && !isinf(square) ? normalize(m) : n;
}

// A point of the limit surface, not displaced yet.
struct SurfacePoint {
    LimitFrame frame;
    TexFrame tex;
    vec3 n;          // unit normal
    float area;      // |p_u x p_v|; at a straight corner its derivative along the diagonal
    bool isStraight; // at a straight corner: p_u and p_v are parallel and nothing can be derived from them
    float stretch;   // what heights are multiplied with: 1 unless they stretch with the surface
    vec2 logStretch; // derivatives of its logarithm by (u,v)
};

// The normal asked for by --normal, not yet unit.
vec3 displacedNormal(SurfacePoint point, HeightSample height) {
    LimitFrame f = point.frame;
    vec3 n = point.n;
    float area = point.area;
    if (kNormal == kNormalLimit || !kHasHeight || point.isStraight) return n;
    vec2 dh = heightGradient(height.gradient, point.tex.jacobian);
    if (kStretches) dh += height.h * point.logStretch;
    if (kNormal == kNormalFirstOrder) return firstOrderNormal(n, f.pu, f.pv, dh);
    vec3 nu = normalDerivative(n, area, f.pu, f.pv, f.puu, f.puv);
    vec3 nv = normalDerivative(n, area, f.pu, f.pv, f.puv, f.pvv);
    return cross(displacedTangent(f.pu, n, nu, height.h, dh.x), displacedTangent(f.pv, n, nv, height.h, dh.y));
}

// --- the displaced surface ------------------------------------------------------------------------------------------

struct DisplacedSample {
    vec3 p;          // on the limit surface
    vec3 q;          // displaced
    vec3 normal;     // as --normal asks, unit; at a sharp edge the drawn face's own
    vec2 st;         // the drawn face's own
    float h;
    LimitFrame frame;
    vec3 n;          // unit limit normal of the frame
    vec2 gradient;   // (h_s, h_t)
    mat2 jacobian;   // of the texture coordinates
};

// The drawn face's texture coordinates where the point is evaluated at another face.
vec2 ownTexCoords(uint face, vec2 uv) {
    if (!kHasTexCoords) return uv;
    Leaf leaf = findLeaf(face, uv);
    return patchFrame(fetchPatch(leaf.patchIndex, inputs.model.pointsNow).texture, leaf.uv).p.xy;
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

// One call of patchFrame() in a loop: the compiler unfolds every call, and compiling is part of a cold start (COLDSTART).
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

SurfacePoint surfacePoint(PatchPoints patchPoints, Leaf leaf, vec2 uv, bool wantsTexture) {
    bool hasTexture = wantsTexture && kHasTexCoords && (kHasHeight || kWantsTexCoords);
    bool hasRest = kStretches && wantsTexture && kHasHeight;
    PointFrames frames = evaluateInOneCall(patchPoints, leaf, hasTexture, hasRest);
    SurfacePoint point;
    point.frame = frames.surface;
    point.tex = TexFrame(uv, mat2(1.0));
    if (hasTexture) point.tex = TexFrame(frames.texture.p.xy, mat2(frames.texture.pu.xy, frames.texture.pv.xy));
    point.stretch = 1.0;
    point.logStretch = vec2(0);
    precise vec3 normal = areaNormal(point.frame, patchPoints, leaf, uv, point.isStraight);
    precise float area = length(normal);
    precise vec3 n = normal / area;
    point.area = area;
    point.n = n;
    if (hasRest) {
        PatchPoints atRest = patchPoints;
        atRest.surface.array = inputs.model.pointsRest;
        bool isStraight;
        vec3 restNormal = areaNormal(frames.rest, atRest, leaf, uv, isStraight);
        addStretch(point, frames.rest, restNormal);
    }
    return point;
}

// What belongs to the face that a point is seen from.
void addAttributes(inout DisplacedSample s, SurfacePoint point, HeightSample height) {
    s.normal = displacedNormal(point, height);
    s.st = point.tex.st;
    s.frame = point.frame;
    s.n = point.n;
    s.gradient = height.gradient;
    s.jacobian = point.tex.jacobian;
}

HeightSample heightAt(SurfacePoint point, float level) {
    if (!kHasHeight) return HeightSample(0.0, vec2(0));
    HeightSample height = sampleHeight(point.tex.st, level);
    if (!kStretches) return height;
    precise float h = point.stretch * height.h;
    return HeightSample(h, point.stretch * height.gradient);
}

// Walks the faces that meet at the location, in the edge's fixed order: one of them where the surface is smooth, all where
// their normals differ and they need a shared direction. The faces of each sector between sharp edges share one vote, so that
// the direction does not jump from an edge to the corner at its end. The first face is the owner: it gives the point and the
// height. `pose`: the texel where the pose's points begin.
DisplacedSample displacedInPose(uint face, vec2 faceUV, SampleLocation location, uint pose) {
#ifdef RELIEF_MUTANT_OWNER // a test of the tests: one edge of sixteen is evaluated at whatever face is drawn
    Incidence o = location.owner;
    if (!location.isInside && o.start != o.end && (kSideCount * o.face + o.side) % 16u == 0u) location = insideLocation(face, faceUV);
#endif
    DisplacedSample s;
    precise vec3 direction = vec3(0);
    vec3 ownersNormal = vec3(0);
    uint count = max(location.incidenceCount, 1u);
    bool isOwn = false;
    for (uint i = 0u; i < count; ++i) {
        Incidence incidence = location.owner;
        float share = 1.0;
        if (location.incidenceCount > 0u) {
            incidence = fetchIncidence(location.firstIncidence + i);
            if (incidence.start == incidence.end) share = sectorShare(location.firstIncidence + i);
        }
        vec2 uv = location.isInside ? location.uv : incidencePoint(incidence, location.t);
        bool isIncidenceOfFace = incidence.face == face && !isOwn;
        bool isUsed = i == 0u || isIncidenceOfFace;
        Leaf leaf = findLeaf(incidence.face, uv);
        SurfacePoint point = surfacePoint(fetchPatch(leaf.patchIndex, pose), leaf, uv, isUsed);
        direction += share * point.n;
        if (isUsed) {
            isOwn = incidence.face == face;
            HeightSample height = heightAt(point, location.level);
            if (i == 0u) {
                s.p = point.frame.p;
                s.h = height.h;
                ownersNormal = point.n;
            }
            addAttributes(s, point, height);
        }
    }
    // Normals that cancel (a fin, faces of opposite winding): the owner's.
    if (count > 1u) direction = dot(direction, direction) > 1e-6 ? normalize(direction) : ownersNormal;
    precise vec3 q = displacedPoint(s.p, direction, s.h);
    s.q = q;
    s.normal = unitOr(s.normal, s.n);
    if (kWantsTexCoords && !isOwn) s.st = ownTexCoords(face, faceUV);
    return s;
}

DisplacedSample displaced(uint face, vec2 faceUV, SampleLocation location) {
    return displacedInPose(face, faceUV, location, inputs.model.pointsNow);
}

// A point inside a face whose leaf is known: what displaced() gives there, without the search.
DisplacedSample displacedInLeaf(PatchPoints patchPoints, Leaf leaf, vec2 uv, float level) {
    DisplacedSample s;
    SurfacePoint point = surfacePoint(patchPoints, leaf, uv, true);
    HeightSample height = heightAt(point, level);
    addAttributes(s, point, height);
    s.p = point.frame.p;
    s.h = height.h;
    precise vec3 q = displacedPoint(s.p, s.n, s.h);
    s.q = q;
    s.normal = unitOr(s.normal, s.n);
    return s;
}
#endif
