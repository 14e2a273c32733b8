// Poses around faces and vertices of many neighbours, whose stencils name shared points.
#include <set>

#include "frame/device.h"
#include "meshes.h"
#include "pose/pose.h"
#include "pose/poses.h"
#include "shared/pose.h"
#include "support.h"

namespace relief::test {
namespace {

class ManyNeighbourPoses : public OnDevice {};

std::vector<vec3> bent(const Cage& cage) {
    std::vector<vec3> positions = cage.positions;
    for (vec3& p : positions) p += vec3(0.3f * p.y * p.y, 0.2f * p.x * p.z, 0.1f * p.x);
    return positions;
}

std::vector<SampleQuery> queriesOf(const Surface& surface) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (const vec2& uv : {vec2(0.1f, 0.2f), vec2(0.97f, 0.98f), vec2(0.5f, 0.9f)}) queries.push_back({face, uv});
    return queries;
}

TEST_F(ManyNeighbourPoses, giveTheLimitPointsOfThePosedCage) {
    for (const Cage& cage : {nGonPrism(90), poles(40)}) {
        const SurfaceOptions options{.isolation = 4};
        const Surface surface = buildSurface(cage, options);
        ASSERT_GT(surface.stencils.sharedRowCount, 0u);
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
        Poser poser(device(), model, {.surface = &surface});
        const std::vector<vec3> positions = bent(cage);
        poser.pose(poseOf(positions));
        ReferenceSurface reference(cage, options);
        reference.pose(positions);
        const std::vector<SampleQuery> queries = queriesOf(surface);
        const std::vector<SampleResult> results = sampler().sample(model, queries);
        const std::vector<Bounds> boxes = FaceSupports(surface).bounds(positions, model.faceHeightBounds);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const dvec3 p = reference.limit(int(queries[i].face), dvec2(queries[i].uv)).p;
            ASSERT_LT(glm::length(p - dvec3(results[i].p)), 5e-6) << "face " << queries[i].face;
            const Bounds& box = boxes[queries[i].face];
            ASSERT_TRUE(glm::all(glm::lessThanEqual(box.lower, p)) && glm::all(glm::lessThanEqual(p, box.upper)));
        }
    }
}

TEST(StencilBlocksOfManyNeighbours, makeSharedRowsFirst) {
    const Surface surface = buildSurface(nGonPrism(90), {.isolation = 4});
    const Stencils& stencils = surface.stencils;
    const StencilBlocks blocks = stencilBlocks(stencils);
    EXPECT_GT(blocks.sharedBlockCount, 0u);
    ASSERT_FALSE(blocks.classes.empty());
    EXPECT_EQ(blocks.classes.front().firstBlock, blocks.sharedBlockCount);
    std::set<std::uint32_t> made;
    for (std::uint32_t block = 0; block < blocks.blockCount(); ++block) {
        for (std::uint32_t e = blocks.firsts[block]; e < blocks.firsts[block + 1]; ++e) {
            const std::uint32_t point = blocks.entries[e];
            ASSERT_TRUE(point < surface.controlPointCount ||
                        (block >= blocks.sharedBlockCount && made.contains(point - surface.controlPointCount)));
        }
        for (std::uint32_t lane = 0; lane < kBlockRows; ++lane) {
            const std::uint32_t row = blocks.targets[kBlockRows * block + lane];
            if (row == kNoPatch) continue;
            EXPECT_TRUE(made.insert(row).second);
            EXPECT_EQ(row < stencils.sharedRowCount, block < blocks.sharedBlockCount);
        }
    }
    EXPECT_EQ(made.size(), stencils.rowCount());
}

} // namespace
} // namespace relief::test
