// The function at the heart of every pass: limit(face, uv), the exact frame of the limit surface.
#ifndef RELIEF_LIMIT_GLSL
#define RELIEF_LIMIT_GLSL

#include "scene.glsl"

// OpenSubdiv's own basis functions, as its library prints them (the build writes the file).
#define OSD_PATCH_BASIS_GLSL
#define OPENSUBDIV_GREGORY_EVAL_TRUE_DERIVATIVES
#include "osd_patch_basis.glsl"

// Constant 0: the regular patches by OpenSubdiv's generic basis instead of bicubic() below. Slower; kept as the check.
layout(constant_id = 0) const bool kGenericBasis = false;

struct LimitFrame {
    vec3 p, pu, pv, puu, puv, pvv;
};

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
    uint entry = scene.faces.at[face].root;
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
        entry = scene.tree.at[entry + child];
    }
    leaf.patchIndex = entry & ~kLeafBit;
    return leaf;
}

// --- regular bicubic patches ----------------------------------------------------------------------------------------

// Uniform cubic B-spline weights of four control points and their derivatives.
struct CurveWeights {
    vec4 w, d, dd;
};

CurveWeights curveWeights(float t) {
    float t2 = t * t, t3 = t2 * t, r = 1.0 - t;
    CurveWeights c;
    c.w = vec4(r * r * r, 4.0 - 6.0 * t2 + 3.0 * t3, 1.0 + 3.0 * (t + t2 - t3), t3) * (1.0 / 6.0);
    c.d = vec4(-0.5 * r * r, 1.5 * t2 - 2.0 * t, -1.5 * t2 + t + 0.5, 0.5 * t2);
    c.dd = vec4(r, 3.0 * t - 2.0, 1.0 - 3.0 * t, t);
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

// Far::PatchParam's boundary mask: bit 0 v = 0, bit 1 u = 1, bit 2 v = 1, bit 3 u = 0.
uint boundaryMask(uint param1) { return (param1 >> 7) & 31u; }

void bicubicWeights(vec2 uv, uint boundary, out CurveWeights u, out CurveWeights v) {
    u = curveWeights(uv.x);
    v = curveWeights(uv.y);
    if (boundary != 0u) {
        u = atBoundary(u, (boundary & 8u) != 0u, (boundary & 2u) != 0u);
        v = atBoundary(v, (boundary & 1u) != 0u, (boundary & 4u) != 0u);
    }
}

LimitFrame bicubic(uint firstPoint, uint boundary, vec2 uv) {
    CurveWeights u, v;
    bicubicWeights(uv, boundary, u, v);
    precise LimitFrame f = LimitFrame(vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));
    for (uint row = 0u; row < 4u; ++row) {
        uint first = firstPoint + 4u * row;
        vec3 a = scene.points.at[scene.patchPoints.at[first]];
        vec3 b = scene.points.at[scene.patchPoints.at[first + 1u]];
        vec3 c = scene.points.at[scene.patchPoints.at[first + 2u]];
        vec3 d = scene.points.at[scene.patchPoints.at[first + 3u]];
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

// --- every other patch, by OpenSubdiv's basis -----------------------------------------------------------------------

struct Basis {
    float p[20], du[20], dv[20], duu[20], duv[20], dvv[20];
    int count;
};

#ifdef RELIEF_TRIANGLES
// OpenSubdiv 3.5 differentiates a Gregory triangle as if its quotients were constant. Each interior Bezier weight B is
// shared by two points with the quotients r = a/(a+b) and 1 - r; the product rule adds B r' (and B' r' twice, B r'').
void addQuotientRule(inout Basis w, int first, float a, float b, vec2 da, vec2 db) {
    float sum = a + b;
    if (sum <= 0.0) return;
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
#endif

Basis genericBasis(uint type, uint param1, vec2 uv) {
    Basis w;
    OsdPatchParam param = OsdPatchParamInit(0, int(param1), 0.0);
    w.count = OsdEvaluatePatchBasisNormalized(int(type), param, uv.x, uv.y, w.p, w.du, w.dv, w.duu, w.duv, w.dvv);
#ifdef RELIEF_TRIANGLES
    if (type == kPatchGregoryTriangle) {
        float u = uv.x, v = uv.y, t = 1.0 - u - v;
        addQuotientRule(w, 3, u, v, vec2(1, 0), vec2(0, 1));
        addQuotientRule(w, 8, v, t, vec2(0, 1), vec2(-1, -1));
        addQuotientRule(w, 13, t, u, vec2(-1, -1), vec2(1, 0));
    }
#endif
    return w;
}

LimitFrame generic(Patch patch_, vec2 uv) {
    Basis w = genericBasis(patch_.type, patch_.param1, uv);
    precise LimitFrame f = LimitFrame(vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));
    for (int i = 0; i < w.count; ++i) {
        vec3 c = scene.points.at[scene.patchPoints.at[patch_.firstPoint + uint(i)]];
        f.p += w.p[i] * c;
        f.pu += w.du[i] * c;
        f.pv += w.dv[i] * c;
        f.puu += w.duu[i] * c;
        f.puv += w.duv[i] * c;
        f.pvv += w.dvv[i] * c;
    }
    return f;
}

LimitFrame limitInLeaf(Leaf leaf) {
    Patch patch_ = scene.patches.at[leaf.patchIndex];
    LimitFrame f;
    if (patch_.type == kPatchRegular && !kGenericBasis)
        f = bicubic(patch_.firstPoint, boundaryMask(patch_.param1), leaf.uv);
    else
        f = generic(patch_, leaf.uv);
    float k = leaf.scale;
    return LimitFrame(f.p, k * f.pu, k * f.pv, k * k * f.puu, k * k * f.puv, k * k * f.pvv);
}

LimitFrame limit(uint face, vec2 uv) { return limitInLeaf(findLeaf(face, uv)); }

// --- texture coordinates --------------------------------------------------------------------------------------------

// Constant 1: the cage has texture coordinates; else a face's own (u,v) stand in for them.
layout(constant_id = 1) const bool kHasTexCoords = false;

TexFrame bicubicTexture(uint firstPoint, uint boundary, vec2 uv) {
    CurveWeights u, v;
    bicubicWeights(uv, boundary, u, v);
    TexFrame f = TexFrame(vec2(0), mat2(0));
    for (uint row = 0u; row < 4u; ++row) {
        vec2 x = vec2(0), xu = vec2(0);
        for (uint column = 0u; column < 4u; ++column) {
            vec2 c = scene.texPoints.at[scene.texPatchPoints.at[firstPoint + 4u * row + column]];
            x += u.w[column] * c;
            xu += u.d[column] * c;
        }
        f.st += v.w[row] * x;
        f.jacobian[0] += v.w[row] * xu;
        f.jacobian[1] += v.d[row] * x;
    }
    return f;
}

TexFrame textureInLeaf(Leaf leaf) {
    Patch patch_ = scene.patches.at[leaf.patchIndex];
    TexFrame f = TexFrame(vec2(0), mat2(0));
    if (patch_.texType == kPatchRegular && !kGenericBasis) {
        f = bicubicTexture(patch_.texFirstPoint, boundaryMask(patch_.texParam1), leaf.uv);
    } else {
        Basis w = genericBasis(patch_.texType, patch_.texParam1, leaf.uv);
        for (int i = 0; i < w.count; ++i) {
            vec2 c = scene.texPoints.at[scene.texPatchPoints.at[patch_.texFirstPoint + uint(i)]];
            f.st += w.p[i] * c;
            f.jacobian[0] += w.du[i] * c;
            f.jacobian[1] += w.dv[i] * c;
        }
    }
    f.jacobian *= leaf.scale;
    return f;
}
#endif
