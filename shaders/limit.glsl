// The frame of the limit surface in a patch, exact to rounding: its point and the derivatives by (u,v).
#ifndef RELIEF_LIMIT_GLSL
#define RELIEF_LIMIT_GLSL

#include "inputs.glsl"

// Where control points come from: the surface's tables, unless a stage holds them itself (dice_tile.glsl).
#ifndef RELIEF_POINT
#define RELIEF_POINT_ROW pointRow
#define RELIEF_POINT_INDEX pointIndex
#define RELIEF_POINT surfacePointAt
#define RELIEF_TEX_POINT texPointAt
#define RELIEF_UNROLL
#define RELIEF_MEETS_CORNERS // samples may lie in corners of faces
#endif

// OpenSubdiv's own basis functions, as its library prints them (the build writes the file): what triangles are drawn
// with, and the check of the faster forms below for quads (tests compare them through sample.comp).
#if defined(RELIEF_TRIANGLES) || defined(RELIEF_GENERIC_BASIS)
#define OSD_PATCH_BASIS_GLSL
#define OPENSUBDIV_GREGORY_EVAL_TRUE_DERIVATIVES
#include "osd_patch_basis.glsl"
#endif

layout(constant_id = kIdGenericBasis) const bool kGenericBasis = false; // only where RELIEF_GENERIC_BASIS is defined

struct LimitFrame {
    vec3 p, pu, pv, puu, puv, pvv;
};

const LimitFrame kNoFrame = LimitFrame(vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));

struct TexFrame {
    vec2 st;
    mat2 jacobian;  // columns d(s,t)/du, d(s,t)/dv
};

// A leaf of a face's patch tree and where (u,v) lies in it.
struct Leaf {
    uint patchIndex;
    vec2 uv;        // local to the patch, 0..1
    float scale;    // d(local)/d(face): a power of two, negative in a turned triangle
};

// Halving is exact in floating point, so all faces that name a point the same way arrive at the same local (u,v).
Leaf findLeaf(uint face, vec2 uv) {
    Leaf leaf = Leaf(0u, uv, 1.0);
    uint entry = faceRoot(face);
    while ((entry & kLeafBit) == 0u) {
#ifdef RELIEF_TRIANGLES
        uint child = leaf.uv.x >= 0.5 ? 1u : leaf.uv.y >= 0.5 ? 2u : leaf.uv.x + leaf.uv.y > 0.5 ? 3u : 0u;
        vec2 corner = vec2(child == 1u ? 0.5 : 0.0, child == 2u ? 0.5 : 0.0);
        leaf.uv = 2.0 * (child == 3u ? 0.5 - leaf.uv : leaf.uv - corner);
        leaf.scale *= child == 3u ? -2.0 : 2.0;
#else
        bvec2 upper = greaterThanEqual(leaf.uv, vec2(0.5));
        uint child = (upper.x ? 1u : 0u) + (upper.y ? 2u : 0u);
        leaf.uv = 2.0 * leaf.uv - vec2(upper);
        leaf.scale *= 2.0;
#endif
        entry = treeEntry(entry + child);
    }
    leaf.patchIndex = entry & ~kLeafBit;
    return leaf;
}

// Control point k of a patch of the surface, or of the texture coordinates on it (in x and y).
vec3 controlPoint(ControlPoints points, uint k) {
    uint i = RELIEF_POINT_INDEX(points, k);
    if (points.array == kTexturePoints) return vec3(RELIEF_TEX_POINT(i), 0.0);
    return RELIEF_POINT(points, i);
}

#ifndef RELIEF_TRIANGLES

// --- bicubic patches ------------------------------------------------------------------------------------------------

// Weights of four control points along a curve and their derivatives.
struct CurveWeights {
    vec4 w, d, dd;
};

// Uniform cubic B-spline.
CurveWeights splineWeights(float t) {
    float t2 = t * t, t3 = t2 * t, r = 1.0 - t;
    CurveWeights c;
    c.w = vec4(r * r * r, 4.0 - 6.0 * t2 + 3.0 * t3, 1.0 + 3.0 * (t + t2 - t3), t3) * (1.0 / 6.0);
    c.d = vec4(-0.5 * r * r, 1.5 * t2 - 2.0 * t, -1.5 * t2 + t + 0.5, 0.5 * t2);
    c.dd = vec4(r, 3.0 * t - 2.0, 1.0 - 3.0 * t, t);
    return c;
}

// Cubic Bernstein polynomials.
CurveWeights bezierWeights(float t) {
    float r = 1.0 - t;
    CurveWeights c;
    c.w = vec4(r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t);
    c.d = 3.0 * vec4(-r * r, r * (r - 2.0 * t), t * (2.0 * r - t), t * t);
    c.dd = 6.0 * vec4(r, t - 2.0 * r, r - 2.0 * t, t);
    return c;
}

// At a boundary the outer control point is a phantom: the reflection 2 a - b of the two beside it.
vec4 withoutFirst(vec4 w) { return vec4(0.0, w.y + 2.0 * w.x, w.z - w.x, w.w); }
vec4 withoutLast(vec4 w) { return vec4(w.x, w.y - w.w, w.z + 2.0 * w.w, 0.0); }

CurveWeights atBoundary(CurveWeights c, bool first, bool last) {
    if (first) c = CurveWeights(withoutFirst(c.w), withoutFirst(c.d), withoutFirst(c.dd));
    if (last) c = CurveWeights(withoutLast(c.w), withoutLast(c.d), withoutLast(c.dd));
    return c;
}

// Bits of a boundary: v = 0, u = 1, v = 1, u = 0.
void regularWeights(vec2 uv, uint boundary, out CurveWeights u, out CurveWeights v) {
    u = splineWeights(uv.x);
    v = splineWeights(uv.y);
    if (boundary != 0u) {
        u = atBoundary(u, (boundary & 8u) != 0u, (boundary & 2u) != 0u);
        v = atBoundary(v, (boundary & 1u) != 0u, (boundary & 4u) != 0u);
    }
}

LimitFrame regular(ControlPoints points, vec2 uv) {
    CurveWeights u, v;
    regularWeights(uv, points.boundary, u, v);
    precise LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) {
        uvec4 i = RELIEF_POINT_ROW(points, row);
        vec3 a = RELIEF_POINT(points, i.x), b = RELIEF_POINT(points, i.y);
        vec3 c = RELIEF_POINT(points, i.z), d = RELIEF_POINT(points, i.w);
        precise vec3 x = u.w.x * a + u.w.y * b + u.w.z * c + u.w.w * d;
        precise vec3 xu = u.d.x * a + u.d.y * b + u.d.z * c + u.d.w * d;
        precise vec3 xuu = u.dd.x * a + u.dd.y * b + u.dd.z * c + u.dd.w * d;
        f.p += v.w[row] * x;
        f.pu += v.w[row] * xu;
        f.pv += v.d[row] * x;
        f.puu += v.w[row] * xuu;
        f.puv += v.d[row] * xu;
        f.pvv += v.dd[row] * x;
    }
    return f;
}

// The same for texture coordinates: two components, first derivatives.
LimitFrame regularTexture(ControlPoints points, vec2 uv) {
    CurveWeights u, v;
    regularWeights(uv, points.boundary, u, v);
    vec2 st = vec2(0), su = vec2(0), sv = vec2(0);
    RELIEF_UNROLL for (uint row = 0u; row < 4u; ++row) {
        uvec4 i = RELIEF_POINT_ROW(points, row);
        vec2 a = RELIEF_TEX_POINT(i.x), b = RELIEF_TEX_POINT(i.y), c = RELIEF_TEX_POINT(i.z), d = RELIEF_TEX_POINT(i.w);
        vec2 x = u.w.x * a + u.w.y * b + u.w.z * c + u.w.w * d;
        st += v.w[row] * x;
        su += v.w[row] * (u.d.x * a + u.d.y * b + u.d.z * c + u.d.w * d);
        sv += v.d[row] * x;
    }
    return LimitFrame(vec3(st, 0), vec3(su, 0), vec3(sv, 0), vec3(0), vec3(0), vec3(0));
}

// --- Gregory patches ------------------------------------------------------------------------------------------------

// Loop, Schaefer, Ni, Castano (2009): a bicubic Bezier patch whose four inner points F depend on (u,v), each a blend
// g a + (1 - g) b of two of the 20 control points with g = x / (x + y), where x and y are the distances to the sides
// at that corner. The derivatives are the true ones: product rule with those of F.
//
// Which control point each Bezier point is, by row, five bits each; inner ones name the first of their pair.
const uint kGregoryRows[4] = {0u | 1u << 5 | 7u << 10 | 5u << 15, 2u | 3u << 5 | 8u << 10 | 6u << 15,
                              16u | 18u << 5 | 13u << 10 | 12u << 15, 15u | 17u << 5 | 11u << 10 | 10u << 15};

LimitFrame gregory(ControlPoints points, vec2 uv) {
    CurveWeights u = bezierWeights(uv.x), v = bezierWeights(uv.y);
    precise LimitFrame f = kNoFrame;
    RELIEF_UNROLL for (uint k = 0u; k < 16u; ++k) {
        uint row = k >> 2, column = k & 3u;
        uint point = (kGregoryRows[row] >> (5u * column)) & 31u;
        vec3 c = controlPoint(points, point);
        vec3 cu = vec3(0), cv = vec3(0), cuu = vec3(0), cuv = vec3(0), cvv = vec3(0);
        if ((row == 1u || row == 2u) && (column == 1u || column == 2u)) {
            // Distances from the corner's two sides and their derivatives: +1 at the near end, -1 at the far one.
            float du = column == 1u ? 1.0 : -1.0, dv = row == 1u ? 1.0 : -1.0;
            float x = column == 1u ? uv.x : 1.0 - uv.x, y = row == 1u ? uv.y : 1.0 - uv.y;
            bool isCorner = x + y <= 0.0;
            float inverse = isCorner ? 0.0 : 1.0 / (x + y);
            // The pair's first point goes with x at corners 0 and 2 (row and column alike), with y at corners 1 and 3.
            bool isX = row == column;
            float g = isCorner ? 0.5 : (isX ? x : y) * inverse;
            float gx = (isX ? y : -y) * inverse * inverse, gy = (isX ? -x : x) * inverse * inverse;
            float gxx = -2.0 * gx * inverse, gyy = -2.0 * gy * inverse;
            float gxy = (isX ? x - y : y - x) * inverse * inverse * inverse;
            vec3 other = controlPoint(points, point + 1u);
            vec3 difference = c - other;
            c = other + g * difference;
            cu = gx * du * difference;
            cv = gy * dv * difference;
            cuu = gxx * difference;
            cuv = gxy * du * dv * difference;
            cvv = gyy * difference;
            // In the corner itself the second derivatives depend on the direction of approach: along x = y the product rule
            // leaves this of the quotients, while all else that they meet vanishes.
            float left = isCorner ? (isX ? 2.25 : -2.25) : 0.0;
            f.puu += left * difference;
            f.pvv -= left * difference;
        }
        float wu = u.w[column], wv = v.w[row], du = u.d[column], dv = v.d[row];
        f.p += wu * wv * c;
        f.pu += wv * (du * c + wu * cu);
        f.pv += wu * (dv * c + wv * cv);
        f.puu += wv * (u.dd[column] * c + 2.0 * du * cu + wu * cuu);
        f.puv += du * dv * c + du * wv * cv + wu * dv * cu + wu * wv * cuv;
        f.pvv += wu * (v.dd[row] * c + 2.0 * dv * cv + wv * cvv);
    }
    return f;
}

// --- bilinear patches -----------------------------------------------------------------------------------------------

LimitFrame bilinear(ControlPoints points, vec2 uv) {
    vec3 a = controlPoint(points, 0u), b = controlPoint(points, 1u);
    vec3 c = controlPoint(points, 2u), d = controlPoint(points, 3u);
    LimitFrame f = kNoFrame;
    precise vec3 low = (1.0 - uv.x) * a + uv.x * b, high = (1.0 - uv.x) * d + uv.x * c;
    precise vec3 p = (1.0 - uv.y) * low + uv.y * high;
    f.p = p;
    f.pu = (1.0 - uv.y) * (b - a) + uv.y * (c - d);
    f.pv = high - low;
    f.puv = a - b + c - d;
    return f;
}
#endif

#ifdef RELIEF_TRIANGLES

// --- triangles, by OpenSubdiv's basis -------------------------------------------------------------------------------

// Weights of up to 18 control points for the point and its derivatives.
struct Weights {
    float p[18], du[18], dv[18], duu[18], duv[18], dvv[18];
};

LimitFrame weighted(Weights w, int count, ControlPoints points) {
    precise LimitFrame f = kNoFrame;
    for (int i = 0; i < count; ++i) {
        vec3 c = controlPoint(points, uint(i));
        f.p += w.p[i] * c;
        f.pu += w.du[i] * c;
        f.pv += w.dv[i] * c;
        f.puu += w.duu[i] * c;
        f.puv += w.duv[i] * c;
        f.pvv += w.dvv[i] * c;
    }
    return f;
}

// OpenSubdiv 3.5 differentiates a Gregory triangle as if its quotients were constant. Each interior Bezier weight B is
// shared by two points with the quotients r = a/(a+b) and 1 - r; the product rule adds B r' (and B' r' twice, B r'').
void addQuotientRule(inout Weights w, int first, float a, float b, vec2 da, vec2 db) {
    float sum = a + b;
    if (sum <= 0.0) {
        // In the corner itself second derivatives depend on the direction of approach: those along a = b, of 12 a b a / (a + b).
        for (int i = 0; i < 2; ++i) {
            vec2 x = i == 0 ? da : db, y = i == 0 ? db : da;
            w.duu[first + i] = 3.0 * x.x * x.x + 12.0 * x.x * y.x - 3.0 * y.x * y.x;
            w.duv[first + i] = 3.0 * x.x * x.y + 6.0 * (x.x * y.y + x.y * y.x) - 3.0 * y.x * y.y;
            w.dvv[first + i] = 3.0 * x.y * x.y + 12.0 * x.y * y.y - 3.0 * y.y * y.y;
        }
        return;
    }
    vec2 dsum = da + db;
    vec2 dr = (da - dsum * (a / sum)) / sum;
    // r'' = -(r'_i sum_j + r'_j sum_i) / sum, for linear a and b.
    float ruu = -2.0 * dr.x * dsum.x / sum, rvv = -2.0 * dr.y * dsum.y / sum;
    float ruv = -(dr.x * dsum.y + dr.y * dsum.x) / sum;
    float B = w.p[first] + w.p[first + 1];
    vec2 dB = vec2(w.du[first] + w.du[first + 1], w.dv[first] + w.dv[first + 1]);
    for (int i = 0; i < 2; ++i) {
        float sign = i == 0 ? 1.0 : -1.0;
        w.du[first + i] += sign * B * dr.x;
        w.dv[first + i] += sign * B * dr.y;
        w.duu[first + i] += sign * (2.0 * dB.x * dr.x + B * ruu);
        w.duv[first + i] += sign * (dB.x * dr.y + dB.y * dr.x + B * ruv);
        w.dvv[first + i] += sign * (2.0 * dB.y * dr.y + B * rvv);
    }
}

LimitFrame trianglePatch(ControlPoints points, vec2 uv) {
    Weights w;
    int count = 18;
    if (points.type == kPatchGregoryTriangle) {
        Osd_EvalBasisGregoryTri(uv.x, uv.y, w.p, w.du, w.dv, w.duu, w.duv, w.dvv);
        float u = uv.x, v = uv.y, t = 1.0 - u - v;
        addQuotientRule(w, 3, u, v, vec2(1, 0), vec2(0, 1));
        addQuotientRule(w, 8, v, t, vec2(0, 1), vec2(-1, -1));
        addQuotientRule(w, 13, t, u, vec2(-1, -1), vec2(1, 0));
    } else {
        float p[12], du[12], dv[12], duu[12], duv[12], dvv[12];
        count = 12;
        if (points.type == kPatchLoop) {
            Osd_EvalBasisBoxSplineTri(uv.x, uv.y, p, du, dv, duu, duv, dvv);
            if (points.boundary != 0u) Osd_boundBasisBoxSplineTri(int(points.boundary), p, du, dv, duu, duv, dvv);
        } else {
            count = 3;
            p[0] = 1.0 - uv.x - uv.y, p[1] = uv.x, p[2] = uv.y;
            du[0] = -1.0, du[1] = 1.0, du[2] = 0.0;
            dv[0] = -1.0, dv[1] = 0.0, dv[2] = 1.0;
            for (int i = 0; i < 3; ++i) duu[i] = duv[i] = dvv[i] = 0.0;
        }
        for (int i = 0; i < 12; ++i) {
            w.p[i] = p[i], w.du[i] = du[i], w.dv[i] = dv[i];
            w.duu[i] = duu[i], w.duv[i] = duv[i], w.dvv[i] = dvv[i];
        }
    }
    return weighted(w, count, points);
}
#endif

#ifdef RELIEF_GENERIC_BASIS

// --- any patch, by OpenSubdiv's generic basis: the check of the forms above -----------------------------------------

LimitFrame generic(ControlPoints points, vec2 uv) {
    float p[20], du[20], dv[20], duu[20], duv[20], dvv[20];
    OsdPatchParam param = OsdPatchParamInit(0, int(points.boundary << 7), 0.0);
    int count = OsdEvaluatePatchBasisNormalized(int(points.type), param, uv.x, uv.y, p, du, dv, duu, duv, dvv);
    LimitFrame f = kNoFrame;
    for (int i = 0; i < count; ++i) {
        vec3 c = controlPoint(points, uint(i));
        f.p += p[i] * c;
        f.pu += du[i] * c;
        f.pv += dv[i] * c;
        f.puu += duu[i] * c;
        f.puv += duv[i] * c;
        f.pvv += dvv[i] * c;
    }
    return f;
}
#endif

// The frame of a patch by its own (u,v): of the surface, or of the texture coordinates on it (in x and y).
LimitFrame patchFrame(ControlPoints points, vec2 uv) {
#ifdef RELIEF_TRIANGLES
    return trianglePatch(points, uv);
#else
#ifdef RELIEF_GENERIC_BASIS
    if (kGenericBasis) return generic(points, uv);
#endif
    if (points.type == kPatchRegular) {
        if (points.array == kTexturePoints) return regularTexture(points, uv);
        return regular(points, uv);
    }
    if (points.type == kPatchQuads) return bilinear(points, uv);
    return gregory(points, uv);
#endif
}

// Derivatives by the face's (u,v) from those by the patch's own.
LimitFrame byFace(LimitFrame f, float k) { return LimitFrame(f.p, k * f.pu, k * f.pv, k * k * f.puu, k * k * f.puv, k * k * f.pvv); }
#endif
