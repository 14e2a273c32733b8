// The motion of some of a cage's points: of those that are left when vertices are joined.
#include <optional>

#include "animation/animation.h"

namespace relief {
namespace {

/// Selects the entries of `points`, in their order, from an array with `groupSize` entries per point.
template <typename Value>
std::vector<Value> gatherGroups(const Value* from, const std::vector<std::uint32_t>& points, std::size_t groupSize) {
    std::vector<Value> to;
    to.reserve(points.size() * groupSize);
    for (const std::uint32_t point : points)
        to.insert(to.end(), from + point * groupSize, from + (point + 1) * groupSize);
    return to;
}

Rig gatherRig(const Rig& from, const std::vector<std::uint32_t>& points) {
    Rig rig{.rest = gatherGroups(from.rest.data(), points, 1),
            .jointCount = from.jointCount,
            .morphCount = from.morphCount,
            .influenceCount = from.influenceCount,
            .joints = gatherGroups(from.joints.data(), points, from.influenceCount),
            .weights = gatherGroups(from.weights.data(), points, from.influenceCount),
            .morphOffsets = {}};
    for (std::size_t k = 0; k < from.morphCount; ++k) {
        const std::vector<vec3> offsets = gatherGroups(&from.morphOffsets[k * from.rest.size()], points, 1);
        rig.morphOffsets.insert(rig.morphOffsets.end(), offsets.begin(), offsets.end());
    }
    return rig;
}

class Gathered : public Animation {
public:
    Gathered(std::unique_ptr<Animation> base, std::vector<std::uint32_t> points)
        : Animation(base->coordinates()), base_(std::move(base)), points_(std::move(points)) {
        if (base_->rig() != nullptr) rig_ = gatherRig(*base_->rig(), points_);
    }

    [[nodiscard]] Pose pose(double seconds) const override {
        Pose pose = base_->pose(seconds);
        if (!pose.positions.empty()) pose.positions = gatherGroups(pose.positions.data(), points_, 1);
        return pose;
    }
    [[nodiscard]] const Rig* rig() const override { return rig_ ? &*rig_ : nullptr; }
    [[nodiscard]] dvec2 keyRange() const override { return base_->keyRange(); }

private:
    std::unique_ptr<Animation> base_;
    std::vector<std::uint32_t> points_;
    std::optional<Rig> rig_;
};

} // namespace

std::unique_ptr<Animation> gather(std::unique_ptr<Animation> base, std::vector<std::uint32_t> points) {
    return std::make_unique<Gathered>(std::move(base), std::move(points));
}

} // namespace relief
