#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/clock.h"
#include "pose/stages.h"
#include "shared/displacement.h"
#include "shared/pose.h"

namespace relief {
namespace {

constexpr std::uint32_t kCageGroup = 64;   ///< invocations of pose_cage.comp
constexpr std::uint32_t kPointsGroup = 64; ///< of pose_points.comp
constexpr std::uint32_t kLanes = 8;        ///< of pose_blocks.comp

void appendFloats(std::vector<float>& floats, std::span<const vec3> points) {
    for (const vec3& p : points) floats.insert(floats.end(), {p.x, p.y, p.z});
}

/// Whether points lie so close together that the rounding of sums shows in derivatives: on exact surfaces with deep
/// levels, which are those around semi-sharp creases.
bool needsFineSums(const Surface& surface) {
    constexpr std::uint32_t kDepthMask = 15; // of Far::PatchParam's field1
    bool isDeep = false;
    for (const Patch& patch : surface.patches) {
        if (patch.type == kPatchGregory || patch.type == kPatchGregoryTriangle) return false;
        isDeep |= (patch.param1 & kDepthMask) > std::uint32_t(kSeparation);
    }
    return isDeep;
}

/// Returns PosePush::offsetUnit for a pose.
float offsetUnit(std::span<const vec3> positions) {
    const double side = computeBounds(positions).longestSide();
    return side > 0 ? std::ldexp(1.0F, std::ilogb(side) + 1 - kOffsetBits) : 1;
}

} // namespace

struct Poser::Parts {
    Parts(Device& device, SurfaceModel& model, const PoserDesc& desc);

    Device& device;
    SurfaceModel& model;
    FaceSupports supports;
    std::optional<Rig> rig;
    float mostStretch = 1;
    bool isFine; ///< kIdIsFine
    TexelBuffer words, weights, rest, joints, influences;
    TexelBuffer uploads[2]; ///< taken in turn: one is written while the device may still read the other
    Pipeline cagePipeline;
    struct PointsPass {
        Pipeline pipeline;
        std::uint32_t firstBlock = 0, endBlock = 0, firstEntry = 0,
                      entryCount = 0; ///< entryCount 0: any number per block
        bool isShared = false;        ///< later passes read what it makes
    };
    std::vector<PointsPass> passes;
    BindingSet sets[2]; ///< with each upload
    PosePush push;
    std::uint32_t next = 0;
    std::vector<std::uint32_t> setFirsts; ///< first point of each set: now, before
    Bounds bounds;
    PoseStats stats;

    void uploadStencils(const StencilBlocks& blocks, const Stencils& stencils);
    void uploadRig();
    void makePasses(const StencilBlocks& blocks);
    void addPass(std::uint32_t entryCount, const StencilBlocks& blocks, std::uint32_t firstBlock,
                 std::uint32_t endBlock);
    void runPass(VkCommandBuffer commands, const PointsPass& pass, const BindingSet& set) const;
    void bindAll(const TexelBuffer& points);
    void checkPose(const Pose& pose) const;
    /// What goes to the device: the posed cage, or what moves its rig.
    [[nodiscard]] std::vector<float> uploadOf(const Pose& pose) const;
    void evaluate(std::span<const float> floats, std::span<const vec3> positions, std::uint32_t firstPoint,
                  bool isRigged);
};

Poser::Parts::Parts(Device& device, SurfaceModel& model, const PoserDesc& desc)
    : device(device), model(model), supports(*desc.surface), isFine(needsFineSums(*desc.surface)) {
    if (desc.rig != nullptr) rig = *desc.rig;
    const Surface& surface = *desc.surface;
    push.pointCount = surface.controlPointCount;

    // Sets of points in one table: this pose, the one before where motion is asked for, rest where heights need it.
    const auto setSize = std::uint32_t(surface.controlPointCount + surface.stencils.rowCount());
    const bool stretches = desc.heightSpace == HeightSpace::stretch, keepsRest = stretches || model.function != nullptr;
    const std::uint32_t setCount = 1 + (desc.keepsBefore ? 1 : 0) + (keepsRest ? 1 : 0);
    setFirsts = {0};
    if (desc.keepsBefore) setFirsts.push_back(setSize);

    PointSets sets;
    sets.table = makeTexels(device,
                            {.name = "posed points",
                             .bytes = std::uint64_t(setCount) * setSize * sizeof(vec4),
                             .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
                            VK_FORMAT_R32G32B32A32_SFLOAT);
    sets.before = setFirsts.back();
    if (keepsRest) sets.rest = (setCount - 1) * setSize;
    sets.stretches = stretches;
    push.target = sets.table.buffer.address;

    // What no pose changes.
    const StencilBlocks blocks = stencilBlocks(surface.stencils);
    uploadStencils(blocks, surface.stencils);
    uploadRig();
    makePasses(blocks);
    bindAll(sets.table);

    // The model takes the table over; its rest points are the only ones that are never posed again.
    const std::optional<std::uint32_t> firstRest = sets.rest;
    if (stretches) mostStretch = float(formulas::kMostStretch);
    model.setPoints(std::move(sets));
    std::vector<float> restFloats;
    appendFloats(restFloats, desc.restPositions);
    if (firstRest) evaluate(restFloats, desc.restPositions, *firstRest, false);
}

void Poser::Parts::uploadStencils(const StencilBlocks& blocks, const Stencils& stencils) {
    std::vector<std::uint32_t> all = blocks.firsts;
    push.firstTarget = std::uint32_t(all.size());
    RELIEF_CHECK(stencils.rowCount() < 1u << kTargetRowBits);
    for (const std::uint32_t row : blocks.targets)
        all.push_back(row == kNoPatch ? kNoPatch : row | std::uint32_t(stencils.scales[row] + 31) << kTargetRowBits);
    push.firstEntry = std::uint32_t(all.size());
    all.insert(all.end(), blocks.entries.begin(), blocks.entries.end());
    words = uploadTexels(device, {.name = "stencil words"}, VK_FORMAT_R32_UINT, std::as_bytes(std::span(all)));
    weights = uploadTexels(device, {.name = "stencil weights"}, VK_FORMAT_R32G32B32A32_UINT,
                           std::as_bytes(std::span(blocks.weights)));
}

void Poser::Parts::uploadRig() {
    const Rig none;
    const Rig& r = rig ? *rig : none;
    push.influenceCount = r.influenceCount;
    push.morphCount = r.morphCount;
    const std::vector<vec4> points = padded(r.rest, r.morphOffsets);
    rest = uploadTexels(device, {.name = "rest and morphs"}, VK_FORMAT_R32G32B32A32_SFLOAT,
                        std::as_bytes(std::span(points)));
    joints = uploadTexels(device, {.name = "joints"}, VK_FORMAT_R32_UINT, std::as_bytes(std::span(r.joints)));
    influences =
        uploadTexels(device, {.name = "joint weights"}, VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(r.weights)));
    const std::uint64_t rigFloats = r.morphCount + std::uint64_t(kFloatsPerJoint) * r.jointCount;
    for (TexelBuffer& upload : uploads)
        upload = makeTexels(device,
                            {.name = "pose",
                             .bytes = std::max<std::uint64_t>(3ull * push.pointCount, rigFloats) * sizeof(float),
                             .memory = MemoryUse::upload},
                            VK_FORMAT_R32_SFLOAT);
}

void Poser::Parts::makePasses(const StencilBlocks& blocks) {
    cagePipeline = makePosePipeline(device, "pose_cage.comp");
    std::uint32_t block = blocks.sharedBlockCount;
    if (block > 0) {
        addPass(0, blocks, 0, block);
        passes.back().isShared = true;
    }
    if (device.traits().smallGroup == kLanes && device.traits().hasSubgroupShuffle)
        for (const StencilClass& c : blocks.classes) {
            if (c.entryCount > kStraightEntries) break;
            block = c.firstBlock + c.blockCount;
            addPass(c.entryCount, blocks, c.firstBlock, block);
        }
    if (block < blocks.blockCount()) addPass(0, blocks, block, std::uint32_t(blocks.blockCount()));
}

void Poser::Parts::addPass(std::uint32_t entryCount, const StencilBlocks& blocks, std::uint32_t firstBlock,
                           std::uint32_t endBlock) {
    passes.push_back({entryCount == 0
                          ? makePosePipeline(device, "pose_points.comp", {.groupSize = kPointsGroup, .isFine = isFine})
                          : makePosePipeline(device, "pose_blocks.comp",
                                             {.groupSize = kLanes, .entryCount = entryCount, .isFine = isFine}),
                      firstBlock, endBlock, blocks.firsts[firstBlock], entryCount});
}

void Poser::Parts::bindAll(const TexelBuffer& points) {
    for (int i = 0; i < 2; ++i) {
        PoseBindings bindings;
        bindings[kPoseUpload] = uploads[i].binding();
        bindings[kPoseRest] = rest.binding();
        bindings[kPoseJoints] = joints.binding();
        bindings[kPoseInfluences] = influences.binding();
        bindings[kPosePoints] = points.binding();
        bindings[kPoseWords] = words.binding();
        bindings[kPoseWeights] = weights.binding();
        sets[i] = makeBindingSet(device, cagePipeline, poseLayout(device), bindings);
    }
}

void Poser::Parts::checkPose(const Pose& pose) const {
    const auto check = [](std::size_t count, std::size_t expected, const char* what) {
        if (count != expected) fail(Failure::input, "a pose has {} {}, {} expected", count, what, expected);
    };
    if (!rig || !pose.positions.empty()) return check(pose.positions.size(), push.pointCount, "positions");
    check(pose.joints.size(), rig->jointCount, "joints");
    check(pose.morphWeights.size(), rig->morphCount, "morph weights");
}

std::vector<float> Poser::Parts::uploadOf(const Pose& pose) const {
    if (pose.positions.empty()) return rigFloats(pose);
    std::vector<float> floats;
    appendFloats(floats, pose.positions);
    checkFinite(floats);
    return floats;
}

/// Makes all points of the set that begins at `firstPoint`. `positions`: where the cage is then, read where sums are
/// fine.
void Poser::Parts::evaluate(std::span<const float> floats, std::span<const vec3> positions, std::uint32_t firstPoint,
                            bool isRigged) {
    const std::uint32_t upload = std::exchange(next, 1 - next);
    std::memcpy(uploads[upload].buffer.mapped, floats.data(), floats.size_bytes());
    push.firstPoint = firstPoint;
    push.isRigged = isRigged ? 1 : 0;
    if (isFine) push.offsetUnit = offsetUnit(positions);
    device.submitAndWait([&](VkCommandBuffer commands) {
        bind(commands, cagePipeline, sets[upload]);
        relief::push(commands, cagePipeline, std::as_bytes(std::span(&push, 1)));
        vkCmdDispatch(commands, (push.pointCount + kCageGroup - 1) / kCageGroup, 1, 1);
        barrier(commands);
        for (const PointsPass& pass : passes) {
            runPass(commands, pass, sets[upload]);
            if (pass.isShared) barrier(commands);
        }
        barrier(commands);
    });
    stats.uploadedBytes = floats.size_bytes();
}

void Poser::Parts::runPass(VkCommandBuffer commands, const PointsPass& pass, const BindingSet& set) const {
    bind(commands, pass.pipeline, set);
    const std::uint32_t blocksPerGroup = pass.entryCount == 0 ? kPointsGroup / kBlockRows : 1;
    const std::uint32_t blocksAtOnce = kGroupsAtOnce * blocksPerGroup;
    for (std::uint32_t block = pass.firstBlock; block < pass.endBlock; block += blocksAtOnce) {
        const std::uint32_t count = std::min(pass.endBlock - block, blocksAtOnce);
        PosePush part = push;
        part.firstBlock = block;
        part.endBlock = block + count;
        part.firstBlockEntry = pass.firstEntry + (block - pass.firstBlock) * pass.entryCount;
        relief::push(commands, pass.pipeline, std::as_bytes(std::span(&part, 1)));
        vkCmdDispatch(commands, (count + blocksPerGroup - 1) / blocksPerGroup, 1, 1);
    }
}

Poser::Poser(Device& device, SurfaceModel& model, const PoserDesc& desc)
    : parts_(std::make_unique<Parts>(device, model, desc)) {}
Poser::~Poser() = default;

void Poser::pose(const Pose& now, const Pose* before) {
    Parts& parts = *parts_;
    const Rig* rig = parts.rig ? &*parts.rig : nullptr;
    const Pose* poses[] = {&now, before};
    const std::size_t poseCount = before != nullptr ? parts.setFirsts.size() : 1;
    std::vector<vec3> positions[2];
    for (std::size_t i = 0; i < poseCount; ++i) {
        parts.checkPose(*poses[i]);
        if (i == 0 || parts.isFine) positions[i] = posedPositions(rig, *poses[i]);
    }
    const double start = secondsNow();
    for (std::size_t i = 0; i < poseCount; ++i)
        parts.evaluate(parts.uploadOf(*poses[i]), positions[i], parts.setFirsts[i],
                       rig != nullptr && poses[i]->positions.empty());
    parts.stats.milliseconds = 1e3 * (secondsNow() - start);

    std::vector<float> heightBounds = parts.model.faceHeightBounds;
    for (float& bound : heightBounds) bound *= parts.mostStretch;
    std::vector<Bounds> boxes = parts.supports.bounds(positions[0], heightBounds);
    parts.bounds = {};
    for (const Bounds& box : boxes) {
        if (box.isEmpty()) continue;
        parts.bounds.add(box.lower);
        parts.bounds.add(box.upper);
    }
    parts.model.faceBounds = std::move(boxes);
}

const PoseStats& Poser::stats() const { return parts_->stats; }
const Bounds& Poser::bounds() const { return parts_->bounds; }

} // namespace relief
