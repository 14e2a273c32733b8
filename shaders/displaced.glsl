// Points of the displaced surface by name: (face,u,v) inside a face, (edge, k, N) and corners at their owner.
#ifndef RELIEF_DISPLACED_GLSL
#define RELIEF_DISPLACED_GLSL

#include "locations.glsl"
#include "vectors.glsl"

layout(constant_id = kIdNormal) const uint kNormal = kNormalFull;
layout(constant_id = kIdHasSlopes) const bool kHasSlopes = false; // fragments bend normals by all slopes: vertices do not
#ifdef RELIEF_HEIGHT_FUNCTION
#include "function_samples.glsl"
#endif

// --- normals --------------------------------------------------------------------------------------------------------

// The direction of m, or n where it has none. m grows with the square of heights and of their slopes: the square of
// its length may be past the range of floats where m itself is not.
vec3 unitOr(vec3 m, vec3 n) {
    float largest = max(abs(m.x), max(abs(m.y), abs(m.z)));
    if (!(largest > 1e-18 && largest < 1e18)) m /= largest;
    float square = dot(m, m);
    return square > 0.0 && !isinf(square) ? normalize(m) : n;
}

// (h_u, h_v)
vec2 heightDerivatives(SurfacePoint point, HeightSample height) {
#ifdef RELIEF_HEIGHT_FUNCTION
    vec2 dh = height.gradient;
#else
    vec2 dh = kMapAddressing == kMapOfFaces ? height.gradient : heightGradient(height.gradient, point.tex.jacobian);
#endif
    if (kStretches) dh += height.h * point.logStretch;
    return dh;
}

// The normal asked for by --normal, not yet unit.
vec3 displacedNormal(SurfacePoint point, Displacement d) {
    LimitFrame f = point.frame;
    vec3 n = point.n;
    float area = point.area;
    if (kNormal == kNormalLimit || !kHasHeight || point.isStraight) return n;
    if (kVectorSpace != kVectorNone) {
        vec3 qu, qv;
        vectorTangents(point, d.vector, kNormal == kNormalFull, qu, qv);
        return cross(qu, qv);
    }
    HeightSample height = d.height;
    vec2 dh = heightDerivatives(point, height);
    if (kNormal == kNormalFirstOrder) return firstOrderNormal(n, f.pu, f.pv, dh);
    vec3 nu = normalDerivative(n, area, f.pu, f.pv, f.puu, f.puv);
    vec3 nv = normalDerivative(n, area, f.pu, f.pv, f.puv, f.pvv);
    return cross(displacedTangent(f.pu, n, nu, height.h, dh.x), displacedTangent(f.pv, n, nv, height.h, dh.y));
}

// p_u and p_v become q_u and q_v; with first-order normals those of a surface whose n does not change.
void displaceTangents(SurfacePoint point, Displacement d, inout vec3 pu, inout vec3 pv) {
    if (kVectorSpace != kVectorNone) {
        vectorTangents(point, d.vector, kNormal == kNormalFull, pu, pv);
        return;
    }
    LimitFrame f = point.frame;
    HeightSample height = d.height;
    vec2 dh = heightDerivatives(point, height);
    vec3 nu = vec3(0), nv = vec3(0);
    if (kNormal == kNormalFull) {
        nu = normalDerivative(point.n, point.area, f.pu, f.pv, f.puu, f.puv);
        nv = normalDerivative(point.n, point.area, f.pu, f.pv, f.puv, f.pvv);
    }
    pu = displacedTangent(f.pu, point.n, nu, height.h, dh.x);
    pv = displacedTangent(f.pv, point.n, nv, height.h, dh.y);
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
    vec2 gradient;   // (h_s, h_t); of a height function and of a map per face (h_u, h_v)
    VectorSample vector;
    mat2 jacobian;   // of the texture coordinates
    vec4 gradientS;  // kHasTexGradients: as in varyings.glsl, in the model's own space
    vec4 gradientT;
#ifdef RELIEF_HEIGHT_FUNCTION
    vec3 rest;         // kHasTexGradients: as in varyings.glsl, in the model's own space
    mat3 restGradient;
#endif
};

// What slopes along n bend the normal of the drawn surface x by: with m = x_u x x_v, (x_u + a n) x (x_v + b n) = m - |m| (a U + b V) for
// U = (x_v x n) / |m| and V = (n x x_u) / |m|; by s and t instead of u and v, s_u U + s_v V and t_u U + t_v V. Where the surface is
// not displaced n is its normal, and these are the gradients of s and t along it. They are 0 where the surface has no two directions: nothing bends the normal there.
void addTexGradients(inout DisplacedSample s, SurfacePoint point, Displacement d) {
    s.gradientS = s.gradientT = vec4(0);
#ifdef RELIEF_HEIGHT_FUNCTION
    s.rest = point.rest.p;
    s.restGradient = mat3(0);
#endif
    if (point.isStraight) return;
    bool hasSlopes = kHasHeight && kNormal != kNormalLimit;
    vec3 xu = point.frame.pu, xv = point.frame.pv;
    if (hasSlopes) displaceTangents(point, d, xu, xv);
    vec3 m = cross(xu, xv);
    float square = dot(m, m);
    if (!(square > 0.0)) return;
    float area = sqrt(square);
    vec3 n = kVectorSpace != kVectorNone ? m / area : point.n; // nothing bends the normals of vector maps
    vec3 gradientU = cross(xv, n) / area, gradientV = cross(n, xu) / area;
    mat2 J = point.tex.jacobian;
    s.gradientS = vec4(point.stretch * (J[0].x * gradientU + J[1].x * gradientV), 0.0);
    s.gradientT = vec4(point.stretch * (J[0].y * gradientU + J[1].y * gradientV), 0.0);
#ifdef RELIEF_HEIGHT_FUNCTION
    s.restGradient = point.stretch * (outerProduct(point.rest.pu, gradientU) + outerProduct(point.rest.pv, gradientV));
#endif
}

// What belongs to the face that a point is seen from.
void addAttributes(inout DisplacedSample s, SurfacePoint point, Displacement d) {
    s.normal = displacedNormal(point, d);
    if (kHasTexGradients) addTexGradients(s, point, d);
    s.st = point.tex.st;
    s.frame = point.frame;
    s.n = point.n;
    s.gradient = d.height.gradient;
    if (kVectorSpace != kVectorNone) s.vector = d.vector;
    s.jacobian = point.tex.jacobian;
}

Displacement displacementAt(SurfacePoint point, float level) {
    Displacement d;
    d.height = HeightSample(0.0, vec2(0));
    if (!kHasHeight) return d;
#ifdef RELIEF_HEIGHT_FUNCTION
    d.height = sampleFunction(point.rest, point.tex);
#else
    d = lookUp(MapPlace(point.face, point.uv, point.tex.st), level);
    if (kHasSlopes) d.height.gradient = vec2(0);
#endif
    if (kStretches) {
        precise float h = point.stretch * d.height.h;
        d.height = HeightSample(h, point.stretch * d.height.gradient);
    }
    if (kVectorSpace != kVectorNone) stretchVector(d, point);
    return d;
}

// The number of the first incidence of the drawn face, or 0. Where nothing is displaced no direction is shared: the owner and the drawn
// face are all that counts of the faces around a vertex, which may be a thousand.
uint ownIncidence(uint face, SampleLocation location) {
    for (uint i = 0u; i < location.incidenceCount; ++i)
        if (fetchIncidence(location.firstIncidence + i).face == face) return i;
    return 0u;
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
    vec3 ownersNormal = vec3(0), c = vec3(0);
    SurfacePoint owners; // of vector maps
    uint own = kHasHeight ? 0u : ownIncidence(face, location);
    uint count = kHasHeight ? max(location.incidenceCount, 1u) : own > 0u ? 2u : 1u;
    bool isOwn = false;
    // One turn more for texture coordinates and their gradients where none of the incidences was of the drawn face: they may
    // differ from the owner's. A second call beside the loop would be compiled a second time.
    uint turnCount = kWantsTexCoords || kHasTexGradients ? count + 1u : count;
    for (uint i = 0u; i < turnCount; ++i) {
        bool isExtra = i == count;
        if (isExtra && isOwn) break;
        Incidence incidence = location.owner;
        float share = 1.0;
        if (location.incidenceCount > 0u && !isExtra) {
            uint index = location.firstIncidence + (kHasHeight || i == 0u ? i : own);
            incidence = fetchIncidence(index);
            if (incidence.start == incidence.end) share = sectorShare(index);
        }
        vec2 uv = location.isInside ? location.uv : incidencePoint(incidence, location.t);
        if (isExtra) incidence.face = face, uv = faceUV;
        bool isIncidenceOfFace = incidence.face == face && !isOwn;
        bool isUsed = i == 0u || isIncidenceOfFace;
        Leaf leaf = findLeaf(incidence.face, uv);
        SurfacePoint point = surfacePoint(fetchPatch(leaf.patchIndex, pose), leaf, uv, isUsed);
        if (!isExtra) direction += share * point.n;
        if (isUsed) {
            isOwn = incidence.face == face;
            Displacement d = displacementAt(point, location.level);
            if (i == 0u) {
                s.p = point.frame.p;
                s.h = d.height.h;
                ownersNormal = point.n;
                if (kVectorSpace != kVectorNone) owners = point, c = d.vector.c;
            }
            if (!isExtra || kHasTexGradients) addAttributes(s, point, d);
            else s.st = point.tex.st;
        }
    }
    // Normals that cancel (a fin, faces of opposite winding): the owner's.
    if (count > 1u) direction = dot(direction, direction) > 1e-6 ? normalize(direction) : ownersNormal;
    precise vec3 q = displacedPoint(s.p, direction, s.h);
    if (kVectorSpace != kVectorNone) q = movedPoint(owners, direction, c);
    s.q = q;
    s.normal = unitOr(s.normal, s.n);
    return s;
}

DisplacedSample displaced(uint face, vec2 faceUV, SampleLocation location) {
    return displacedInPose(face, faceUV, location, inputs.model.pointsNow);
}

// The sample at a point of one face.
DisplacedSample displacedAlone(SurfacePoint point, float level) {
    DisplacedSample s;
    Displacement d = displacementAt(point, level);
    addAttributes(s, point, d);
    s.p = point.frame.p;
    s.h = d.height.h;
    precise vec3 q = displacedPoint(s.p, s.n, s.h);
    if (kVectorSpace != kVectorNone) q = movedPoint(point, s.n, d.vector.c);
    s.q = q;
    s.normal = unitOr(s.normal, s.n);
    return s;
}

// A point inside a face whose leaf is known: what displaced() gives there, without the search.
DisplacedSample displacedInLeaf(PatchPoints patchPoints, Leaf leaf, vec2 uv, float level) {
    return displacedAlone(surfacePoint(patchPoints, leaf, uv, true), level);
}

#ifndef RELIEF_TRIANGLES

// The same where the patches of the surface and of its texture coordinates are bicubic.
DisplacedSample displacedInBicubic(PatchPoints patchPoints, Leaf leaf, vec2 uv, float level) {
    bool hasTexture = readsTexCoords(), hasRest = readsRest();
    PointFrames frames = evaluateBicubic(patchPoints, leaf, hasTexture, hasRest);
    return displacedAlone(surfacePointOf(frames, patchPoints, leaf, uv, hasTexture, hasRest), level);
}
#endif
#endif
