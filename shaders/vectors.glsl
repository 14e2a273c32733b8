// Displacement by vectors: three components along T, B and N of the limit surface, or along x, y and z of the object.
#ifndef RELIEF_VECTORS_GLSL
#define RELIEF_VECTORS_GLSL

#include "heights.glsl"
#include "surface_point.glsl"

// The components, cage units, and their derivatives by s and t: the columns.
struct VectorSample {
    vec3 c;
    mat2x3 dc;
};

// What displaces a point. Of a vector map `height` is what it has along n, without slopes.
struct Displacement {
    HeightSample height;
    VectorSample vector;
};

// The lookups of a map of heights, or of three components, at a point. One lookup in a loop, for compilers unfold every one.
// kReadsNodes: all samples lie on nodes of one level. RELIEF_ONE_FACE: all lookups are in that of one face.
#ifdef RELIEF_ONE_FACE
NodeLevel nodesOfFace;
#endif
Displacement lookUp(MapPlace place, float level) {
    Displacement d;
#ifndef RELIEF_STORAGE_TABLES
    if (kReadsNodes) {
#ifdef RELIEF_ONE_FACE
        d.height = sampleNode(nodesOfFace, place.uv);
#else
        d.height = sampleNode(nodeLevel(partAt(place), level), place.uv);
#endif
        return d;
    }
#endif
    MapPart part = partAt(place);
    if (kVectorSpace != kVectorNone) d.vector = VectorSample(vec3(0), mat2x3(0.0));
    for (uint k = 0u; k < (kVectorSpace == kVectorNone ? 1u : 3u); ++k) {
        if (kVectorSpace != kVectorNone) part.map = k;
        HeightSample one = betweenLevels(part, level);
        d.height = one;
        if (kVectorSpace == kVectorNone) continue;
        vec3 axis = vec3(k == 0u, k == 1u, k == 2u);
        d.vector.c += one.h * axis;
        d.vector.dc[0] += one.gradient.x * axis;
        d.vector.dc[1] += one.gradient.y * axis;
    }
    if (kMapAddressing == kMapOfTiles && !part.isThere) {
        d.height = HeightSample(0.0, vec2(0));
        if (kVectorSpace != kVectorNone) d.vector = VectorSample(vec3(0), mat2x3(0.0));
    }
    return d;
}

// Vectors grow with the surface as heights do; what they have along n stands for their height.
void stretchVector(inout Displacement d, SurfacePoint point) {
    if (kStretches) {
        precise vec3 c = point.stretch * d.vector.c;
        d.vector = VectorSample(c, point.stretch * d.vector.dc);
    }
    d.height = HeightSample(kVectorSpace == kVectorTangent ? d.vector.c.z : dot(d.vector.c, point.n), vec2(0));
}

// --- T and B --------------------------------------------------------------------------------------------------------

// T is the direction of p_s: det(J) p_s = a with a = t_v p_u - t_u p_v. B = N x a / |a| then lies on the side of p_t, also where
// texture coordinates are mirrored and T = -a / |a|. Where s has no direction along the surface u stands for it.
struct TexDirection {
    vec2 d, du, dv;  // (t_u, t_v) and its derivatives by u and v
    float side;      // -1 where the texture coordinates are mirrored, else 1
};

vec3 alongS(vec2 d, vec3 pu, vec3 pv) {
    precise vec3 a = d.y * pu - d.x * pv;
    return a;
}

TexDirection texDirection(SurfacePoint point) {
    mat2 J = point.tex.jacobian;
    vec3 second = point.texSecond;
    TexDirection s = TexDirection(vec2(J[0].y, J[1].y), second.xy, second.yz, determinant(J) < 0.0 ? -1.0 : 1.0);
    vec3 pu = point.frame.pu, a = alongS(s.d, pu, point.frame.pv);
    if (dot(a, a) > 1e-12 * dot(s.d, s.d) * dot(pu, pu)) return s;
    return TexDirection(vec2(0, 1), vec2(0), vec2(0), 1.0);
}

// --- the displaced point and its tangents -----------------------------------------------------------------------------

// q = p + c_x T + c_y B + c_z N, where N is `direction` and T is perpendicular to that.
vec3 movedPoint(SurfacePoint point, vec3 direction, vec3 c) {
    vec3 p = point.frame.p;
    if (kVectorSpace == kVectorObject) {
        precise vec3 q = p + c;
        return q;
    }
    TexDirection s = texDirection(point);
    vec3 a = alongS(s.d, point.frame.pu, point.frame.pv);
    precise vec3 across = a - dot(a, direction) * direction;
    precise float square = dot(across, across);
    if (!(square > 1e-12 * dot(a, a))) {
        across = cross(direction, abs(direction.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0));
        square = dot(across, across);
    }
    precise vec3 e = across / sqrt(square), b = cross(direction, e);
    precise vec3 q = p + (c.x * s.side) * e + c.y * b + c.z * direction;
    return q;
}

// The derivative of the columns (T, B, N) by u or v: with a_u, e = a / |a| turns by (I - e e^T) a_u / |a|.
mat3 turnOfBasis(vec3 n, vec3 e, float side, vec3 dn, vec3 da, float size) {
    vec3 de = (da - e * dot(e, da)) / size;
    return mat3(side * de, cross(dn, e) + cross(n, de), dn);
}

// q_u = p_u + E c_u + E_u c with E = (T, B, N), and q_v likewise; E of the object's axes does not turn. `turns`: else E_u is left
// away, as the first-order normal does.
void vectorTangents(SurfacePoint point, VectorSample v, bool turns, out vec3 qu, out vec3 qv) {
    LimitFrame f = point.frame;
    vec3 cu = v.dc * point.tex.jacobian[0], cv = v.dc * point.tex.jacobian[1];
    if (kStretches) {
        cu += point.logStretch.x * v.c;
        cv += point.logStretch.y * v.c;
    }
    if (kVectorSpace == kVectorObject) {
        qu = f.pu + cu;
        qv = f.pv + cv;
        return;
    }
    TexDirection s = texDirection(point);
    vec3 n = point.n, a = alongS(s.d, f.pu, f.pv);
    float size = length(a);
    vec3 e = a / size;
    mat3 basis = mat3(s.side * e, cross(n, e), n);
    qu = f.pu + basis * cu;
    qv = f.pv + basis * cv;
    if (!turns) return;
    vec3 au = alongS(s.du, f.pu, f.pv) + alongS(s.d, f.puu, f.puv), av = alongS(s.dv, f.pu, f.pv) + alongS(s.d, f.puv, f.pvv);
    vec3 nu = normalDerivative(n, point.area, f.pu, f.pv, f.puu, f.puv);
    vec3 nv = normalDerivative(n, point.area, f.pu, f.pv, f.puv, f.pvv);
    qu += turnOfBasis(n, e, s.side, nu, au, size) * v.c;
    qv += turnOfBasis(n, e, s.side, nv, av, size) * v.c;
}
#endif
