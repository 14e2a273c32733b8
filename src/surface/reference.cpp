// The double-precision evaluator: OpenSubdiv's patches, with the derivatives that it gets wrong put right.
#include <algorithm>
#include <cmath>

#include <opensubdiv/far/patchMap.h>

#include "surface/far.h"
#include "surface/gregory.h"

namespace relief {
namespace {

using Descriptor = Far::PatchDescriptor;

bool isGregory(int type) { return type == Descriptor::GREGORY_BASIS || type == Descriptor::GREGORY_TRIANGLE; }

/// Weights of a Gregory patch at the face's (u,v), derivatives by the face's (u,v).
PatchWeights gregoryWeights(int type, const Far::PatchParam& param, dvec2 uv) {
    double slope = 1 << depthInFace(param);
    PatchWeights weights;
    if (type == Descriptor::GREGORY_BASIS) {
        param.Normalize(uv.x, uv.y);
        weights = gregoryQuadWeights(uv.x, uv.y);
    } else {
        param.NormalizeTriangle(uv.x, uv.y);
        weights = gregoryTriangleWeights(uv.x, uv.y);
        if (param.IsTriangleRotated()) slope = -slope;
    }
    for (Jet& w : weights) {
        w.u *= slope, w.v *= slope;
        w.uu *= slope * slope, w.uv *= slope * slope, w.vv *= slope * slope;
    }
    return weights;
}

/// OpenSubdiv differentiates by the (u,v) of the n-gon's parent quad and forgets that a turned triangle's second
/// derivatives keep their sign.
void correctDerivatives(PatchWeights& weights, int sideCount, const Far::PatchParam& param) {
    const double slope = param.NonQuadRoot() ? 0.5 : 1;
    const bool isTurned = sideCount == 3 && param.IsTriangleRotated();
    const double bend = slope * slope * (isTurned ? -1 : 1);
    for (Jet& w : weights) {
        w.u *= slope, w.v *= slope;
        w.uu *= bend, w.uv *= bend, w.vv *= bend;
    }
}

/// Weights that OpenSubdiv wrote as six arrays.
struct WeightArrays {
    double p[kMostPatchPoints]{}, u[kMostPatchPoints]{}, v[kMostPatchPoints]{};
    double uu[kMostPatchPoints]{}, uv[kMostPatchPoints]{}, vv[kMostPatchPoints]{};

    [[nodiscard]] PatchWeights jets() const {
        PatchWeights weights;
        for (int i = 0; i < kMostPatchPoints; ++i) weights[i] = {p[i], u[i], v[i], uu[i], uv[i], vv[i]};
        return weights;
    }
};

/// A point of an exact end cap and its derivatives by the face's (u,v).
template <typename V>
struct CapFrame {
    V p{0}, pu{0}, pv{0}, puu{0}, puv{0}, pvv{0};
};

/// The cap's coordinates a and b as functions of the patch's: 0 at the extraordinary corner.
struct CapCoordinates {
    Jet a, b;
};

CapCoordinates capCoordinates(int sideCount, std::uint32_t corner, const dvec2& uv) {
    const Jet u{uv.x, 1, 0}, v{uv.y, 0, 1};
    if (sideCount == 3) {
        const Jet w = Jet{1} - u - v;
        return corner == 0 ? CapCoordinates{u, v} : corner == 1 ? CapCoordinates{v, w} : CapCoordinates{w, u};
    }
    const Jet u1 = Jet{1} - u, v1 = Jet{1} - v;
    return corner == 0   ? CapCoordinates{u, v}
           : corner == 1 ? CapCoordinates{v, u1}
           : corner == 2 ? CapCoordinates{u1, v1}
                         : CapCoordinates{v1, u};
}

/// `values`: of the points around the cap, less the limit point's.
template <typename V>
V sumOf(const Eigen::MatrixXd& weights, Eigen::Index row, const std::vector<V>& values) {
    V sum(0);
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights(row, Eigen::Index(i)) * values[i];
    return sum;
}

/// By the cap's coordinates, without the limit point.
template <typename V>
CapFrame<V> capFrameByOwn(const CapMatrices& matrices, double a, double b, const std::vector<V>& values) {
    const int sideCount = matrices.pattern().sideCount;
    const CapPlace place = placeInCap(sideCount, a, b, matrices.levelCount());
    CapFrame<V> f;
    if (place.level == 0) {
        f.pu = sumOf(matrices.tangentWeights(), 0, values);
        f.pv = sumOf(matrices.tangentWeights(), 1, values);
        return f;
    }
    const std::vector<Jet> basis = pieceBasis(sideCount, place.u, place.v);
    const Eigen::MatrixXd& weights = matrices.pieceWeights(place.level, place.piece);
    const double bend = 1 / place.size;
    for (std::size_t j = 0; j < basis.size(); ++j) {
        const V q = sumOf(weights, Eigen::Index(j), values);
        const Jet& w = basis[j];
        f.p += place.size * w.f * q;
        f.pu += place.slope * w.u * q, f.pv += place.slope * w.v * q;
        f.puu += bend * w.uu * q, f.puv += bend * w.uv * q, f.pvv += bend * w.vv * q;
    }
    return f;
}

/// `slope`: of the patch's coordinates by the face's.
template <typename V>
CapFrame<V> capFrame(const CapMatrices& matrices, const CapCoordinates& at, double slope, const V& limit,
                     const std::vector<V>& values) {
    const CapFrame<V> f = capFrameByOwn(matrices, at.a.f, at.b.f, values);
    const double au = slope * at.a.u, av = slope * at.a.v, bu = slope * at.b.u, bv = slope * at.b.v;
    return {limit + f.p,
            au * f.pu + bu * f.pv,
            av * f.pu + bv * f.pv,
            au * au * f.puu + 2 * au * bu * f.puv + bu * bu * f.pvv,
            au * av * f.puu + (au * bv + av * bu) * f.puv + bu * bv * f.pvv,
            av * av * f.puu + 2 * av * bv * f.puv + bv * bv * f.pvv};
}

constexpr int kReferenceLevels = 44; ///< of exact end caps: nearer to the vertex (u,v) has no digits left

/// Sine under which tangents count as parallel: OpenSubdiv's own at straight corners are 1.5e-5 off.
constexpr double kParallel = 1e-4;
/// A cross product below this share of the square of the longer tangent is rounding. Long thin faces have small ones,
/// too.
constexpr double kVanishing = 1e-9;

bool isCorner(int sideCount, const dvec2& uv) {
    for (int corner = 0; corner < sideCount; ++corner)
        if (uv == sidePoint(sideCount, corner, 0)) return true;
    return false;
}

/// The sum of the directions from a corner to its two neighbours, by (u,v).
dvec2 diagonalFrom(int sideCount, const dvec2& corner) {
    if (sideCount == 4) return dvec2(1) - 2.0 * corner;
    return dvec2(1) - 3.0 * corner;
}

} // namespace

struct ReferenceSurface::Parts {
    using Handle = Far::PatchTable::PatchHandle;

    Parts(const Cage& cage, const SurfaceOptions& options)
        : tables(makeFarTables(cage, options, kReferenceLevels)), map(*tables.patches),
          sideCount(options.scheme == Scheme::loop ? 3 : 4), points(refineAll(tables, cage.positions)),
          texPoints(refineAllTex(tables, cage.texCoords)), isCutShort(hasFiniteSharpnessPast(cage, tables.isolation)) {}

    [[nodiscard]] const Handle* find(int face, const dvec2& uv) const { return map.FindPatch(face, uv.x, uv.y); }

    [[nodiscard]] const Handle& patchAt(int face, const dvec2& uv) const {
        const int faceCount = tables.patches->GetNumPtexFaces();
        if (face < 0 || face >= faceCount) fail(Failure::input, "face {} is out of range: 0..{}", face, faceCount - 1);
        const Handle* handle = find(face, uv);
        if (!handle) fail(Failure::input, "face {} is a hole: it has no surface", face);
        return *handle;
    }

    [[nodiscard]] PatchWeights weightsAt(const Handle& handle, const dvec2& uv) const {
        const Far::PatchParam param = tables.patches->GetPatchParam(handle);
        const int type = tables.patches->GetPatchDescriptor(handle).GetType();
        if (isGregory(type)) return gregoryWeights(type, param, uv);
        WeightArrays w;
        tables.patches->EvaluateBasis(handle, uv.x, uv.y, w.p, w.u, w.v, w.uu, w.uv, w.vv);
        PatchWeights weights = w.jets();
        correctDerivatives(weights, sideCount, param);
        return weights;
    }

    [[nodiscard]] PatchWeights texWeightsAt(const Handle& handle, const dvec2& uv) const {
        const Far::PatchTable& patches = *tables.patches;
        const Far::PatchParam param = patches.GetPatchFVarPatchParam(handle);
        const int type =
            (param.IsRegular() ? patches.GetFVarPatchDescriptorRegular() : patches.GetFVarPatchDescriptorIrregular())
                .GetType();
        if (isGregory(type)) return gregoryWeights(type, param, uv);
        WeightArrays w;
        patches.EvaluateBasisFaceVarying(handle, uv.x, uv.y, w.p, w.u, w.v);
        PatchWeights weights = w.jets();
        correctDerivatives(weights, sideCount, param);
        return weights;
    }

    /// The exact cap that a patch is, of the surface or of the texture coordinates; null for other patches.
    [[nodiscard]] static const EndCap* capOf(const std::vector<std::optional<EndCap>>& caps, const Handle& handle) {
        const auto patch = std::size_t(handle.patchIndex);
        return patch < caps.size() && caps[patch] ? &*caps[patch] : nullptr;
    }

    /// `all`: values as the patch table indexes them, limit points from `firstLimit` on.
    template <typename Value>
    [[nodiscard]] auto evaluateCap(const EndCap& cap, const Handle& handle, const dvec2& uv,
                                   const std::vector<Value>& all, std::size_t firstLimit) const {
        const Far::PatchParam param = tables.patches->GetPatchParam(handle);
        double u = uv.x, v = uv.y, slope = 1 << depthInFace(param);
        if (sideCount == 4) {
            param.Normalize(u, v);
        } else {
            param.NormalizeTriangle(u, v);
            if (param.IsTriangleRotated()) slope = -slope;
        }
        const auto limit = all[firstLimit + cap.limit].value;
        std::vector<std::decay_t<decltype(limit)>> values;
        for (const int point : cap.points) values.push_back(all[std::size_t(point)].value - limit);
        return capFrame(*tables.caps.patterns[cap.pattern], capCoordinates(sideCount, cap.corner, {u, v}), slope, limit,
                        values);
    }

    FarTables tables;
    Far::PatchMap map;
    int sideCount;
    std::vector<Point> points;
    std::vector<TexPoint> texPoints;
    bool isCutShort; ///< some finite sharpness outlasts the isolation
};

bool LimitFrame::hasTangentPlane() const {
    const double uu = glm::dot(pu, pu), vv = glm::dot(pv, pv);
    return glm::length(glm::cross(pu, pv)) > std::max(kParallel * std::sqrt(uu * vv), kVanishing * std::max(uu, vv));
}

ReferenceSurface::ReferenceSurface(const Cage& cage, const SurfaceOptions& options)
    : parts_(std::make_unique<Parts>(cage, options)) {}
ReferenceSurface::~ReferenceSurface() = default;
ReferenceSurface::ReferenceSurface(ReferenceSurface&&) noexcept = default;
ReferenceSurface& ReferenceSurface::operator=(ReferenceSurface&&) noexcept = default;

void ReferenceSurface::pose(std::span<const vec3> cagePositions) {
    const auto count = std::size_t(parts_->tables.refiner->GetLevel(0).GetNumVertices());
    if (cagePositions.size() != count)
        fail(Failure::input, "{} positions were given for a cage of {} points", cagePositions.size(), count);
    parts_->points = refineAll(parts_->tables, cagePositions);
}

int ReferenceSurface::faceCount() const { return parts_->tables.patches->GetNumPtexFaces(); }

int ReferenceSurface::sideCount() const { return parts_->sideCount; }

bool ReferenceSurface::hasTexCoords() const { return !parts_->texPoints.empty(); }
bool ReferenceSurface::isHole(int face) const { return !parts_->find(face, dvec2(0)); }

bool ReferenceSurface::isApproximate(int face, const dvec2& uv) const {
    const auto& patches = *parts_->tables.patches;
    const auto& handle = parts_->patchAt(face, uv);
    if (isGregory(patches.GetPatchDescriptor(handle).GetType()) && !Parts::capOf(parts_->tables.caps.surface, handle))
        return true;
    return parts_->isCutShort && patches.GetPatchParam(handle).GetDepth() >= parts_->tables.isolation;
}

int ReferenceSurface::facesPerWave(int face, const dvec2& corner) const {
    const EndCap* cap = Parts::capOf(parts_->tables.caps.surface, parts_->patchAt(face, corner));
    if (!cap || !isCorner(parts_->sideCount, corner)) return 0;
    const CapPattern& pattern = parts_->tables.caps.patterns[cap->pattern]->pattern();
    return pattern.isClosed && !pattern.hasDart ? pattern.faceCount : 2 * pattern.faceCount;
}

LimitFrame ReferenceSurface::limit(int face, const dvec2& uv) const {
    const auto& handle = parts_->patchAt(face, uv);
    if (const EndCap* cap = Parts::capOf(parts_->tables.caps.surface, handle)) {
        const auto f = parts_->evaluateCap(*cap, handle, uv, parts_->points, pointCount(parts_->tables));
        return {f.p, f.pu, f.pv, f.puu, f.puv, f.pvv};
    }
    const PatchWeights weights = parts_->weightsAt(handle, uv);
    const auto indices = parts_->tables.patches->GetPatchVertices(handle);
    LimitFrame frame;
    for (int i = 0; i < indices.size(); ++i) {
        const dvec3& p = parts_->points[indices[i]].value;
        const Jet& w = weights[i];
        frame.p += w.f * p;
        frame.pu += w.u * p, frame.pv += w.v * p;
        frame.puu += w.uu * p, frame.puv += w.uv * p, frame.pvv += w.vv * p;
    }
    return frame;
}

TexFrame ReferenceSurface::texture(int face, const dvec2& uv) const {
    const auto& handle = parts_->patchAt(face, uv);
    if (parts_->texPoints.empty()) return {uv, dmat2(1)};
    if (const EndCap* cap = Parts::capOf(parts_->tables.caps.texture, handle)) {
        const auto f = parts_->evaluateCap(*cap, handle, uv, parts_->texPoints, texPointCount(parts_->tables));
        return {f.p, dmat2(f.pu, f.pv)};
    }
    const PatchWeights weights = parts_->texWeightsAt(handle, uv);
    const auto indices = parts_->tables.patches->GetPatchFVarValues(handle);
    TexFrame frame{dvec2(0), dmat2(0)};
    for (int i = 0; i < indices.size(); ++i) {
        const dvec2& st = parts_->texPoints[indices[i]].value;
        frame.st += weights[i].f * st;
        frame.jacobian[0] += weights[i].u * st;
        frame.jacobian[1] += weights[i].v * st;
    }
    return frame;
}

dvec3 ReferenceSurface::areaNormal(int face, const dvec2& uv) const {
    const auto product = [&](const dvec2& at) {
        const LimitFrame frame = limit(face, at);
        return glm::cross(frame.pu, frame.pv);
    };
    const LimitFrame frame = limit(face, uv);
    // At creases exact end caps have two directions of the tangent plane, however thin the face is.
    const EndCap* cap = Parts::capOf(parts_->tables.caps.surface, parts_->patchAt(face, uv));
    const bool isCrease = cap && parts_->tables.caps.patterns[cap->pattern]->pattern().rule == VertexRule::crease;
    if (isCrease || frame.hasTangentPlane() || !isCorner(parts_->sideCount, uv)) return glm::cross(frame.pu, frame.pv);
    // One-sided differences of second order, small within the patch that holds the corner.
    const auto depth = depthInFace(parts_->tables.patches->GetPatchParam(parts_->patchAt(face, uv)));
    const double h = std::ldexp(1e-3, -depth);
    const dvec2 step = h * diagonalFrom(parts_->sideCount, uv);
    return (4.0 * product(uv + step) - 3.0 * product(uv) - product(uv + 2.0 * step)) / (2 * h);
}

dvec3 ReferenceSurface::normal(int face, const dvec2& uv) const {
    const LimitFrame frame = limit(face, uv);
    if (frame.hasTangentPlane() && !isCorner(parts_->sideCount, uv))
        return glm::normalize(glm::cross(frame.pu, frame.pv));
    const auto largestSquare = [](const LimitFrame& f) { return std::max(glm::dot(f.pu, f.pu), glm::dot(f.pv, f.pv)); };
    const dvec2 center(parts_->sideCount == 4 ? 1.0 / 2 : 1.0 / 3);
    const double here = largestSquare(frame);
    const bool vanishes = here < kParallel * kParallel * largestSquare(limit(face, center));
    const dvec3 product = areaNormal(face, uv);
    if (!vanishes && glm::length(product) > kVanishing * here) return glm::normalize(product);
    for (const double step : {1e-3, 1e-2, 1e-1, 1.0}) {
        const LimitFrame inside = limit(face, glm::mix(uv, center, step));
        if (inside.hasTangentPlane()) return glm::normalize(glm::cross(inside.pu, inside.pv));
    }
    return {0, 0, 1}; // the face has no area: any direction is as good
}

} // namespace relief
