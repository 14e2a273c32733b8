// Poses on the host: the reference of what the device computes.
#include "animation/animation.h"

namespace relief {
namespace {

dvec3 morphed(const Rig& rig, const Pose& pose, std::size_t point) {
    dvec3 p(rig.rest[point]);
    for (std::size_t k = 0; k < rig.morphCount; ++k)
        p += double(pose.morphWeights[k]) * dvec3(rig.morphOffsets[k * rig.rest.size() + point]);
    return p;
}

dvec3 skinned(const Rig& rig, const Pose& pose, std::size_t point, const dvec3& p) {
    if (rig.influenceCount == 0) return p;
    dvec3 sum(0);
    for (std::size_t i = point * rig.influenceCount; i < (point + 1) * rig.influenceCount; ++i)
        if (rig.weights[i] != 0)
            sum += double(rig.weights[i]) * dvec3(glm::dmat4(pose.joints[rig.joints[i]]) * glm::dvec4(p, 1));
    return sum;
}

class StillPose : public Animation {
public:
    explicit StillPose(const Cage& cage) : Animation(cage.coordinates), positions_(cage.positions) {}
    [[nodiscard]] Pose pose(double) const override {
        return {.positions = positions_, .joints = {}, .morphWeights = {}};
    }
    [[nodiscard]] dvec2 keyRange() const override { return dvec2(0); }

private:
    std::vector<vec3> positions_;
};

} // namespace

std::vector<vec3> posedPositions(const Rig* rig, const Pose& pose) {
    if (rig == nullptr || !pose.positions.empty()) return pose.positions;
    RELIEF_CHECK(pose.joints.size() == rig->jointCount);
    RELIEF_CHECK(pose.morphWeights.size() == rig->morphCount);
    std::vector<vec3> positions;
    positions.reserve(rig->rest.size());
    for (std::size_t i = 0; i < rig->rest.size(); ++i)
        positions.emplace_back(skinned(*rig, pose, i, morphed(*rig, pose, i)));
    return positions;
}

std::unique_ptr<Animation> stillPose(const Cage& cage) { return std::make_unique<StillPose>(cage); }

} // namespace relief
