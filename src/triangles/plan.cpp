#include <algorithm>
#include <cmath>
#include <map>

#include "model/bounds.h"
#include "shared/dice.h"
#include "triangles/stages.h"

namespace relief {
namespace {

/// The tessellator's concentric triangles, all sides with n segments.
std::uint64_t evenTriangle(std::uint64_t n) { return n % 2 == 0 ? 3 * n * n / 2 : (3 * n * n - 1) / 2; }

/// Vertices inside a tessellated triangle with n segments per side: the ring of the triangle two segments smaller, and
/// so on.
std::uint64_t insideTriangle(std::uint64_t n) {
    return n < 3 ? n - 1 : 3 * (n - 2) + (n == 3 ? 0 : insideTriangle(n - 2));
}

/// Corners and samples along edges, each once whatever faces share them.
std::uint64_t sharedVertices(const SurfaceModel& model, const EdgeRates& rates) {
    std::uint64_t count = model.cornerFlags.size();
    for (std::uint32_t edge = 0; edge < rates.rates.size(); ++edge) count += rates.segments(edge) - 1;
    return count;
}

std::uint64_t sumOf(std::span<const std::uint32_t> numbers) {
    std::uint64_t sum = 0;
    for (const std::uint32_t number : numbers) sum += number;
    return sum;
}

/// Drawn faces that are visible, or those that are not.
std::vector<std::uint32_t> facesOf(const SurfaceModel& model, std::span<const char> isVisible, bool isHidden) {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < model.faces.size(); ++f)
        if (model.faces[f].root != kNoPatch && isHidden == (!isVisible.empty() && isVisible[f] == 0))
            faces.push_back(f);
    return faces;
}

glm::dvec4 cornerInClip(const Bounds& box, int corner, const mat4& worldToClip) {
    const dvec3 p((corner & 1) != 0 ? box.upper.x : box.lower.x, (corner & 2) != 0 ? box.upper.y : box.lower.y,
                  (corner & 4) != 0 ? box.upper.z : box.lower.z);
    return glm::dmat4(worldToClip) * glm::dvec4(p, 1);
}

/// True when a corner of the box is nearer than the near plane, where depth is 1.
bool isCut(const Bounds& box, const mat4& worldToClip) {
    for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
        const glm::dvec4 c = cornerInClip(box, corner, worldToClip);
        if (c.z > c.w) return true;
    }
    return false;
}

/// True when all corners of the box are beyond one plane of the view: left, right, below, above, behind, too far.
bool isOutside(const Bounds& box, const mat4& worldToClip) {
    int beyond[6] = {};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 c = cornerInClip(box, corner, worldToClip);
        const bool isBeyond[6] = {c.x<-c.w, c.x> c.w, c.y<-c.w, c.y> c.w, c.z > c.w, c.z < 0};
        for (int plane = 0; plane < 6; ++plane) beyond[plane] += isBeyond[plane] ? 1 : 0;
    }
    return std::ranges::find(beyond, 8) != std::end(beyond);
}

/// True when m . (q - eye) > 0 for every normal m and every point q of the bounds: with the angle x between q - eye and
/// the axis that is along cos x > across sin x. All q lie in a ball around the box's centre.
bool facesAway(const Bounds& box, const NormalBounds& normals, const dvec3& eye) {
    const dvec3 toCenter = box.center() - eye;
    const double distance = glm::length(toCenter), radius = box.diagonal() / 2;
    if (normals.along <= 0 || distance <= radius) return false;
    const double angle =
        std::acos(std::clamp(glm::dot(toCenter, normals.axis) / distance, -1.0, 1.0)) + std::asin(radius / distance);
    return angle < 1.57 && normals.along * std::cos(angle) > normals.across * std::sin(angle);
}

/// The coarsest mip level that lookups on a face read.
int coarsestLevel(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t face) {
    if (!rates.hasMips() || model.faces[face].root == kNoPatch) return 0;
    float level = 0;
    for (int side = 0; side < model.sideCount; ++side) {
        const std::uint32_t entry = model.faces[face].sides[side], edge = entry & kSideEdgeMask;
        for (std::uint32_t half = edge; half <= edge + ((entry & kSideSplit) != 0 ? 1 : 0); ++half)
            for (const std::uint32_t corner : model.edges[half].corners)
                level = std::max(level, rates.cornerLevels[corner]);
    }
    return int(std::ceil(level));
}

/// The model's boxes, grown by what coarser levels than 0 may add to its heights.
std::vector<Bounds> boundsOfLevels(const SurfaceModel& model, const EdgeRates& rates) {
    std::vector<Bounds> boxes = model.faceBounds;
    for (std::uint32_t face = 0; face < boxes.size() && rates.hasMips(); ++face) {
        const int level = coarsestLevel(model, rates, face);
        if (level == 0 || boxes[face].isEmpty()) continue;
        const float bound = heightBound(model.heightPyramid, model.faceTexBoxes[face], level);
        const double growth = double(bound) - double(model.faceHeightBounds[face]);
        boxes[face].lower -= growth, boxes[face].upper += growth;
    }
    return boxes;
}

NormalBounds normalsOfLevel(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t face) {
    const int level = coarsestLevel(model, rates, face);
    if (level == 0) return model.normalBounds[face];
    return displacedNormals(model.faceNormals[face], model.heightPyramid.range(model.faceTexBoxes[face], level));
}

} // namespace

std::uint64_t dicedTriangles(std::span<const std::uint32_t> r) {
    const auto sideCount = std::uint32_t(r.size());
    const std::uint64_t sum = sumOf(r);
    if (sum == sideCount) return sideCount - 2;
    const uvec2 n = formulas::latticeSegments(sideCount, r[0], r[1], r[2], sideCount == 4 ? r[3] : 0);
    return formulas::ringTriangles(sideCount, std::uint32_t(sum), n) + formulas::cellTriangles(sideCount, n);
}

std::uint64_t tessellatedTriangles(std::span<const std::uint32_t> r) {
    // Quads of the fixed-function tessellator have the rings and cells of diced ones.
    const std::uint64_t sum = sumOf(r);
    if (r.size() == 4 || sum == 3) return dicedTriangles(r);
    const std::uint64_t n = std::max({r[0], r[1], r[2]});
    return sum + 3 * (n - 2) + evenTriangle(n - 2);
}

std::vector<char> visibleFaces(const SurfaceModel& model, const mat4& worldToClip, const View& view,
                               const EdgeRates& rates) {
    // Lookups in coarse mip levels read farther than those that the model's boxes hold.
    const std::vector<Bounds> boxes = boundsOfLevels(model, rates);

    // Where the near plane cuts the object open, and from within, insides are seen.
    const bool seesOutside = !model.normalBounds.empty() &&
                             std::ranges::none_of(boxes, [&](const Bounds& box) { return isCut(box, worldToClip); });
    std::vector<char> isVisible;
    isVisible.reserve(boxes.size());
    for (std::uint32_t face = 0; face < boxes.size(); ++face) {
        const auto isBack = [&] { return facesAway(boxes[face], normalsOfLevel(model, rates, face), dvec3(view.eye)); };
        const bool isHidden = boxes[face].isEmpty() || isOutside(boxes[face], worldToClip) || (seesOutside && isBack());
        isVisible.push_back(isHidden ? 0 : 1);
    }
    return isVisible;
}

DrawPlan planPatches(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t verticesPerDraw,
                     std::span<const char> isVisible) {
    DrawPlan plan;
    plan.vertexCount = sharedVertices(model, rates);
    for (const std::uint32_t hidden : {0u, 1u}) { // visible faces first
        std::uint64_t vertices = 0;
        const std::size_t firstBatch = plan.batches.size();
        for (const std::uint32_t f : facesOf(model, isVisible, hidden != 0)) {
            // A new draw where this face would make the one before too large.
            const FaceSegments face = faceSegments(model, rates, f);
            const std::uint64_t largest = std::max(face.u, face.v), more = (largest + 1) * (largest + 1);
            if (plan.batches.size() == firstBatch || vertices + more > verticesPerDraw) {
                plan.batches.push_back({.firstFace = std::uint32_t(plan.faces.size())});
                vertices = 0;
            }
            vertices += more;
            ++plan.batches.back().faceCount;
            plan.faces.push_back(f);

            // What it adds to the counts; its corners and edges are counted already.
            plan.triangleCount += tessellatedTriangles({face.sides, std::size_t(model.sideCount)});
            if (model.isTriangles())
                plan.vertexCount += insideTriangle(largest);
            else if (largest > 1)
                plan.vertexCount +=
                    std::uint64_t(formulas::atLeastInner(4, face.u) - 1) * (formulas::atLeastInner(4, face.v) - 1);
            plan.maxRate = std::max(plan.maxRate, std::uint32_t(std::ceil(face.largestRate)));
        }
        if (hidden == 0) plan.visibleBatchCount = plan.batches.size(), plan.visibleFaceCount = plan.faces.size();
    }
    return plan;
}

DrawPlan planGrids(const SurfaceModel& model, const EdgeRates& rates, std::span<const char> isVisible) {
    DrawPlan plan;
    plan.vertexCount = sharedVertices(model, rates);
    for (const std::uint32_t hidden : {0u, 1u}) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> groups;
        for (const std::uint32_t f : facesOf(model, isVisible, hidden != 0)) {
            const FaceSegments face = faceSegments(model, rates, f);
            groups[{face.u, face.v}].push_back(f);
        }
        for (const auto& [size, faces] : groups) {
            const auto& [u, v] = size;
            plan.batches.push_back({u, v, std::uint32_t(plan.faces.size()), std::uint32_t(faces.size())});
            plan.faces.insert(plan.faces.end(), faces.begin(), faces.end());
            plan.triangleCount += faces.size() * std::uint64_t(u) * v * (model.isTriangles() ? 1 : 2);
            const std::uint64_t inside =
                model.isTriangles() ? std::uint64_t(u - 1) * (std::max(u, 2u) - 2) / 2 : std::uint64_t(u - 1) * (v - 1);
            plan.vertexCount += faces.size() * inside;
            plan.maxRate = std::max({plan.maxRate, u, v});
        }
        if (hidden == 0) plan.visibleBatchCount = plan.batches.size(), plan.visibleFaceCount = plan.faces.size();
    }
    return plan;
}

std::uint64_t plannedTriangles(const SurfaceModel& model, Path path, const EdgeRates& rates) {
    std::uint64_t count = 0;
    for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
        if (model.faces[f].root == kNoPatch) continue;
        const FaceSegments face = faceSegments(model, rates, f);
        const std::span<const std::uint32_t> sides(face.sides, std::size_t(model.sideCount));
        count += path == Path::grid   ? std::uint64_t(face.u) * face.v * (model.isTriangles() ? 1 : 2)
                 : path == Path::dice ? dicedTriangles(sides)
                                      : tessellatedTriangles(sides);
    }
    return count;
}

std::vector<std::uint32_t> gridIndices(std::uint32_t columns, std::uint32_t rows) {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t(columns) * rows * 6);
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (columns + 1) + i; };
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i)
            indices.insert(indices.end(),
                           {at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return indices;
}

std::vector<std::uint32_t> triangleGridIndices(std::uint32_t n) {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t(n) * n * 3);
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n - j; ++i) {
            indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 2 <= n) indices.insert(indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return indices;
}

} // namespace relief
