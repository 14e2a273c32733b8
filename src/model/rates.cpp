#include <algorithm>

#include "model/stages.h"
#include "shared/rates.h"

namespace relief {
namespace {

constexpr std::uint32_t kRateLimit = 1024; ///< of the paths that make their own triangles
constexpr std::uint32_t kTessellatorLimit = 64;

std::uint32_t rateLimit(const DeviceTraits& traits, const TriangleOptions& options) {
    if (options.path != Path::tessellation) return kRateLimit;
    if (!traits.hasTessellation)
        fail(Failure::usage, "{} has no tessellation shaders; use --path grid or dice", traits.name);
    return std::min(traits.maxTessellationLevel, kTessellatorLimit) / 2 * 2;
}

} // namespace

std::uint32_t EdgeRates::segments(std::uint32_t edge) const {
    return formulas::segmentsOf(rates[edge], spacing == Spacing::fractional ? 1 : 0);
}

struct EdgeRater::Parts {
    explicit Parts(Device& device) : device(device), inputs(device), stages(device), timer(device, 2) {}
    Device& device;
    GeometryInputs inputs;
    ComputeStages stages;
    Timer timer;
};

EdgeRater::EdgeRater(Device& device) : parts_(std::make_unique<Parts>(device)) {}
EdgeRater::~EdgeRater() = default;

EdgeRates EdgeRater::rates(const Model& model, const TriangleOptions& options, const View& view, double* milliseconds) {
    Device& device = parts_->device;
    const std::uint32_t limit = rateLimit(device.traits(), options);
    if (options.rate && (*options.rate < 1 || std::uint32_t(*options.rate) > limit))
        fail(Failure::usage, "--rate {} is not in 1..{}{}", *options.rate, limit,
             limit == kRateLimit ? "" : ", what the tessellator of this device does; --path grid and dice go to 1024");
    if (options.rate) return {model.uniformRates(float(*options.rate)), options.spacing};

    EdgeRates rates{std::vector<float>(model.edges().size()), options.spacing};
    const Buffer out =
        makeBuffer(device, {.name = "edge rates",
                            .bytes = rates.rates.size() * sizeof(float),
                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    Scene scene{};
    Binding bindings[kBindDepths];
    parts_->inputs.fill(model, scene, bindings);
    scene.edgeRateTarget = out.address;
    scene.eye = view.eye;
    scene.nearDistance = view.nearDistance;
    scene.pixelsAtUnitDistance = view.pixelsAtUnitDistance;
    scene.edgePixels = float(options.edgePixels);
    scene.maxRate = limit;
    scene.isFractional = options.spacing == Spacing::fractional ? 1 : 0;
    const Pipeline& pipeline = parts_->stages.pipeline("rates.comp", model, constantsOf(model, NormalKind::limit));
    const BindingSet set = makeBindingSet(device, pipeline, GeometryInputs::layout(), bindings);
    device.run([&](VkCommandBuffer commands) {
        parts_->timer.reset(commands);
        writeScene(commands, parts_->inputs.scene(), scene);
        parts_->timer.stamp(commands);
        bind(commands, pipeline, set);
        pushConstants(commands, pipeline, {});
        vkCmdDispatch(commands, std::uint32_t((rates.rates.size() + 63) / 64), 1, 1);
        parts_->timer.stamp(commands);
    });
    const std::vector<double> times = parts_->timer.intervals();
    if (milliseconds != nullptr && !times.empty()) *milliseconds = times[0];
    downloadBytes(device, out, std::as_writable_bytes(std::span(rates.rates)));
    return rates;
}

FaceSegments faceSegments(const Model& model, const EdgeRates& rates, std::uint32_t face) {
    FaceSegments f;
    for (int side = 0; side < model.sideCount(); ++side) {
        const std::uint32_t entry = model.faces()[face].sides[side], edge = entry & kSideEdgeMask;
        const std::uint32_t halves = (entry & kSideSplit) != 0 ? 2 : 1;
        f.sides[side] = halves * rates.segments(edge);
        f.largestRate = std::max(f.largestRate, float(halves) * rates.rates[edge]);
    }
    f.u = std::max(f.sides[0], f.sides[2]);
    f.v = std::max(f.sides[1], f.sides[3]);
    if (model.isTriangles()) f.u = f.v = std::max(f.u, f.v);
    return f;
}

std::uint64_t boundarySegments(const Model& model, const EdgeRates& rates) {
    std::uint64_t count = 0;
    for (std::uint32_t edge = 0; edge < model.edges().size(); ++edge)
        if ((model.edges()[edge].flags & kPlaceOnBoundary) != 0) count += rates.segments(edge);
    return count;
}

} // namespace relief
