#include "surface/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

namespace relief {
namespace {

using SchemeOptions = OpenSubdiv::Sdc::Options;

/// A value that OpenSubdiv can blend.
template <typename V>
struct Sum {
    V value{0};
    // NOLINTBEGIN(readability-identifier-naming): the names are OpenSubdiv's
    void Clear() { value = V(0); }
    void AddWithWeight(const Sum& other, double w) { value += w * other.value; }
    // NOLINTEND(readability-identifier-naming)
};

std::vector<int> asInts(const std::vector<std::uint32_t>& values) { return {values.begin(), values.end()}; }

SchemeOptions optionsOf(const Cage& cage) {
    SchemeOptions options;
    options.SetVtxBoundaryInterpolation(cage.boundaryRule == BoundaryRule::none ? SchemeOptions::VTX_BOUNDARY_NONE
                                        : cage.boundaryRule == BoundaryRule::edgeOnly
                                            ? SchemeOptions::VTX_BOUNDARY_EDGE_ONLY
                                            : SchemeOptions::VTX_BOUNDARY_EDGE_AND_CORNER);
    options.SetFVarLinearInterpolation(SchemeOptions::FVarLinearInterpolation(cage.texBoundaryRule));
    if (cage.creaseMethod == CreaseMethod::chaikin) options.SetCreasingMethod(SchemeOptions::CREASE_CHAIKIN);
    return options;
}

using RefinerFactory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

std::unique_ptr<Far::TopologyRefiner> refinerOf(const Cage& cage, Scheme scheme) {
    const auto sizes = asInts(cage.faceSizes), corners = asInts(cage.corners), creases = asInts(cage.creaseEdges);
    const auto sharpVertices = asInts(cage.sharpVertices), holes = asInts(cage.holes);
    const auto texCorners = asInts(cage.texCorners);
    const Far::TopologyDescriptor::FVarChannel channel = [&] {
        Far::TopologyDescriptor::FVarChannel c;
        c.numValues = int(cage.texCoords.size());
        c.valueIndices = texCorners.data();
        return c;
    }();
    Far::TopologyDescriptor topology;
    topology.numVertices = int(cage.positions.size());
    topology.numFaces = int(sizes.size());
    topology.numVertsPerFace = sizes.data();
    topology.vertIndicesPerFace = corners.data();
    topology.numCreases = int(cage.creaseSharpness.size());
    topology.creaseVertexIndexPairs = creases.data();
    topology.creaseWeights = cage.creaseSharpness.data();
    topology.numCorners = int(sharpVertices.size());
    topology.cornerVertexIndices = sharpVertices.data();
    topology.cornerWeights = cage.vertexSharpness.data();
    topology.numHoles = int(holes.size());
    topology.holeIndices = holes.data();
    topology.numFVarChannels = cage.texCorners.empty() ? 0 : 1;
    topology.fvarChannels = &channel;

    const auto type = scheme == Scheme::loop       ? OpenSubdiv::Sdc::SCHEME_LOOP
                      : scheme == Scheme::bilinear ? OpenSubdiv::Sdc::SCHEME_BILINEAR
                                                   : OpenSubdiv::Sdc::SCHEME_CATMARK;
    return std::unique_ptr<Far::TopologyRefiner>(
        RefinerFactory::Create(topology, RefinerFactory::Options(type, optionsOf(cage))));
}

/// Limit masks take what is still sharp for infinitely sharp: the levels after which only that is left.
int levelsToSmooth(const Cage& cage) {
    float sharpest = 0;
    for (const auto& sharpness : {cage.creaseSharpness, cage.vertexSharpness})
        for (const float s : sharpness)
            if (s < OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE) sharpest = std::max(sharpest, s);
    return int(std::ceil(sharpest));
}

template <typename Array>
bool contains(const Array& array, int value) {
    return array.FindIndex(value) >= 0;
}

} // namespace

Oracle::Oracle(const Cage& cage, Scheme scheme, int gridSize)
    : sideCount_(scheme == Scheme::loop ? 3 : 4), gridSize_(gridSize), refiner_(refinerOf(cage, scheme)) {
    const bool hasNgons = std::any_of(cage.faceSizes.begin(), cage.faceSizes.end(),
                                      [&](std::uint32_t size) { return int(size) != sideCount_; });
    int levels = 0;
    while (1 << levels < gridSize) ++levels;
    Far::TopologyRefiner::UniformOptions options(std::max(levels + (hasNgons ? 1 : 0), levelsToSmooth(cage)));
    options.fullTopologyInLastLevel = true;
    refiner_->RefineUniform(options);
    traceFaces();
    makeGrids();
    interpolate(cage);
}

void Oracle::traceFaces() {
    cageFaceOf_.resize(refiner_->GetNumLevels());
    cageFaceOf_[0].resize(refiner_->GetLevel(0).GetNumFaces());
    std::iota(cageFaceOf_[0].begin(), cageFaceOf_[0].end(), 0);
    for (int level = 1; level < refiner_->GetNumLevels(); ++level)
        for (int face = 0; face < refiner_->GetLevel(level).GetNumFaces(); ++face)
            cageFaceOf_[level].push_back(cageFaceOf_[level - 1][refiner_->GetLevel(level).GetFaceParentFace(face)]);
}

// The order of child faces is not used: a finer vertex is the child of the face, edge or vertex that lies there.
void Oracle::makeGrids() {
    for (int cageFace = 0; cageFace < refiner_->GetLevel(0).GetNumFaces(); ++cageFace) {
        const int size = refiner_->GetLevel(0).GetFaceVertices(cageFace).size();
        for (int i = 0; i < (size == sideCount_ ? 1 : size); ++i) {
            const int firstLevel = size == sideCount_ ? 0 : 1;
            Grid grid = startGrid(cageFace, i);
            for (int level = firstLevel; level + 1 < refiner_->GetNumLevels(); ++level)
                grid = refined(grid, level, cageFace);
            grids_.push_back(std::move(grid));
            cageFaces_.push_back(cageFace);
        }
    }
}

Oracle::Grid Oracle::startGrid(int cageFace, int corner) const {
    const auto& level = refiner_->GetLevel(0);
    const auto vertices = level.GetFaceVertices(cageFace);
    const auto edges = level.GetFaceEdges(cageFace);
    const int size = vertices.size();
    Grid grid(1);
    if (size != sideCount_) { // the level-1 quad at the corner of an n-gon
        grid.at(0, 0) = level.GetVertexChildVertex(vertices[corner]);
        grid.at(1, 0) = level.GetEdgeChildVertex(edges[corner]);
        grid.at(1, 1) = level.GetFaceChildVertex(cageFace);
        grid.at(0, 1) = level.GetEdgeChildVertex(edges[(corner + size - 1) % size]);
        return grid;
    }
    grid.at(0, 0) = vertices[0];
    grid.at(1, 0) = vertices[1];
    grid.at(size == 3 ? 0 : 1, 1) = vertices[2];
    if (size == 4) grid.at(0, 1) = vertices[3];
    return grid;
}

Oracle::Grid Oracle::refined(const Grid& coarse, int levelIndex, int cageFace) const {
    const auto& level = refiner_->GetLevel(levelIndex);
    const auto middle = [&](int a, int b) { return level.GetEdgeChildVertex(level.FindEdge(a, b)); };
    Grid fine(2 * coarse.side);
    for (int j = 0; j <= fine.side; ++j) {
        for (int i = 0; i <= (sideCount_ == 3 ? fine.side - j : fine.side); ++i) {
            const int ci = i / 2, cj = j / 2;
            if (i % 2 == 0 && j % 2 == 0)
                fine.at(i, j) = level.GetVertexChildVertex(coarse.at(ci, cj));
            else if (j % 2 == 0)
                fine.at(i, j) = middle(coarse.at(ci, cj), coarse.at(ci + 1, cj));
            else if (i % 2 == 0)
                fine.at(i, j) = middle(coarse.at(ci, cj), coarse.at(ci, cj + 1));
            else if (sideCount_ == 3)
                fine.at(i, j) = middle(coarse.at(ci, cj + 1), coarse.at(ci + 1, cj));
            else
                fine.at(i, j) = level.GetFaceChildVertex(faceAround(coarse, levelIndex, cageFace, ci, cj));
        }
    }
    return fine;
}

/// The face of a level whose corners are the grid's cell (i,j).
int Oracle::faceAround(const Grid& grid, int levelIndex, int cageFace, int i, int j) const {
    const auto& level = refiner_->GetLevel(levelIndex);
    for (const int face : level.GetVertexFaces(grid.at(i, j))) {
        const auto vertices = level.GetFaceVertices(face);
        if (cageFaceOf_[levelIndex][face] == cageFace && contains(vertices, grid.at(i + 1, j)) &&
            contains(vertices, grid.at(i, j + 1)) && contains(vertices, grid.at(i + 1, j + 1)))
            return face;
    }
    ADD_FAILURE() << "no face around cell " << i << ' ' << j << " of cage face " << cageFace;
    return 0;
}

/// Where a vertex at the end of one crease comes to rest: OpenSubdiv's limit masks take it for a smooth one and are off
/// by 1e-3, its rules of refinement do not. The limit depends on the vertex and its faces alone, which are made a mesh
/// of their own: after each refinement the new faces around the vertex take their place. `cornersOf(face)`: indices of
/// values.
template <typename V, typename CornersOf>
V Oracle::limitAtDart(int vertex, const std::vector<V>& values, const CornersOf& cornersOf) const {
    constexpr int kAtRest = 120; // refinements: each multiplies the distance from the limit by 2/3 at most
    const auto& level = refiner_->GetLevel(refiner_->GetNumLevels() - 1);
    // The faces, each from the vertex on; the vertex has the number 0.
    const auto faces = level.GetVertexFaces(vertex);
    const auto places = level.GetVertexFaceLocalIndices(vertex);
    std::vector<int> corners, numbers, ring; // numbers: of the level's vertices; ring: of the values
    std::vector<std::array<int, 2>> creases;
    for (int f = 0; f < faces.size(); ++f)
        for (int k = 0; k < sideCount_; ++k) {
            const int corner = (places[f] + k) % sideCount_, number = level.GetFaceVertices(faces[f])[corner];
            const auto at = std::ranges::find(numbers, number) - numbers.begin();
            corners.push_back(int(at));
            if (at < std::ptrdiff_t(numbers.size())) continue;
            numbers.push_back(number), ring.push_back(cornersOf(faces[f])[corner]);
            const int edge = level.FindEdge(vertex, number);
            if (edge >= 0 && level.IsEdgeInfSharp(edge)) creases.push_back({0, int(at)});
        }
    if (creases.size() != 1) throw std::logic_error("a dart has one sharp edge");
    const std::vector<int> sizes(std::size_t(faces.size()), sideCount_);
    const float sharpness = OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE;
    Far::TopologyDescriptor topology;
    topology.numVertices = int(numbers.size());
    topology.numFaces = faces.size();
    topology.numVertsPerFace = sizes.data();
    topology.vertIndicesPerFace = corners.data();
    topology.numCreases = 1;
    topology.creaseVertexIndexPairs = creases.front().data();
    topology.creaseWeights = &sharpness;
    const std::unique_ptr<Far::TopologyRefiner> refiner(RefinerFactory::Create(
        topology, RefinerFactory::Options(refiner_->GetSchemeType(), refiner_->GetSchemeOptions())));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(1));

    // The child of each point of the ring that takes its place.
    const auto& coarse = refiner->GetLevel(0);
    std::vector<int> children(numbers.size());
    for (int f = 0; f < coarse.GetNumFaces(); ++f) {
        const auto at = coarse.GetFaceVertices(f);
        for (int k = 1; k < sideCount_; ++k) {
            const int edge = coarse.FindEdge(0, at[k]);
            children[at[k]] = edge >= 0 ? coarse.GetEdgeChildVertex(edge) : coarse.GetFaceChildVertex(f);
        }
    }
    children[0] = coarse.GetVertexChildVertex(0);
    const Far::PrimvarRefinerReal<double> interpolator(*refiner);
    std::vector<V> points, fine(refiner->GetLevel(1).GetNumVertices());
    for (const int value : ring) points.push_back(values[value]);
    for (int i = 0; i < kAtRest; ++i) {
        interpolator.Interpolate(1, points, fine);
        for (std::size_t k = 0; k < points.size(); ++k) points[k] = fine[children[k]];
    }
    return points[0];
}

void Oracle::interpolate(const Cage& cage) {
    const Far::PrimvarRefinerReal<double> interpolator(*refiner_);
    std::vector<Sum<dvec3>> points(cage.positions.size());
    std::vector<Sum<dvec2>> values(cage.texCoords.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i].value = dvec3(cage.positions[i]);
    for (std::size_t i = 0; i < values.size(); ++i) values[i].value = dvec2(cage.texCoords[i]);
    for (int level = 1; level < refiner_->GetNumLevels(); ++level) {
        std::vector<Sum<dvec3>> finePoints(refiner_->GetLevel(level).GetNumVertices());
        interpolator.Interpolate(level, points, finePoints);
        points.swap(finePoints);
        if (values.empty()) continue;
        std::vector<Sum<dvec2>> fineValues(refiner_->GetLevel(level).GetNumFVarValues());
        interpolator.InterpolateFaceVarying(level, values, fineValues);
        values.swap(fineValues);
    }
    std::vector<Sum<dvec3>> limitPoints(points.size());
    interpolator.Limit(points, limitPoints);
    const auto& last = refiner_->GetLevel(refiner_->GetNumLevels() - 1);
    std::vector<int> darts;
    for (int v = 0; v < last.GetNumVertices(); ++v)
        if (last.GetVertexRule(v) == OpenSubdiv::Sdc::Crease::RULE_DART) darts.push_back(v);
    for (const int v : darts)
        limitPoints[v] = limitAtDart(v, points, [&](int face) { return last.GetFaceVertices(face); });
    for (const auto& point : limitPoints) positions_.push_back(point.value);
    if (values.empty()) return;
    std::vector<Sum<dvec2>> limitValues(values.size());
    interpolator.LimitFaceVarying(values, limitValues);
    for (const int v : darts) {
        if (!last.DoesVertexFVarTopologyMatch(v)) continue; // a seam, which masks know
        const int face = last.GetVertexFaces(v)[0], corner = last.GetVertexFaceLocalIndices(v)[0];
        limitValues[last.GetFaceFVarValues(face)[corner]] =
            limitAtDart(v, values, [&](int f) { return last.GetFaceFVarValues(f); });
    }
    for (const auto& value : limitValues) texCoords_.push_back(value.value);
}

int Oracle::vertexAt(int face, int i, int j) const {
    const int stride = grids_[face].side / gridSize_; // quads beside n-gons are one level finer
    return grids_[face].at(i * stride, j * stride);
}

dvec2 Oracle::texCoord(int face, int i, int j) const {
    const int last = refiner_->GetNumLevels() - 1, vertex = vertexAt(face, i, j);
    const auto& level = refiner_->GetLevel(last);
    const auto faces = level.GetVertexFaces(vertex);
    const auto corners = level.GetVertexFaceLocalIndices(vertex);
    for (int k = 0; k < faces.size(); ++k)
        if (cageFaceOf_[last][faces[k]] == cageFaces_[face])
            return texCoords_[level.GetFaceFVarValues(faces[k])[corners[k]]];
    ADD_FAILURE() << "face " << face << " has no corner at its own grid point " << i << ' ' << j;
    return {};
}

} // namespace relief
