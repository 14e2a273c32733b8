// One vertex per position, in files that have several numbers per corner and in those that have one.
#include <map>
#include <set>

#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// A cage as a dense mesh with hard edges: one vertex per corner.
DenseMesh faceted(const Cage& cage) {
    Cage hard = cage;
    hard.normals.clear(), hard.normalCorners.clear();
    for (std::size_t i = 0; i < hard.corners.size(); ++i) {
        hard.normals.push_back(glm::normalize(vec3(float(i % 7) - 3, 1, float(i % 5) - 2)));
        hard.normalCorners.push_back(std::uint32_t(i));
    }
    return denseMesh(hard);
}

/// Directed edges that do not have as many uses one way as the other.
std::size_t openEdges(const std::vector<std::uint32_t>& indices) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return std::size_t(std::ranges::count_if(balance, [](const auto& edge) { return edge.second != 0; }));
}

TEST(WeldPositions, closesClosedCages) {
    for (const Cage& cage : {cube(), cubeOfIslands(), hardCube(), torusWithSeams(), nGonPrism(9), icosahedron(),
                             cubeWithCollapsedEdge()}) {
        const DenseMesh split = faceted(cage);
        EXPECT_GT(openEdges(split.indices), 0u);
        const DenseMesh welded = weldPositions(split);
        EXPECT_EQ(openEdges(welded.indices), 0u);
        EXPECT_TRUE(welded.texCoords.empty());
        std::set<std::tuple<float, float, float>> positions;
        for (const vec3& p : welded.positions) EXPECT_TRUE(positions.insert({p.x, p.y, p.z}).second);
        ASSERT_EQ(welded.normals.size(), welded.positions.size());
        for (const vec3& n : welded.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5);
    }
}

TEST(WeldPositions, removesTrianglesThatLoseACorner) {
    const DenseMesh welded = weldPositions(faceted(cubeWithCollapsedEdge()));
    for (std::size_t i = 0; i < welded.indices.size(); i += 3)
        EXPECT_EQ(std::set<std::uint32_t>(&welded.indices[i], &welded.indices[i] + 3).size(), 3u);
}

TEST(WeldPositions, sumsNormalsAndKeepsOneWhereTheyCancel) {
    DenseMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 0, -1}, {0, 1, 0}};
    mesh.indices = {0, 1, 2, 3, 5, 4};
    const DenseMesh welded = weldPositions(mesh);
    ASSERT_EQ(welded.positions.size(), 4u);
    EXPECT_NEAR(glm::length(welded.normals[0] - glm::normalize(vec3(0, 1, 1))), 0, 1e-6);
    EXPECT_EQ(welded.normals[1], vec3(0, 0, 1));
    EXPECT_EQ(welded.indices, (Indices{0, 1, 2, 0, 3, 1}));
}

TEST(MeshWriter, writesEachPositionOnceIntoObj) {
    const TemporaryFolder folder;
    for (const Cage& cage : {cubeOfIslands(), torusWithSeams(), nGonPrism(5)}) {
        const DenseMesh mesh = faceted(cage);
        writeMesh(folder / "a.obj", mesh);
        const Cage back = readCage(folder / "a.obj");
        EXPECT_EQ(back.positions.size(), summarize(cage).vertexCount);
        EXPECT_EQ(openEdges(back.corners), 0u);
        ASSERT_EQ(back.corners.size(), mesh.indices.size());
        for (std::size_t i = 0; i < back.corners.size(); ++i) {
            EXPECT_EQ(back.positions[back.corners[i]], mesh.positions[mesh.indices[i]]);
            EXPECT_EQ(back.normals[back.normalCorners[i]], mesh.normals[mesh.indices[i]]);
            if (back.hasTexCoords()) {
                EXPECT_EQ(back.texCoords[back.texCorners[i]], mesh.texCoords[mesh.indices[i]]);
            }
        }
    }
}

TEST(MeshWriter, refusesObjWhoseTrianglesAllNameAPositionTwice) {
    const TemporaryFolder folder;
    DenseMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}};
    mesh.normals.resize(3, vec3(0, 0, 1));
    mesh.indices = {0, 1, 2};
    expectFailure(Failure::input, {"a position twice"}, [&] { writeMesh(folder / "a.obj", mesh); });
    EXPECT_EQ(folder.fileCount(), 0u);
}

} // namespace
} // namespace relief::test
