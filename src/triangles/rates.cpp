#include <algorithm>
#include <bit>
#include <cmath>

#include "model/bounds.h"
#include "shared/rates.h"
#include "triangles/stages.h"

namespace relief {

/// Where a cage edge lies on the height map, measured on its owner face.
struct EdgeFootprint {
    float texels = 0;      ///< length
    float heightRange = 0; ///< highest less lowest height along it, from bounds: cage units
};

namespace {

constexpr const char* kFootprintShader = "footprints.comp";
constexpr const char* kRateShader = "rates.comp";
constexpr std::uint32_t kRateLimit = 1024; ///< of the paths that make their own triangles

/// Length of a texel of the mip level that is read, in segments, where fragments show all slopes. A coarser level would
/// smooth positions that the triangles could show; aliasing moves points but bends no normal.
constexpr float kBumpedSegmentShare = 0.25f;

/// Most segments per edge of hardware tessellation: an even number.
std::uint32_t tessellatorLimit(const DeviceTraits& traits) {
    constexpr std::uint32_t kMost = 64; // on any device
    return std::min(traits.maxTessellationLevel, kMost) / 2 * 2;
}

std::uint32_t rateLimit(const DeviceTraits& traits, const TriangleOptions& options) {
    if (options.path != Path::dice && !traits.evaluatesInVertexStages)
        fail(Failure::usage, "{} does not read storage buffers rightly in vertex shaders; use --path dice",
             traits.name);
    if (options.path != Path::tessellation) return kRateLimit;
    if (!traits.hasTessellation)
        fail(Failure::usage, "{} has no tessellation shaders; use --path grid or dice", traits.name);
    return tessellatorLimit(traits);
}

/// The corner where a side starts.
std::uint32_t cornerOf(const SurfaceModel& model, std::uint32_t sideEntry) {
    const std::uint32_t edge = sideEntry & kSideEdgeMask;
    if ((sideEntry & kSideReversed) == 0) return model.edges[edge].corners[0];
    return model.edges[edge + ((sideEntry & kSideSplit) != 0 ? 1 : 0)].corners[1];
}

/// Whether the surface is displaced and fragments show the slopes that its triangles lack.
bool showsAllSlopes(const SurfaceModel& model) {
    if (model.function) return model.functionMovesSurface && model.functionBendsNormals;
    return model.height.has_value() && model.pictures.slopes.has_value();
}

} // namespace

bool isCutShort(const TriangleOptions& options, const DeviceTraits& traits, std::uint32_t maxRate) {
    return options.path == Path::tessellation && !options.rate && maxRate >= tessellatorLimit(traits);
}

std::uint32_t EdgeRates::segments(std::uint32_t edge) const {
    return formulas::segmentsOf(rates[edge], spacing == Spacing::fractional ? 1 : 0);
}

struct EdgeRater::Parts {
    explicit Parts(Device& device) : device(device), resources(device), stages(device), timer(device, 2) {}
    Device& device;
    PassResources resources;
    ComputeStages stages;
    Timer timer;
    PerModel<std::vector<EdgeFootprint>> footprints;

    struct Measure {
        const char* file;
        std::size_t floatCount = 1;
        const TexelBuffer* edgeHeights = nullptr;
        double* milliseconds = nullptr; ///< device time, if measured
    };
    std::vector<float> measure(const Measure& what, const SurfaceModel& model, PassInputs inputs);
    const PendingPipeline& start(const char* file, const SurfaceModel& model);
    const std::vector<EdgeFootprint>& edgeFootprints(const SurfaceModel& model);
    std::vector<EdgeFootprint> measureFootprints(const SurfaceModel& model);
    std::vector<float> measureRates(const SurfaceModel& model, const TriangleOptions& options, const View& view,
                                    double* milliseconds);
    std::vector<float> cornerLevels(const SurfaceModel& model, const EdgeRates& rates);
};

EdgeRater::EdgeRater(Device& device) : parts_(std::make_unique<Parts>(device)) {}
EdgeRater::~EdgeRater() = default;

const PendingPipeline& EdgeRater::Parts::start(const char* file, const SurfaceModel& model) {
    ShaderConstants constants = constantsOf(model, NormalKind::limit);
    constants.wantsTexCoords = std::string_view(file) == kFootprintShader;
    constants.hasSlopes = std::string_view(file) == kRateShader && showsAllSlopes(model); // outlines are refined
    return stages.start(file, model, constants);
}

/// Runs a shader with one invocation per edge, which writes `floatCount` numbers to inputs.targets.edges. Returns them,
/// edge after edge.
std::vector<float> EdgeRater::Parts::measure(const Measure& what, const SurfaceModel& model, PassInputs inputs) {
    // What the shader reads and writes.
    std::vector<float> numbers(model.edges.size() * what.floatCount);
    const Buffer out =
        makeBuffer(device, {.name = what.file,
                            .bytes = numbers.size() * sizeof(float),
                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    PassBindings bindings = resources.bindings();
    describe(model, inputs, bindings);
    inputs.targets.edges = out.address;
    if (what.edgeHeights != nullptr) bindings[kBindEdgeHeights] = what.edgeHeights->binding();

    // One submission with the copy to the host: plans of draws wait for the numbers.
    const Pipeline& pipeline = start(what.file, model).get();
    const Download download(device, numbers.size() * sizeof(float));
    const BindingSet set = makeBindingSet(device, pipeline, passLayout(device), bindings);
    device.submitAndWait([&](VkCommandBuffer commands) {
        timer.reset(commands);
        resources.write(commands, inputs);
        timer.stamp(commands);
        bind(commands, pipeline, set);
        vkCmdDispatch(commands, std::uint32_t((model.edges.size() + 63) / 64), 1, 1);
        timer.stamp(commands);
        download.record(commands, out);
    });
    const std::vector<double> times = timer.intervals();
    if (what.milliseconds != nullptr && !times.empty()) *what.milliseconds = times[0];
    std::ranges::copy(download.bytes(), std::as_writable_bytes(std::span(numbers)).begin());
    return numbers;
}

/// Measured once for a model.
const std::vector<EdgeFootprint>& EdgeRater::Parts::edgeFootprints(const SurfaceModel& model) {
    return footprints.of(model, [&] { return measureFootprints(model); });
}

std::vector<EdgeFootprint> EdgeRater::Parts::measureFootprints(const SurfaceModel& model) {
    std::vector<EdgeFootprint> edges;
    if (!model.height) return edges;
    if (model.function) { // it has no texels
        for (const Edge& edge : model.edges)
            edges.push_back({0, model.faceHeightRanges.empty() ? 0 : model.faceHeightRanges[edge.owner.face]});
        return edges;
    }
    if (model.addressing() == Addressing::faces) { // known without a measurement
        for (const EdgeHeights& edge : model.edgeHeights) edges.push_back({edge.segments, edge.range});
        return edges;
    }
    const std::vector<float> words = measure({.file = kFootprintShader, .floatCount = kFootprintFloats}, model, {});
    for (std::size_t i = 0; i < words.size(); i += kFootprintFloats) {
        const TexBox box{vec2(words[i + 1], words[i + 2]), vec2(words[i + 3], words[i + 4])};
        const Range range = model.heightPyramid.range(box);
        vec3 differences(range.highest - range.lowest, 0, 0);
        for (std::size_t k = 0; k < model.componentPyramids.size(); ++k) {
            const Range component = model.componentPyramids[k].range(box);
            differences[int(k)] = component.highest - component.lowest;
        }
        edges.push_back({words[i], glm::length(differences)});
    }
    return edges;
}

std::vector<float> EdgeRater::Parts::measureRates(const SurfaceModel& model, const TriangleOptions& options,
                                                  const View& view, double* milliseconds) {
    PassInputs inputs{};
    inputs.view.eye = view.eye;
    inputs.rates.nearDistance = view.nearDistance;
    inputs.rates.pixelsAtUnitDistance = view.pixelsAtUnitDistance;
    inputs.rates.edgePixels = float(options.edgePixels);
    inputs.rates.maxRate = rateLimit(device.traits(), options);
    inputs.rates.isFractional = options.spacing == Spacing::fractional ? 1 : 0;
    std::vector<float> ranges(model.edges.size(), 0);
    const std::vector<EdgeFootprint>& edges = edgeFootprints(model);
    for (std::size_t i = 0; i < edges.size(); ++i) ranges[i] = edges[i].heightRange;
    const TexelBuffer heights =
        uploadTexels(device, {.name = "edge heights"}, VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(ranges)));
    return measure({.file = kRateShader, .edgeHeights = &heights, .milliseconds = milliseconds}, model, inputs);
}

/// Mip level per corner: the mean, over the edges that meet there, of log2(texels per segment), at least 0. Empty where
/// all are 0. Texels are smaller than segments where fragments show all slopes.
std::vector<float> EdgeRater::Parts::cornerLevels(const SurfaceModel& model, const EdgeRates& rates) {
    if (!model.height) return {};
    const float segmentShare = showsAllSlopes(model) ? kBumpedSegmentShare : 1;
    const std::vector<EdgeFootprint>& edges = edgeFootprints(model);
    std::vector<float> levels(model.cornerFlags.size(), 0), counts(model.cornerFlags.size(), 0);
    bool isAny = false;
    for (std::size_t edge = 0; edge < edges.size(); ++edge) {
        const float perSegment = segmentShare * edges[edge].texels / rates.rates[edge];
        const float level = perSegment > 1 ? std::log2(perSegment) : 0; // NaN compares false
        isAny = isAny || level > 0;
        for (const std::uint32_t corner : model.edges[edge].corners) levels[corner] += level, ++counts[corner];
    }
    if (!isAny) return {};
    for (std::size_t corner = 0; corner < levels.size(); ++corner) levels[corner] /= std::max(counts[corner], 1.0f);
    return levels;
}

void EdgeRater::startPipelines(const SurfaceModel& model, const TriangleOptions& options) {
    const bool measuresFootprints = model.height && !model.function && model.addressing() != Addressing::faces;
    if (measuresFootprints && (options.filtersHeights || !options.rate)) parts_->start(kFootprintShader, model);
    if (!options.rate) parts_->start(kRateShader, model);
}

EdgeRates EdgeRater::rates(const SurfaceModel& model, const TriangleOptions& options, const View& view,
                           double* milliseconds) {
    const std::uint32_t limit = rateLimit(parts_->device.traits(), options);
    if (options.rate && (*options.rate < 1 || std::uint32_t(*options.rate) > limit))
        fail(Failure::usage, "--rate {} is not in 1..{}{}", *options.rate, limit,
             limit == kRateLimit ? "" : ", what the tessellator of this device does; --path grid and dice go to 1024");
    EdgeRates rates{{}, options.spacing, {}};
    rates.rates = options.rate ? uniformRates(model, float(*options.rate))
                               : parts_->measureRates(model, options, view, milliseconds);
    if (options.filtersHeights) rates.cornerLevels = parts_->cornerLevels(model, rates);
    return rates;
}

std::vector<float> uniformRates(const SurfaceModel& model, float rate) {
    std::vector<float> rates(model.edges.size());
    for (std::size_t e = 0; e < rates.size(); ++e) rates[e] = model.edgeIsHalf[e] ? std::ceil(rate / 2) : rate;
    return rates;
}

RateTables uploadRates(Device& device, const SurfaceModel& model, const EdgeRates& rates) {
    std::vector<vec4> levels;
    if (rates.hasMips()) {
        for (const float level : rates.cornerLevels) levels.emplace_back(level, 0, 0, 0);
        for (const Face& face : model.faces) {
            vec4& four = levels.emplace_back(0);
            for (int side = 0; side < model.sideCount && face.root != kNoPatch; ++side)
                four[side] = rates.cornerLevels[cornerOf(model, face.sides[side])];
        }
    }
    return {uploadTexels(device, {.name = "edge rates"}, VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(rates.rates))),
            uploadTexels(device, {.name = "height levels"}, VK_FORMAT_R32G32B32A32_SFLOAT,
                         std::as_bytes(std::span(levels)))};
}

void describeRates(const SurfaceModel& model, const EdgeRates& rates, const RateTables& tables, PassInputs& inputs,
                   PassBindings& bindings) {
    inputs.rates.isFractional = rates.spacing == Spacing::fractional ? 1 : 0;
    inputs.rates.firstFaceLevel = std::uint32_t(model.cornerFlags.size());
    bindings[kBindEdgeRates] = tables.rates.binding();
    bindings[kBindLevels] = tables.levels.binding();
}

FaceSegments faceSegments(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t face) {
    FaceSegments f;
    for (int side = 0; side < model.sideCount; ++side) {
        const std::uint32_t entry = model.faces[face].sides[side], edge = entry & kSideEdgeMask;
        const std::uint32_t halves = (entry & kSideSplit) != 0 ? 2 : 1;
        f.sides[side] = halves * rates.segments(edge);
        const float rate = float(halves) * rates.rates[edge];
        float& along = side % 2 == 0 ? f.rateU : f.rateV;
        along = std::max(along, rate);
        f.largestRate = std::max(f.largestRate, rate);
    }
    f.u = std::max(f.sides[0], f.sides[2]);
    f.v = std::max(f.sides[1], f.sides[3]);
    if (model.isTriangles()) f.u = f.v = std::max(f.u, f.v);
    return f;
}

bool readsNodes(const SurfaceModel& model, const EdgeRates& rates) {
    if (model.mapSegments.empty() || rates.spacing != Spacing::equal) return false;
    // One level for all, and a whole one.
    const float level = rates.hasMips() ? rates.cornerLevels.front() : 0;
    if (level != std::floor(level)) return false;
    if (std::ranges::any_of(rates.cornerLevels, [&](float other) { return other != level; })) return false;
    // Numbers of nodes are powers of two, and so are their divisors.
    const auto isOnNodes = [&](std::uint32_t segments, int log) {
        return std::has_single_bit(segments) && segments <= 1u << std::max(log - int(level), 0);
    };
    for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
        if (model.faces[f].root == kNoPatch) continue;
        const FaceSegments face = faceSegments(model, rates, f);
        // Inside of a face there are two segments each way at least, unless it has one per side.
        const std::uint32_t least = face.u * face.v == 1 ? 1 : 2;
        if (!isOnNodes(std::max(face.u, least), model.mapSegments[f].x) ||
            !isOnNodes(std::max(face.v, least), model.mapSegments[f].y))
            return false;
        for (int side = 0; side < 4; ++side)
            if (!isOnNodes(face.sides[side], side % 2 == 0 ? model.mapSegments[f].x : model.mapSegments[f].y))
                return false;
    }
    return true;
}

std::uint64_t boundarySegments(const SurfaceModel& model, const EdgeRates& rates) {
    std::uint64_t count = 0;
    for (std::uint32_t edge = 0; edge < model.edges.size(); ++edge)
        if ((model.edges[edge].flags & kOnBoundary) != 0) count += rates.segments(edge);
    return count;
}

} // namespace relief
