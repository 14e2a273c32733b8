#include "geometry_image/geometry_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "geometry_image/border.h"
#include "geometry_image/cut.h"
#include "geometry_image/grid.h"
#include "geometry_image/spread.h"

namespace relief {
namespace {

constexpr int kMostExtremes = 20;    ///< paths that are added to a cut
constexpr double kWorthAPath = 0.95; ///< a path stays where it takes the stretch below this share of itself
constexpr int kStretchSteps = 1;     ///< a start, from which relaxing goes on
constexpr int kRelaxingSteps = 60;   ///< at most: relaxing ends where a step gains too little

/// Extends the cut through the points that the map over a disk stretches most, one after another, while that makes the
/// stretch smaller (Gu et al. 2002, section 3.2).
void cutThroughExtremes(CutMesh& mesh, Progress& progress) {
    std::vector<char> best = mesh.isCut;
    double least = std::numeric_limits<double>::infinity();
    for (int extremes = 0; extremes <= kMostExtremes; ++extremes) {
        const Disk disk = cutOpen(mesh);
        const SpreadMap map = spreadInside(mesh, disk, placeOnCircle(mesh, disk, walkBorder(mesh, disk)), 0);
        progress.advance();
        if (map.stretch > kWorthAPath * least) break;
        least = map.stretch, best = mesh.isCut;
        // From the vertex inside that is stretched most.
        const Stretch stretch = measureStretch(mesh, disk, map.st);
        std::uint32_t extreme = kNone;
        for (std::uint32_t v = 0; v < disk.vertexCount(); ++v)
            if (disk.isOnBorder[v] == 0 && (extreme == kNone || stretch.perVertex[v] > stretch.perVertex[extreme]))
                extreme = v;
        const Route route = extreme == kNone ? Route{} : findRouteToBorder(mesh, disk, extreme);
        if (route.halfEdges.empty()) break;
        for (const std::uint32_t h : route.halfEdges) mesh.setCut(h, true);
    }
    mesh.isCut = best;
}

/// The point of the border at a share of a path, on its edges.
SurfaceSample samplePath(const CutMesh& mesh, const BorderPath& path, double share) {
    double left = share * path.length;
    for (const std::uint32_t h : path.halfEdges) {
        const double length = mesh.length(h);
        if (left > length && h != path.halfEdges.back()) {
            left -= length;
            continue;
        }
        const double fraction = length > 0 ? std::clamp(left / length, 0.0, 1.0) : 0;
        return {glm::mix(mesh.positions[mesh.from(h)], mesh.positions[mesh.to(h)], fraction),
                glm::mix(mesh.normals[mesh.from(h)], mesh.normals[mesh.to(h)], fraction)};
    }
    return {};
}

void setSample(GeometryImage& image, std::size_t index, const SurfaceSample& sample) {
    image.positions[index] = vec3(sample.position);
    const double length = glm::length(sample.normal);
    image.normals[index] = length > 1e-12 ? vec3(sample.normal / length) : vec3(0, 0, 1);
}

using Settle = SpreadSurface::Settle;

/// The border's samples: each path once, so that its mate has the same bits. Ends of paths are evaluated once per path:
/// `settle` gives the same for the same point.
void sampleBorder(GeometryImage& image, const CutMesh& mesh, std::span<const BorderPath> paths, const Settle& settle) {
    const int scale = (image.size - 1) / image.sewing.sideSegments;
    std::vector<int> firsts;
    int at = image.sewing.first;
    for (const Sewing::Path& path : image.sewing.paths) firsts.push_back(at), at += path.segments;
    for (std::size_t p = 0; p < paths.size(); ++p) {
        const auto mate = std::size_t(image.sewing.paths[p].mate);
        if (mate < p) continue;
        const int count = scale * image.sewing.paths[p].segments;
        for (int k = 0; k <= count; ++k) {
            // Nodes belong to several paths: all of them take the vertex itself.
            SurfaceSample sample = samplePath(mesh, paths[p], double(k) / count);
            const auto atVertex = [&](std::uint32_t v) { sample = {mesh.positions[v], mesh.normals[v]}; };
            if (k == 0) atVertex(mesh.from(paths[p].halfEdges.front()));
            if (k == count) atVertex(mesh.to(paths[p].halfEdges.back()));
            if (settle) settle(sample.position, sample.normal);
            setSample(image, borderSample(scale * firsts[p] + k, image.size), sample);
            if (mate != p) setSample(image, borderSample(scale * firsts[mate] + count - k, image.size), sample);
        }
    }
}

} // namespace

struct SpreadSurface::Parts {
    CutMesh mesh;
    SquareBorder border;
    SpreadMap map;
    GeometryImageReport report;
    Coordinates coordinates;
    std::string name;
};

SpreadSurface::SpreadSurface(const DenseMesh& mesh, const std::string& name, const GeometryImageOptions& options)
    : parts_(std::make_unique<Parts>()) {
    if (options.size < 17 || options.size > kLargestGeometryImage)
        fail(Failure::usage, "a geometry image has 17 to {} samples per side, not {}", kLargestGeometryImage,
             options.size);
    Progress progress("spreading", kMostExtremes + 6, options.progress);
    Parts& parts = *parts_;
    parts.coordinates = mesh.coordinates, parts.name = name;
    CutMesh& cut = parts.mesh;
    cut = makeCutMesh(mesh, name);
    GeometryImageReport& report = parts.report;
    report.triangles = cut.halfEdgeCount() / 3;
    report.boundaryCount = countBoundaries(cut);
    std::int64_t edges = 0;
    for (std::uint32_t h = 0; h < cut.halfEdgeCount(); ++h) edges += std::int64_t(h < cut.twins[h]);
    const std::int64_t euler = std::int64_t(cut.positions.size()) - edges + std::int64_t(report.triangles);
    report.genus = int((2 - report.boundaryCount - euler) / 2);
    progress.advance();

    // The cut: to a disk, short, and through extreme points.
    cutToDisk(cut);
    progress.advance();
    shortenPaths(cut);
    progress.advance();
    cutThroughExtremes(cut, progress);
    smoothPaths(cut);

    // The square.
    parts.border = fitSquare(cut, options.size, name);
    for (std::size_t p = 0; p < parts.border.paths.size(); ++p)
        if (parts.border.paths[p].mate > p) ++report.pathCount, report.cutLength += parts.border.paths[p].length;
    parts.map = spreadInside(cut, parts.border.disk, placeOnSquare(cut, parts.border), kStretchSteps);
    progress.advance();
    relaxInside(cut, parts.border.disk, parts.map.st, kRelaxingSteps);
    parts.map.stretch = measureStretch(cut, parts.border.disk, parts.map.st).total;
    report.stretch = parts.map.stretch, report.firstStretch = parts.map.firstStretch;
}

SpreadSurface::~SpreadSurface() = default;
SpreadSurface::SpreadSurface(SpreadSurface&&) noexcept = default;
SpreadSurface& SpreadSurface::operator=(SpreadSurface&&) noexcept = default;

const GeometryImageReport& SpreadSurface::report() const { return parts_->report; }
int SpreadSurface::sideSegments() const { return parts_->border.sewing.sideSegments; }

GeometryImage SpreadSurface::sample(int size, const Settle& settle) const {
    const Parts& parts = *parts_;
    const int side = sideSegments();
    if (size < 2 || size > kLargestGeometryImage || (size - 1) % side != 0)
        fail(Failure::usage,
             "{}: an image of {} samples per side does not fit its border, which has {} segments per side", parts.name,
             size, side);
    GeometryImage image{.size = size, .sewing = parts.border.sewing, .coordinates = parts.coordinates};
    const auto count = std::size_t(size) * std::size_t(size);
    image.positions.resize(count), image.normals.resize(count);
    // The sewing in segments of this image's own coarsest mip.
    const auto scaleSewing = [&](int factor) {
        image.sewing.sideSegments *= factor, image.sewing.first *= factor;
        for (Sewing::Path& path : image.sewing.paths) path.segments *= factor;
    };
    const auto times = unsigned((size - 1) / side);
    scaleSewing(int(times >> std::countr_zero(times)));
    // The border, then what is inside.
    sampleBorder(image, parts.mesh, parts.border.paths, settle);
    std::vector<SurfaceSample> inside = sampleGrid(parts.mesh, parts.border.disk, parts.map.st, size);
    for (int j = 1; j + 1 < size; ++j)
        for (int i = 1; i + 1 < size; ++i) {
            const std::size_t index = std::size_t(j) * std::size_t(size) + std::size_t(i);
            if (settle) settle(inside[index].position, inside[index].normal);
            setSample(image, index, inside[index]);
        }
    // Mips whose border would fold into itself are none.
    while (true) {
        const SewnGrid grid = sewGrid(image, image.mipCount() - 1);
        std::vector<std::uint32_t> indices;
        for (const std::uint32_t corner : grid.corners) indices.push_back(grid.vertices[corner]);
        const MeshFaults faults = findFaults(indices);
        if (faults.otherEdges == 0 && faults.degenerateTriangles == 0) return image;
        if (image.mipCount() == 1)
            fail(Failure::input, "{}: an image of {} samples per side is too small for its cut of {} paths", parts.name,
                 size, parts.report.pathCount);
        scaleSewing(2);
    }
}

} // namespace relief
