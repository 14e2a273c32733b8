// The limit surface in faces with an extraordinary vertex, at any distance from it. Included by limit.glsl.
//
// src/surface/caps.h has the mathematics: at distance 2^-n of the vertex the surface is a regular piece, whose control points
// are sums of differences between the points around the face and the vertex's limit point. The weights depend on n, on the
// piece and on the rules around the vertex: they are a table. Sums are of the size of the face's sides, whatever n is.

// Texels of the weights of a point on a level, of four numbers each.
#ifdef RELIEF_TRIANGLES
const uint kCapTexels = 3u * kCapPieces;
#else
const uint kCapTexels = 6u;
#endif

// A point's place in a cap: its coordinates there are 0 at the extraordinary vertex.
struct CapPlace {
    vec2 uv;         // in a piece
    uint table;      // texel of the weights of that piece and level, or of the vertex
    bool isUpper;    // the piece at (0,1) of a quad: its first column is apart
    float size;      // of the piece, where the cap is 1
    float bend;      // of second derivatives: 1 / size, less beyond the last level
    float slope;     // -1 in the turned middle of triangles
    bool isVertex;
};

// Columns are the derivatives of the cap's coordinates by the patch's u and v.
mat2 capDirections(uint corner) {
#ifdef RELIEF_TRIANGLES
    return corner == 0u ? mat2(1, 0, 0, 1) : corner == 1u ? mat2(0, -1, 1, -1) : mat2(-1, 1, -1, 0);
#else
    return corner == 0u ? mat2(1, 0, 0, 1) : corner == 1u ? mat2(0, -1, 1, 0) : corner == 2u ? mat2(-1, 0, 0, -1) : mat2(0, 1, -1, 0);
#endif
}

vec2 capCoordinates(uint corner, vec2 uv) {
#ifdef RELIEF_TRIANGLES
    precise float w = 1.0 - max(uv.x, uv.y) - min(uv.x, uv.y); // the first difference is exact beside a corner
    return corner == 0u ? uv : corner == 1u ? vec2(uv.y, w) : vec2(w, uv.x);
#else
    vec2 other = 1.0 - uv;
    return corner == 0u ? uv : corner == 1u ? vec2(uv.y, other.x) : corner == 2u ? other : vec2(other.y, uv.x);
#endif
}

CapPlace placeInCap(uvec4 cap, vec2 at) {
#ifdef RELIEF_TRIANGLES
    float distance = at.x + at.y;
#else
    float distance = max(at.x, at.y);
#endif
    CapPlace place;
    place.isVertex = !(distance > 0.0);
    // The exponent: distances of 2^-n to 2^(1-n) are of level n.
    int level = clamp(127 - int(floatBitsToUint(distance) >> 23), 1, 100);
    int last = min(level, int(kCapLevels));
    float scale = uintBitsToFloat(uint(127 + level) << 23);
    place.size = 1.0 / scale;
    place.bend = uintBitsToFloat(uint(127 + last) << 23);
    vec2 xy = scale * at;
#ifdef RELIEF_TRIANGLES
    uint piece = xy.x >= 1.0 ? 0u : xy.y >= 1.0 ? 2u : 1u;
    place.uv = piece == 1u ? 1.0 - xy : xy - (piece == 0u ? vec2(1, 0) : vec2(0, 1));
    place.slope = piece == 1u ? -1.0 : 1.0;
#else
    uint piece = xy.x < 1.0 ? 2u : xy.y < 1.0 ? 0u : 1u;
    place.uv = xy - vec2(piece == 2u ? 0.0 : 1.0, piece == 0u ? 0.0 : 1.0);
    place.slope = 1.0;
#endif
    uint level0 = cap.x + (uint(last) - 1u) * cap.y * kCapTexels;
#ifdef RELIEF_TRIANGLES
    place.table = level0 + 3u * piece;
#else
    place.table = level0 + min(piece, 1u);
#endif
    place.isUpper = piece == 2u && !place.isVertex;
    if (place.isVertex) place.table = cap.x + kCapLevels * cap.y * kCapTexels;
    return place;
}

vec4 capWeights(uint texel) { return uintBitsToFloat(recordAt(texel)); }

// A point around the cap, or a texture coordinate: by its index, never from a stage's own copies, which hold fewer.
vec4 capPoint(ControlPoints points, uint i) {
    if (isTexture(points)) return vec4(texPointAt(i), 0.0, uintBitsToFloat(kNoRemainder));
    return surfacePointAt(points, i);
}

// Control points of a piece, less the limit point; four in each matrix.
struct CapSums {
    mat4x3 a, b, c;
#ifndef RELIEF_TRIANGLES
    mat4x3 d;
#endif
};

mat4x3 addWeighted(mat4x3 sum, vec3 p, vec4 w) {
    precise mat4x3 r = mat4x3(sum[0] + w.x * p, sum[1] + w.y * p, sum[2] + w.z * p, sum[3] + w.w * p);
    return r;
}

// A basis of four points, with its derivatives by u and v.
void addBasis(inout LimitFrame f, mat4x3 q, vec4 w, vec4 du, vec4 dv, vec4 duu, vec4 duv, vec4 dvv) {
    precise vec3 p = f.p + q * w, pu = f.pu + q * du, pv = f.pv + q * dv;
    precise vec3 puu = f.puu + q * duu, puv = f.puv + q * duv, pvv = f.pvv + q * dvv;
    f = LimitFrame(p, pu, pv, puu, puv, pvv);
}

LimitFrame pieceFrame(CapSums sums, vec2 uv) {
    LimitFrame f = kNoFrame;
#ifdef RELIEF_TRIANGLES
    float p[12], du[12], dv[12], duu[12], duv[12], dvv[12];
    Osd_EvalBasisBoxSplineTri(uv.x, uv.y, p, du, dv, duu, duv, dvv);
#define RELIEF_FOUR(x, k) vec4(x[k], x[k + 1], x[k + 2], x[k + 3])
#define RELIEF_ADD_FOUR(q, k) addBasis(f, q, RELIEF_FOUR(p, k), RELIEF_FOUR(du, k), RELIEF_FOUR(dv, k), \
                                       RELIEF_FOUR(duu, k), RELIEF_FOUR(duv, k), RELIEF_FOUR(dvv, k))
    RELIEF_ADD_FOUR(sums.a, 0);
    RELIEF_ADD_FOUR(sums.b, 4);
    RELIEF_ADD_FOUR(sums.c, 8);
#else
    CurveWeights u = splineWeights(uv.x), v = splineWeights(uv.y);
#define RELIEF_ADD_ROW(q, k) addBasis(f, q, v.w[k] * u.w, v.w[k] * u.d, v.d[k] * u.w, v.w[k] * u.dd, v.d[k] * u.d, v.dd[k] * u.w)
    RELIEF_ADD_ROW(sums.a, 0);
    RELIEF_ADD_ROW(sums.b, 1);
    RELIEF_ADD_ROW(sums.c, 2);
    RELIEF_ADD_ROW(sums.d, 3);
#endif
    return f;
}

// The texel before the indices of the points names the table: its first texel, the number of points, the corner.
LimitFrame exactCap(ControlPoints points, vec2 patchUV) {
    uvec4 cap = recordAt(points.first - 1u);
    CapPlace place = placeInCap(cap, capCoordinates(cap.z, patchUV));
    vec4 limit = capPoint(points, pointRow(points, 0u).x);
    CapSums sums;
    sums.a = sums.b = sums.c = mat4x3(0.0);
#ifndef RELIEF_TRIANGLES
    sums.d = mat4x3(0.0);
#endif
    // At the vertex itself a point has one texel: what it adds to p_u and p_v.
    uint stride = place.isVertex ? 1u : kCapTexels;
    for (uint k = 0u; k < cap.y; ++k) {
        vec3 p = pointDifference(capPoint(points, pointRow(points, k >> 2)[k & 3u]), limit);
        uint texel = place.table + k * stride;
        vec4 a = capWeights(texel), b = capWeights(texel + 1u), c = capWeights(texel + 2u);
#ifndef RELIEF_TRIANGLES
        vec4 d = capWeights(texel + 3u), left = capWeights(texel + 4u);
        if (place.isUpper) a = vec4(left.x, a.xyz), b = vec4(left.y, b.xyz), c = vec4(left.z, c.xyz), d = vec4(left.w, d.xyz);
        sums.d = addWeighted(sums.d, p, d);
#endif
        sums.a = addWeighted(sums.a, p, a);
        sums.b = addWeighted(sums.b, p, b);
        sums.c = addWeighted(sums.c, p, c);
    }
    LimitFrame f = pieceFrame(sums, place.uv);
    vec3 offset = place.size * f.p;
    f = LimitFrame(fromOrigin(offset, limit), place.slope * f.pu, place.slope * f.pv, place.bend * f.puu, place.bend * f.puv, place.bend * f.pvv);
    if (place.isVertex) f = LimitFrame(limit.xyz, sums.a[0], sums.a[1], vec3(0), vec3(0), vec3(0));

    // By the patch's coordinates.
    mat2 d = capDirections(cap.z);
    vec2 u = d[0], v = d[1];
    return LimitFrame(f.p, u.x * f.pu + u.y * f.pv, v.x * f.pu + v.y * f.pv,
                      u.x * u.x * f.puu + 2.0 * u.x * u.y * f.puv + u.y * u.y * f.pvv,
                      u.x * v.x * f.puu + (u.x * v.y + v.x * u.y) * f.puv + u.y * v.y * f.pvv,
                      v.x * v.x * f.puu + 2.0 * v.x * v.y * f.puv + v.y * v.y * f.pvv);
}
