// The motion of a welded cage is that of the points it was made of.
#include "animation/animation.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// Points that swing, by positions or by a rig of two joints and a morph target.
class Swing : public Animation {
public:
    Swing(const Cage& cage, bool isRigged) : positions_(cage.positions), isRigged_(isRigged) {
        rig_ = {.rest = cage.positions, .jointCount = 2, .morphCount = 2, .influenceCount = 2};
        for (std::size_t i = 0; i < cage.positions.size(); ++i) {
            const float share = float(i % 5) / 4;
            rig_.joints.insert(rig_.joints.end(), {0, 1});
            rig_.weights.insert(rig_.weights.end(), {share, 1 - share});
        }
        for (std::size_t i = 0; i < 2 * cage.positions.size(); ++i)
            rig_.morphOffsets.emplace_back(0.01f * float(i), 1, 2);
    }
    [[nodiscard]] Pose pose(double seconds) const override {
        Pose pose;
        if (isRigged_) {
            pose.joints = {mat4(1), mat4(float(1 + seconds))};
            pose.joints[1][3] = {float(seconds), 2, 3, 1};
            pose.morphWeights = {0.5f, float(seconds)};
        } else {
            for (const vec3& p : positions_) pose.positions.push_back(p + vec3(float(seconds) * p.y, 0, 1));
        }
        return pose;
    }
    [[nodiscard]] const Rig* rig() const override { return isRigged_ ? &rig_ : nullptr; }
    [[nodiscard]] dvec2 keyRange() const override { return {1, 7}; }

private:
    std::vector<vec3> positions_;
    bool isRigged_;
    Rig rig_;
};

TEST(Gather, movesPointsAsTheyMovedBefore) {
    const Cage cage = torusWithSeams();
    const std::vector<std::uint32_t> points = {7, 0, 3, 3, std::uint32_t(cage.positions.size() - 1)};
    for (const bool isRigged : {false, true}) {
        const Swing whole(cage, isRigged);
        const auto some = gather(std::make_unique<Swing>(cage, isRigged), points);
        EXPECT_EQ(some->keyRange(), dvec2(1, 7));
        EXPECT_EQ(some->rig() != nullptr, isRigged);
        const std::vector<vec3> all = posedPositions(whole.rig(), whole.pose(2.5)),
                                gathered = posedPositions(some->rig(), some->pose(2.5));
        ASSERT_EQ(gathered.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(gathered[i], all[points[i]]);
    }
}

} // namespace
} // namespace relief::test
