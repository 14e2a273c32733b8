// From a cage to OpenSubdiv's refined topology, patch table and point values.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "surface/far.h"

namespace relief {
namespace {

using OpenSubdiv::Sdc::Options;
using OpenSubdiv::Sdc::SchemeType;
using RefinerFactory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

// OpenSubdiv would print its complaints; the last one of this thread is kept for our own message instead.
thread_local std::string lastComplaint;

void keepComplaints() {
    static std::once_flag once;
    std::call_once(once, [] {
        Far::SetErrorCallback([](Far::ErrorType, const char* message) { lastComplaint = message; });
        Far::SetWarningCallback([](const char*) {});
    });
    lastComplaint.clear();
}

[[noreturn]] void failWithComplaint(const char* what) {
    std::replace(lastComplaint.begin(), lastComplaint.end(), '\n', ' ');
    while (!lastComplaint.empty() && lastComplaint.back() == ' ') lastComplaint.pop_back();
    fail(Failure::input, "{}: {}", what, lastComplaint.empty() ? "no reason given" : lastComplaint);
}

SchemeType schemeType(Scheme scheme) {
    switch (scheme) {
    case Scheme::loop: return OpenSubdiv::Sdc::SCHEME_LOOP;
    case Scheme::bilinear: return OpenSubdiv::Sdc::SCHEME_BILINEAR;
    default: return OpenSubdiv::Sdc::SCHEME_CATMARK;
    }
}

Options::VtxBoundaryInterpolation boundaryInterpolation(BoundaryRule rule) {
    switch (rule) {
    case BoundaryRule::none: return Options::VTX_BOUNDARY_NONE;
    case BoundaryRule::edgeAndCorner: return Options::VTX_BOUNDARY_EDGE_AND_CORNER;
    default: return Options::VTX_BOUNDARY_EDGE_ONLY;
    }
}

Options schemeOptions(const Cage& cage) {
    Options options;
    options.SetVtxBoundaryInterpolation(boundaryInterpolation(cage.boundaryRule));
    options.SetFVarLinearInterpolation(Options::FVarLinearInterpolation(cage.texBoundaryRule));
    options.SetCreasingMethod(cage.creaseMethod == CreaseMethod::chaikin ? Options::CREASE_CHAIKIN
                                                                         : Options::CREASE_UNIFORM);
    return options;
}

const int* asInts(const std::vector<std::uint32_t>& indices) { return reinterpret_cast<const int*>(indices.data()); }

Far::TopologyDescriptor describe(const Cage& cage, Far::TopologyDescriptor::FVarChannel& texChannel) {
    Far::TopologyDescriptor topology;
    topology.numVertices = int(cage.positions.size());
    topology.numFaces = int(cage.faceCount());
    topology.numVertsPerFace = asInts(cage.faceSizes);
    topology.vertIndicesPerFace = asInts(cage.corners);
    topology.numCreases = int(cage.creaseSharpness.size());
    topology.creaseVertexIndexPairs = asInts(cage.creaseEdges);
    topology.creaseWeights = cage.creaseSharpness.data();
    topology.numCorners = int(cage.vertexSharpness.size());
    topology.cornerVertexIndices = asInts(cage.sharpVertices);
    topology.cornerWeights = cage.vertexSharpness.data();
    topology.numHoles = int(cage.holes.size());
    topology.holeIndices = asInts(cage.holes);
    if (cage.hasTexCoords()) {
        texChannel.numValues = int(cage.texCoords.size());
        texChannel.valueIndices = asInts(cage.texCorners);
        topology.numFVarChannels = 1;
        topology.fvarChannels = &texChannel;
    }
    return topology;
}

void checkForLoop(const Cage& cage) {
    for (std::size_t face = 0; face < cage.faceCount(); ++face)
        if (cage.faceSizes[face] != 3)
            fail(Failure::input, "face {} has {} corners: the loop scheme takes triangles only (try --scheme catmark)",
                 face, cage.faceSizes[face]);
}

// The tangents around the middle of a face or vertex of n neighbours depend on all n: memory grows with the square.
constexpr std::uint32_t kMostNeighbours = kMostRingFaces, kManyNeighbours = 64;
constexpr double kBytesPerSquare = 500, kMostBytes = 4e9; // measured: 480 MB for n = 1000, most of it inside OpenSubdiv

/// Faces and vertices of many neighbours, and what they take together.
struct Neighbours {
    double squares = 0;
    std::uint32_t most = 0;
    std::string largest; ///< in words

    void add(std::uint32_t count, const char* format, std::size_t index) {
        if (count <= kManyNeighbours) return;
        squares += double(count) * count;
        if (count <= most) return;
        most = count;
        largest = fmt::format(fmt::runtime(format), index, count);
    }
};

void checkNeighbours(const Cage& cage) {
    Neighbours all;
    for (std::size_t face = 0; face < cage.faceCount(); ++face)
        all.add(cage.faceSizes[face], "face {} has {} corners", face);
    std::vector<std::uint32_t> faceCounts(cage.positions.size());
    for (const std::uint32_t vertex : cage.corners) ++faceCounts[vertex];
    for (std::size_t vertex = 0; vertex < faceCounts.size(); ++vertex)
        all.add(faceCounts[vertex], "vertex {} has {} faces", vertex);
    const double bytes = kBytesPerSquare * all.squares;
    if (all.most > kMostNeighbours)
        fail(Failure::input, "{}: at most {} can be subdivided, split it", all.largest, kMostNeighbours);
    if (bytes > kMostBytes)
        fail(Failure::input,
             "{}: subdividing it and others of more than {} takes about {}, up to {} are allowed; split them",
             all.largest, kManyNeighbours, humanBytes(std::uint64_t(bytes)), humanBytes(std::uint64_t(kMostBytes)));
}

Far::PatchTableFactory::Options patchOptions(bool hasTexCoords, int isolation) {
    Far::PatchTableFactory::Options options(isolation);
    options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    options.useInfSharpPatch = true;
    options.useSingleCreasePatch = false; // the evaluators ignore such a patch's sharpness
    options.generateLegacySharpCornerPatches = false;
    options.generateVaryingTables = false;
    options.generateFVarTables = hasTexCoords;
    options.generateFVarLegacyLinearPatches = false;
    options.SetPatchPrecision<double>();
    options.SetFVarPatchPrecision<double>();
    return options;
}

// n-gons are quads from level 1 on: without that level they would have no patches.
int leastIsolation(const Cage& cage, Scheme scheme) {
    const auto isQuad = [](std::uint32_t size) { return size == 4; };
    return scheme == Scheme::loop || std::all_of(cage.faceSizes.begin(), cage.faceSizes.end(), isQuad) ? 0 : 1;
}

[[noreturn]] void failWithoutPatches(const Cage& cage) {
    if (cage.holes.size() == cage.faceCount())
        fail(Failure::input, "all {} faces are holes: nothing is drawn; remove some of their hole tags",
             cage.faceCount());
    fail(Failure::input,
         "none of its {} faces is drawn: all are holes or at a boundary, where interpolateboundary 0 draws no faces; "
         "use interpolateboundary 1 or 2",
         cage.faceCount());
}

/// Appends the limit points of end caps.
template <typename Value>
void addLimits(std::vector<Value>& points, const std::vector<EndCaps::Limit>& limits) {
    for (const EndCaps::Limit& limit : limits) {
        Value sum;
        for (std::size_t i = 0; i < limit.points.size(); ++i)
            sum.AddWithWeight(points[std::size_t(limit.points[i])], limit.weights[Eigen::Index(i)]);
        points.push_back(sum);
    }
}

} // namespace

std::unique_ptr<Far::TopologyRefiner> makeRefiner(const Cage& cage, Scheme scheme) {
    if (cage.faceSizes.empty()) fail(Failure::input, "the cage has no faces");
    if (scheme == Scheme::loop) checkForLoop(cage);
    checkNeighbours(cage);
    keepComplaints();
    Far::TopologyDescriptor::FVarChannel texChannel;
    const RefinerFactory::Options options(schemeType(scheme), schemeOptions(cage));
    std::unique_ptr<Far::TopologyRefiner> refiner(RefinerFactory::Create(describe(cage, texChannel), options));
    if (!refiner) failWithComplaint("the cage's topology cannot be subdivided");
    return refiner;
}

namespace {

/// Six patches per semi-sharp edge of the last level, 250 bytes each: 100 MB. More levels double them.
constexpr double kMostSemiSharpEdges = 65'536;

/// Semi-sharp edges of the last level that is refined for them.
double countEdgesAfter(const Cage& cage, int levels) {
    double count = 0;
    for (const float s : cage.creaseSharpness)
        if (s < OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE) count += std::exp2(std::min(std::ceil(s), float(levels)));
    return count;
}

} // namespace

int neededIsolation(const Cage& cage, EndCapKind endCaps) {
    constexpr int kApproximating = 6;
    if (endCaps == EndCapKind::gregory) return kApproximating;
    float sharpest = 0;
    for (const auto* sharpnesses : {&cage.creaseSharpness, &cage.vertexSharpness})
        for (const float s : *sharpnesses)
            if (s < OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE) sharpest = std::max(sharpest, s);
    const int levels = std::max(int(std::ceil(sharpest)), kSeparation);
    return levels > kApproximating && countEdgesAfter(cage, levels) > kMostSemiSharpEdges ? kApproximating : levels;
}

FarTables makeFarTables(const Cage& cage, const SurfaceOptions& options, int capLevels) {
    if (options.isolation < 0 || options.isolation > 10)
        fail(Failure::usage, "isolation {} is out of range: 0..10", options.isolation);
    FarTables tables;
    tables.refiner = makeRefiner(cage, options.scheme);
    tables.hasTexCoords = cage.hasTexCoords();
    tables.isolation = std::max(options.isolation, leastIsolation(cage, options.scheme));
    const auto patchTableOptions = patchOptions(tables.hasTexCoords, tables.isolation);
    auto refinement = patchTableOptions.GetRefineAdaptiveOptions();
    if (options.endCaps == EndCapKind::exact)
        refinement.SetSecondaryLevel(
            std::clamp(options.separation, leastIsolation(cage, options.scheme), tables.isolation));
    tables.refiner->RefineAdaptive(refinement);
    tables.patches.reset(Far::PatchTableFactory::Create(*tables.refiner, patchTableOptions));
    if (!tables.patches) failWithComplaint("no patches could be made of the cage");
    if (tables.patches->GetNumPatchesTotal() == 0) failWithoutPatches(cage);
    if (options.endCaps == EndCapKind::exact) findEndCaps(tables, capLevels);
    return tables;
}

std::vector<Point> refineAll(const FarTables& tables, std::span<const vec3> cagePositions) {
    std::vector<Point> points(pointCount(tables));
    points.reserve(points.size() + tables.caps.limits.size());
    for (std::size_t i = 0; i < cagePositions.size(); ++i) points[i].value = dvec3(cagePositions[i]);
    blendPoints(tables, [&](int first) { return points.data() + first; });
    addLimits(points, tables.caps.limits);
    return points;
}

std::vector<TexPoint> refineAllTex(const FarTables& tables, const std::vector<vec2>& texCoords) {
    if (!tables.hasTexCoords) return {};
    const int refinedCount = tables.refiner->GetNumFVarValuesTotal();
    std::vector<TexPoint> points(std::size_t(refinedCount) + tables.patches->GetNumLocalPointsFaceVarying());
    for (std::size_t i = 0; i < texCoords.size(); ++i) points[i].value = dvec2(texCoords[i]);

    const Far::PrimvarRefinerReal<double> refiner(*tables.refiner);
    TexPoint* coarse = points.data();
    for (int level = 1; level < tables.refiner->GetNumLevels(); ++level) {
        TexPoint* fine = coarse + tables.refiner->GetLevel(level - 1).GetNumFVarValues();
        refiner.InterpolateFaceVarying(level, coarse, fine);
        coarse = fine;
    }
    const auto* local = tables.patches->GetLocalPointFaceVaryingStencilTable<double>();
    if (local && local->GetNumStencils() > 0) local->UpdateValues(points.data(), points.data() + refinedCount);
    addLimits(points, tables.caps.texLimits);
    return points;
}

} // namespace relief
