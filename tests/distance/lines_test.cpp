// Lines that meet sheets at known heights.
#include <gtest/gtest.h>

#include "distance/distance.h"

namespace relief::test {
namespace {

/// A square of side 2 around the origin in y = height, facing up.
struct Square {
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices;

    void add(float height, bool facesUp) {
        const auto first = std::uint32_t(positions.size());
        for (const vec2& p : {vec2(-1, 1), vec2(1, 1), vec2(1, -1), vec2(-1, -1)})
            positions.emplace_back(p.x, height, p.y);
        for (std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
            if (!facesUp) i = 3 - i;
            indices.push_back(first + i);
        }
    }
    [[nodiscard]] MeasuredSurface measured() const {
        return MeasuredSurface({positions, indices}, 100, TreeUse::lines);
    }
};

TEST(Lines, meetTheNearestSheetOfTheirSide) {
    Square sheets;
    sheets.add(0.5f, true);
    sheets.add(0.3f, false);
    sheets.add(-0.4f, true);
    sheets.add(-0.1f, false);
    const MeasuredSurface surface = sheets.measured();
    const dvec3 p(0.2, 0.01, -0.3), up(0, 1, 0);
    const auto heightOf = [&](const LineReach& reach, Facing facing) {
        const std::optional<LineHit> hit = surface.nearestOnLine(p, up, reach, facing);
        return hit ? hit->height : 99;
    };
    EXPECT_NEAR(heightOf({1, 1}, Facing::front), -0.41, 1e-7);
    EXPECT_NEAR(heightOf({1, 0.405}, Facing::front), 0.49, 1e-7);
    EXPECT_NEAR(heightOf({1, 1}, Facing::back), -0.11, 1e-7);
    EXPECT_NEAR(heightOf({1, 0}, Facing::any), 0.29, 1e-7);
    EXPECT_EQ(heightOf({0.2, 0.1}, Facing::any), 99);
    EXPECT_TRUE(surface.nearestOnLine(p, up, {1, 1})->isBehindBack);
    EXPECT_FALSE(surface.nearestOnLine(p, up, {1, 1}, Facing::back)->isBehindBack);
    EXPECT_FALSE(surface.nearestOnLine({3, 0, 0}, up, {1, 1}).has_value());
}

TEST(Lines, findASurfaceThatTheirPointLiesOn) {
    Square sheet;
    sheet.add(0.1f, true); // 0.1 is no float
    const MeasuredSurface surface = sheet.measured();
    for (int i = 0; i < 1000; ++i) {
        const dvec3 p(0.001 * i - 0.5, double(0.1f) + 1e-9 * (i - 500), 0.3);
        const std::optional<LineHit> hit = surface.nearestOnLine(p, {0, 1, 0}, {0.01, 0.01});
        ASSERT_TRUE(hit) << i;
        EXPECT_NEAR(hit->height, -1e-9 * (i - 500), 1e-15);
    }
}

TEST(SampledDistance, knowsWithinWhich95PercentOfTheAreaAre) {
    // A square of which a tenth is 0.2 above the other sheet and the rest 0.1.
    Square sheet, other;
    other.add(0, true);
    sheet.add(0.1f, true);
    for (vec3& p : sheet.positions) p.x = p.x < 0 ? -0.8f : p.x;
    const auto first = std::uint32_t(sheet.positions.size());
    for (const vec2& p : {vec2(-1, 1), vec2(-0.8f, 1), vec2(-0.8f, -1), vec2(-1, -1)})
        sheet.positions.emplace_back(p.x, 0.2f, p.y);
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) sheet.indices.push_back(first + i);
    const MeasuredSurface from({sheet.positions, sheet.indices}, 2000), to({other.positions, other.indices}, 100);
    EXPECT_NEAR(measureOneWay(from, to).share95, 0.2, 1e-6);
    for (std::size_t i = first; i < sheet.positions.size(); ++i)
        sheet.positions[i].x = sheet.positions[i].x < -0.9f ? -0.84f : -0.8f;
    const MeasuredSurface less({sheet.positions, sheet.indices}, 2000);
    EXPECT_NEAR(measureOneWay(less, to).share95, 0.1, 1e-6);
}

} // namespace
} // namespace relief::test
