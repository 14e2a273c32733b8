// The frame of the limit surface in a patch, exact to rounding: its point and the derivatives by (u,v).
#ifndef RELIEF_LIMIT_GLSL
#define RELIEF_LIMIT_GLSL

#include "inputs.glsl"

// Where control points come from, as offsets from their patch's origin: the surface's tables, unless a stage holds them itself
// (dice_tile.glsl).
#ifndef RELIEF_OFFSET
#define RELIEF_POINT_ROW pointRow
#define RELIEF_POINT_INDEX pointIndex
#define RELIEF_OFFSET offsetAt
#define RELIEF_ORIGIN(points) surfacePointAt(points, pointIndex(points, originIndex(points.type)))
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

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false; // else a face's own (u,v) stand in for them
layout(constant_id = kIdHasHeight) const bool kHasHeight = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false; // something shades with them

// Where this is false all that evaluates texture coordinates folds away when a pipeline is made. A function, for Mesa 22.3's
// CPU driver makes no pipeline of a constant that is computed from specialization constants.
bool readsTexCoords() {
    return kHasTexCoords && ((kHasHeight && kMapAddressing != kMapOfFaces) || kWantsTexCoords || kHasTexGradients);
}

// Forms of patches that no patch has fold away when a pipeline is made. A bit per type.
layout(constant_id = kIdPatchTypes) const uint kPatchTypes = 0u;
bool hasPatches(uint type) { return (kPatchTypes >> type & 1u) != 0u; }

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
    uint face;      // that the leaf belongs to
};

// Halving is exact in floating point, so all faces that name a point the same way arrive at the same local (u,v).
Leaf findLeaf(uint face, vec2 uv) {
    Leaf leaf = Leaf(0u, uv, 1.0, face);
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

bool isTexture(ControlPoints points) { return readsTexCoords() && points.array == kTexturePoints; }

// The patch's origin, one of its points. On deep levels points lie close together, and derivatives by the face's (u,v) magnify
// what sums of whole coordinates round off, second ones 4^depth times. Of texture coordinates it is 0.
uint originIndex(uint type) { return type == kPatchRegular ? 5u : 0u; }
vec4 originOf(ControlPoints points) {
    if (isTexture(points)) return vec4(vec3(0), uintBitsToFloat(kNoRemainder));
    return RELIEF_ORIGIN(points);
}

vec3 fromOrigin(vec3 offset, vec4 origin) {
    precise vec3 p = origin.xyz + (remainderOf(origin) + offset);
    return p;
}
LimitFrame fromOrigin(LimitFrame f, vec4 origin) { return LimitFrame(fromOrigin(f.p, origin), f.pu, f.pv, f.puu, f.puv, f.pvv); }

// Control point k of a patch of the surface, or of the texture coordinates on it (in x and y): its offset from the origin.
vec3 controlPoint(ControlPoints points, uint k, vec4 origin) {
    uint i = RELIEF_POINT_INDEX(points, k);
    if (isTexture(points)) return vec3(RELIEF_TEX_POINT(i), 0.0);
    return RELIEF_OFFSET(points, i, origin);
}

#ifdef RELIEF_TRIANGLES
#include "triangle_patches.glsl"
#else
#include "quad_patches.glsl"
#endif

#include "end_caps.glsl"

#ifdef RELIEF_GENERIC_BASIS

// --- any patch, by OpenSubdiv's generic basis: the check of the forms above -----------------------------------------

LimitFrame generic(ControlPoints points, vec2 uv, vec4 origin) {
    float p[20], du[20], dv[20], duu[20], duv[20], dvv[20];
    OsdPatchParam param = OsdPatchParamInit(0, int(points.boundary << 7), 0.0);
    int count = OsdEvaluatePatchBasisNormalized(int(points.type), param, uv.x, uv.y, p, du, dv, duu, duv, dvv);
    LimitFrame f = kNoFrame;
    for (int i = 0; i < count; ++i) {
        vec3 c = controlPoint(points, uint(i), origin);
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

#ifndef RELIEF_TRIANGLES
// The frame of a patch without a cap, from its origin.
LimitFrame quadPatch(ControlPoints points, vec2 uv, vec4 origin) {
#ifdef RELIEF_GENERIC_BASIS
    if (kGenericBasis) return generic(points, uv, origin);
#endif
    if (points.type == kPatchRegular) {
        if (isTexture(points)) return regularTexture(points, uv);
        return regular(points, uv, origin);
    }
    if (hasPatches(kPatchQuads) && points.type == kPatchQuads) return bilinear(points, uv, origin);
    if (hasPatches(kPatchGregory)) return gregory(points, uv, origin);
    return kNoFrame;
}
#endif

// The frame of a patch by its own (u,v): of the surface, or of the texture coordinates on it (in x and y).
LimitFrame patchFrame(ControlPoints points, vec2 uv) {
#ifdef RELIEF_TRIANGLES
    if (hasPatches(kPatchExactTriangle) && points.type == kPatchExactTriangle) return exactCap(points, uv);
    vec4 origin = originOf(points);
    return fromOrigin(trianglePatch(points, uv, origin), origin);
#else
    if (hasPatches(kPatchExactQuad) && points.type == kPatchExactQuad) return exactCap(points, uv);
    vec4 origin = originOf(points);
    return fromOrigin(quadPatch(points, uv, origin), origin);
#endif
}

// Derivatives by the face's (u,v) from those by the patch's own.
LimitFrame byFace(LimitFrame f, float k) {
    return LimitFrame(f.p, k * f.pu, k * f.pv, k * k * f.puu, k * k * f.puv, k * k * f.pvv);
}
#endif
