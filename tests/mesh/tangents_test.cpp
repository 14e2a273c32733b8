// Tangents of meshes whose texture coordinates are known functions of their points.
#include <cmath>

#include "mesh/mesh.h"
#include "support.h"

namespace relief::test {
namespace {

/// Points p = origin + x a + y b of a sloping plane.
const dvec3 kA(1, 0.5, -0.25), kB(-0.5, 2, 1);

/// A grid over that plane; all numbers are fractions that floats hold. `toTex` makes (s,t) of (x,y).
template <typename ToTex>
DenseMesh makeGrid(int side, const ToTex& toTex) {
    DenseMesh mesh;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i) {
            // Rows are not straight, so that no two triangles are alike.
            const double x = i + (j % 2 == 0 ? 0.25 : -0.125), y = j + (i % 3 == 0 ? 0.125 : 0);
            mesh.positions.push_back(vec3(dvec3(3, -1, 2) + x * kA + y * kB));
            mesh.normals.push_back(vec3(glm::normalize(glm::cross(kA, kB))));
            mesh.texCoords.push_back(vec2(toTex(dvec2(x, y))));
        }
    const auto at = [&](int i, int j) { return std::uint32_t(j * (side + 1) + i); };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            mesh.indices.insert(mesh.indices.end(),
                                {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

void expectNear(const vec3& value, const dvec3& expected, double relative) {
    EXPECT_LT(glm::length(dvec3(value) - expected), relative * glm::length(expected))
        << value.x << ' ' << value.y << ' ' << value.z;
}

TEST(Tangents, areExactForAffineTextureCoordinates) {
    // (s,t) = M (x,y) + c: p_s = a x_s + b y_s with (x_s, y_s) the first column of the inverse of M.
    const dmat2 maps[] = {{{0.25, 0}, {0, 0.25}}, {{0.25, -0.125}, {0.5, 0.125}}, {{-0.25, 0}, {0.0625, 0.5}}};
    for (const dmat2& map : maps) {
        const DenseMesh mesh = makeGrid(4, [&](const dvec2& xy) { return map * xy + dvec2(0.5, -0.25); });
        const Tangents tangents = computeTangents(mesh);
        const dmat2 inverse = glm::inverse(map);
        ASSERT_EQ(tangents.ps.size(), mesh.positions.size());
        ASSERT_EQ(tangents.pt.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            expectNear(tangents.ps[i], inverse[0].x * kA + inverse[0].y * kB, 1e-6);
            expectNear(tangents.pt[i], inverse[1].x * kA + inverse[1].y * kB, 1e-6);
        }
    }
}

/// A quarter of a cylinder about the Z axis: s once around, t = 2 z.
TEST(Tangents, areAveragedByAngleAroundACylinder) {
    constexpr int kSegments = 64;
    const double pi = std::acos(-1);
    DenseMesh mesh;
    for (int i = 0; i <= kSegments; ++i)
        for (const double z : {0.0, 0.125}) {
            const double angle = 0.5 * pi * i / kSegments;
            mesh.positions.emplace_back(std::cos(angle), std::sin(angle), z);
            mesh.normals.emplace_back(std::cos(angle), std::sin(angle), 0);
            mesh.texCoords.emplace_back(0.25 * i / kSegments, 2 * z);
        }
    for (std::uint32_t i = 0; i < kSegments; ++i)
        mesh.indices.insert(mesh.indices.end(), {2 * i, 2 * i + 2, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 1});
    const Tangents tangents = computeTangents(mesh);
    for (std::size_t i = 2; i < mesh.positions.size() - 2; ++i) {
        const vec3 n = mesh.normals[i];
        // Chords instead of arcs: lengths are of second order. Angles on both sides differ, which tilts p_s a little.
        expectNear(tangents.ps[i], 2 * pi * dvec3(-n.y, n.x, 0), 0.02);
        expectNear(tangents.pt[i], dvec3(0, 0, 0.5), 1e-5);
    }
}

TEST(Tangents, areWeighedByAngle) {
    // At vertex 0 two triangles of 90 and 45 degrees, p_s of the second twice as long.
    DenseMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
    mesh.texCoords = {{0, 0}, {1, 0}, {0, 1}, {-0.5, 1}};
    mesh.normals.resize(4, vec3(0, 0, 1));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    const Tangents tangents = computeTangents(mesh);
    expectNear(tangents.ps[1], dvec3(1, 0, 0), 1e-6);
    expectNear(tangents.ps[3], dvec3(2, 0, 0), 1e-6);
    expectNear(tangents.ps[0], dvec3((90 * 1 + 45 * 2) / 135.0, 0, 0), 1e-6);
    expectNear(tangents.pt[0], dvec3(0, 1, 0), 1e-6);
}

/// Two squares side by side whose textures are mirror images: s runs to their common edge on both.
DenseMesh mirroredSquares() {
    DenseMesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.texCoords = {{0, 0}, {0.5, 0}, {0, 0}, {0, 1}, {0.5, 1}, {0, 1}};
    mesh.normals.resize(6, vec3(0, 0, 1));
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    return mesh;
}

TEST(SplitMirrored, givesBothSidesTheirOwnTangents) {
    const DenseMesh mesh = splitMirrored(mirroredSquares());
    ASSERT_EQ(mesh.positions.size(), 8u);
    const Tangents tangents = computeTangents(mesh);
    for (std::size_t corner = 0; corner < 12; ++corner) {
        const bool isMirrored = corner >= 6;
        expectNear(tangents.ps[mesh.indices[corner]], dvec3(isMirrored ? -2 : 2, 0, 0), 1e-6);
        expectNear(tangents.pt[mesh.indices[corner]], dvec3(0, 1, 0), 1e-6);
    }
}

TEST(SplitMirrored, keepsTheTriangles) {
    DenseMesh before = mirroredSquares();
    before.heights = {0, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
    const DenseMesh after = splitMirrored(before);
    ASSERT_EQ(after.indices.size(), before.indices.size());
    ASSERT_EQ(after.heights.size(), after.positions.size());
    ASSERT_EQ(after.normals.size(), after.positions.size());
    for (std::size_t i = 0; i < after.indices.size(); ++i) {
        const std::uint32_t a = after.indices[i], b = before.indices[i];
        EXPECT_EQ(after.positions[a], before.positions[b]);
        EXPECT_EQ(after.texCoords[a], before.texCoords[b]);
        EXPECT_EQ(after.heights[a], before.heights[b]);
    }
    const auto sameSide = [](const dvec2& xy) { return 0.125 * xy; };
    EXPECT_EQ(splitMirrored(makeGrid(4, sameSide)).positions.size(), 25u) << "nothing is mirrored there";
    const auto allMirrored = [](const dvec2& xy) { return dvec2(-0.125, 0.125) * xy; };
    EXPECT_EQ(splitMirrored(makeGrid(4, allMirrored)).positions.size(), 25u) << "all of it is";
}

/// Unit, perpendicular to each other and to the normal, on the normal's side.
void expectFrame(const Tangents& tangents, std::size_t vertex, const vec3& normal) {
    const vec3 ps = tangents.ps[vertex], pt = tangents.pt[vertex];
    EXPECT_LT(glm::length(glm::cross(ps, pt) - glm::normalize(normal)), 1e-6) << vertex;
    EXPECT_NEAR(glm::dot(ps, pt), 0, 1e-6) << vertex;
    EXPECT_NEAR(glm::length(ps), 1, 1e-6) << vertex;
}

TEST(Tangents, areAnyFrameWhereTheTextureHasNoArea) {
    for (const dvec2 line : {dvec2(0, 0), dvec2(1, 0), dvec2(0.3, 0.7)}) {
        const DenseMesh mesh = makeGrid(3, [&](const dvec2& xy) { return xy.x * line + dvec2(0.1, 0.9); });
        const Tangents tangents = computeTangents(mesh);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) expectFrame(tangents, i, mesh.normals[i]);
    }
}

TEST(Tangents, ignoreDegenerateTriangles) {
    DenseMesh mesh = makeGrid(2, [](const dvec2& xy) { return 0.25 * xy; });
    const Tangents before = computeTangents(mesh);
    // One without area in space whose corners lie on both sides of vertex 4, one without area in the texture, one that
    // names a vertex twice, and a lone vertex.
    const auto first = std::uint32_t(mesh.positions.size());
    const vec3 middle = mesh.positions[4], aside(0.5f, 0.25f, 1);
    mesh.positions.insert(mesh.positions.end(), {middle - aside, middle + aside, vec3(7, 8, 9), vec3(1, 1, 1)});
    mesh.texCoords.insert(mesh.texCoords.end(), {vec2(9, 3), vec2(4, 8), mesh.texCoords[4], vec2(0)});
    mesh.normals.insert(mesh.normals.end(), {vec3(0, 1, 0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, -1)});
    mesh.indices.insert(mesh.indices.end(), {4, first, first + 1, 4, 5, first + 2, 4, 4, 5});
    const Tangents after = computeTangents(mesh);
    for (std::size_t i = 0; i < before.ps.size(); ++i) {
        EXPECT_EQ(after.ps[i], before.ps[i]) << i;
        EXPECT_EQ(after.pt[i], before.pt[i]) << i;
    }
    for (std::size_t i = first; i < mesh.positions.size(); ++i) expectFrame(after, i, mesh.normals[i]);
}

TEST(Tangents, areFiniteWithoutANormal) {
    DenseMesh mesh = makeGrid(1, [](const dvec2&) { return dvec2(0); });
    for (vec3& n : mesh.normals) n = vec3(0);
    const Tangents tangents = computeTangents(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(tangents.ps[i]), 1, 1e-6);
        EXPECT_NEAR(glm::length(tangents.pt[i]), 1, 1e-6);
    }
}

} // namespace
} // namespace relief::test
