// Normals of plain polygons that move.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "animation/animation.h"
#include "gltf.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// A sphere of `side` * 2 * `side` quads with the normals of a sphere; its positions in `cage` may differ.
Cage sphereWithNormals(std::uint32_t side) {
    Cage cage;
    const std::uint32_t around = 2 * side;
    for (std::uint32_t j = 0; j <= side; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double latitude = (double(j) + 0.5) / (side + 1) * M_PI, longitude = i * M_PI / side;
            cage.positions.emplace_back(std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                                        -std::sin(latitude) * std::sin(longitude));
        }
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t next = (i + 1) % around;
            addFace(cage, {j * around + i, (j + 1) * around + i, (j + 1) * around + next, j * around + next});
        }
    cage.normals = cage.positions;
    cage.normalCorners = cage.corners;
    return cage;
}

/// The largest angle in degrees between a corner's normal and what it should be.
template <typename Expected>
double worstAngle(const Cage& cage, const Expected& expected) {
    double worst = 0;
    for (std::size_t i = 0; i < cage.corners.size(); ++i) {
        const dvec3 n(cage.normals[cage.normalCorners[i]]), e = glm::normalize(dvec3(expected(cage.corners[i])));
        worst = std::max(worst, std::atan2(glm::length(glm::cross(n, e)), glm::dot(n, e)));
    }
    return glm::degrees(worst);
}

TEST(TurnNormals, followsTurnsAndScalingsExactly) {
    const Cage rest = sphereWithNormals(8);
    const mat3 turn(glm::rotate(mat4(1), 1.1f, glm::normalize(vec3(1, 2, -1))));
    Cage posed = rest;
    for (vec3& p : posed.positions) p = 3.0f * (turn * p) + vec3(5, 0, 1);
    turnNormals(posed, rest.positions);
    EXPECT_LT(worstAngle(posed, [&](std::uint32_t point) { return turn * rest.positions[point]; }), 1e-3);
}

TEST(TurnNormals, keepsThemAtRest) {
    const Cage rest = sphereWithNormals(8);
    Cage posed = rest;
    turnNormals(posed, rest.positions);
    EXPECT_LT(worstAngle(posed, [&](std::uint32_t point) { return rest.positions[point]; }), 1e-4);
}

/// The normal of an ellipsoid is not the turned normal of the sphere.
TEST(TurnNormals, followsStretching) {
    const Cage rest = sphereWithNormals(48);
    Cage posed = rest;
    const vec3 factors(1, 2, 1);
    for (vec3& p : posed.positions) p *= factors;
    turnNormals(posed, rest.positions);
    const auto ellipsoid = [&](std::uint32_t point) { return rest.positions[point] / factors; };
    EXPECT_GT(worstAngle(rest, ellipsoid), 15); // as if nothing had moved
    EXPECT_LT(worstAngle(posed, ellipsoid), 3); // two degrees are the size of the faces
}

/// Two flat triangles that lie in one plane at rest, and are folded.
TEST(TurnNormals, flatFacesStayFlat) {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3});
    file.addNode({{"mesh", 0}});
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    const Cage rest = readCage(folder / "a.gltf");
    Cage posed = rest;
    posed.positions[3].z = 1;
    turnNormals(posed, rest.positions);
    const vec3 folded = glm::normalize(vec3(-1, -1, 1));
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_LT(glm::length(posed.normals[posed.normalCorners[i]] - (i < 3 ? vec3(0, 0, 1) : folded)), 1e-6f) << i;
}

TEST(TurnNormals, numbersThemTheSameInAllPoses) {
    const Cage rest = sphereWithNormals(6);
    Cage one = rest, other = rest;
    for (vec3& p : other.positions) p = vec3(p.y, 2 * p.x, p.z + p.x * p.x);
    turnNormals(one, rest.positions), turnNormals(other, rest.positions);
    EXPECT_EQ(one.normalCorners, other.normalCorners);
    EXPECT_EQ(denseMesh(one).indices, denseMesh(other).indices);
}

TEST(TurnNormals, keepsNormalsOfFacesThatCollapse) {
    const Cage rest = sphereWithNormals(4);
    Cage posed = rest;
    for (vec3& p : posed.positions) p = vec3(1);
    turnNormals(posed, rest.positions);
    EXPECT_LT(worstAngle(posed, [&](std::uint32_t point) { return rest.positions[point]; }), 1e-4);
}

/// Two nodes that meet at rest and part later: each takes its own points along.
TEST(Skin, pointsOfACageFromTheSameFileFollowTheirOwnNodes) {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    file.addNode({{"mesh", 0}});
    file.addNode({{"mesh", 0}});
    file.addChannel(1, "translation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec3>{{0, 0, 0}, {0, 0, 2}}));
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    const Cage cage = readCage(folder / "a.gltf");
    ASSERT_EQ(cage.positions.size(), 6u);
    const auto animation = readSkin(folder / "a.gltf", cage, {});
    const std::vector<vec3> posed = posedPositions(animation->rig(), animation->pose(1));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(posed[i].z, i < 3 ? 0 : 2) << i;
}

} // namespace
} // namespace relief::test
