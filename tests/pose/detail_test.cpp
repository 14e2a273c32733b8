// Normals that a height function bends on what moves: it is given the point at rest.
#include <glm/gtc/matrix_transform.hpp>

#include "frame/seen.h"
#include "pose/pose.h"
#include "pose/poses.h"

namespace relief::test {
namespace {

class MovedFunctionNormals : public OnDevice {};

FunctionHeights wavesOf(ByFunction how) {
    return heightsByFunction("0.05 * sin(11.0 * p.x) * cos(9.0 * p.y) + 0.02 * sin(8.0 * st.x)", how);
}

/// The square from (-1, -1) to (1, 1) in the plane z = 0, whose texture coordinates go from 0 to 1.
Cage square() {
    Cage plane;
    plane.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    plane.texCoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    addFace(plane, {0, 1, 2, 3}, {0, 1, 2, 3});
    return plane;
}

/// Angles to the normals in closed form where the square has been made 1 / `narrow` times as wide along x.
std::vector<double> anglesToWaves(const std::vector<Seen>& pixels, double narrow) {
    std::vector<double> angles;
    for (const Seen& seen : pixels) {
        const double x = 11 * (2 * seen.st.x - 1), y = 9 * (2 * seen.st.y - 1);
        const double hx = 0.05 * 11 * std::cos(x) * std::cos(y) + 0.02 * 8 * 0.5 * std::cos(8 * seen.st.x);
        const double hy = -0.05 * 9 * std::sin(x) * std::sin(y);
        angles.push_back(degreesBetween(seen.normal, {-narrow * hx, -hy, 1}));
    }
    return angles;
}

TEST_F(MovedFunctionNormals, areThoseOfTheStretchedFunction) {
    const Cage rest = square();
    std::vector<vec3> wide = rest.positions;
    for (vec3& p : wide) p.x *= 2;
    const Surface surface = buildSurface(rest, {.scheme = Scheme::bilinear});
    for (const ByFunction how : {ByFunction::bends, ByFunction::both}) {
        const FunctionHeights heights = wavesOf(how);
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = rest.positions, .function = &heights});
        Poser poser(device(), model, {.surface = &surface, .restPositions = rest.positions});
        poser.pose(poseOf(wide));
        for (const Path path : kDetailPaths) {
            RenderOptions options = bilinear();
            options.path = path;
            options.rate = 16;
            const std::vector<double> angles = anglesToWaves(look(model, options, {0, 0, 4}, 0.9), 0.5);
            EXPECT_GT(angles.size(), 10000u);
            EXPECT_LT(rms(angles), 0.3) << int(path) << " how " << int(how);
        }
    }
}

TEST_F(MovedFunctionNormals, ofPlainTrianglesAreThoseOfTheStretchedFunction) {
    const FunctionHeights heights = wavesOf(ByFunction::bends);
    const DenseMesh rest = denseMesh(square());
    const Tangents tangents = computeTangents(rest);
    MeshModel model(device(), {.mesh = &rest, .function = &heights, .tangents = &tangents});
    MeshPoser poser(device(), model, rest, Rig());
    DenseMesh wide = rest;
    for (vec3& p : wide.positions) p.x *= 2;
    const Tangents wideTangents = computeTangents(wide);
    poser.upload(wide, &wideTangents);
    EXPECT_LT(rms(anglesToWaves(look(model, bilinear(), {0, 0, 4}, 0.9), 0.5)), 0.2);
    // What was posed before the model was made.
    const MeshModel posed(
        device(), {.mesh = &wide, .function = &heights, .restPositions = rest.positions, .tangents = &wideTangents});
    EXPECT_LT(rms(anglesToWaves(look(posed, bilinear(), {0, 0, 4}, 0.9), 0.5)), 0.2);
}

// The device moves gradients with the vertices: one joint that makes everything twice as wide, and turns it.
TEST_F(MovedFunctionNormals, ofSkinnedTrianglesAreThoseOfTheStretchedFunction) {
    const FunctionHeights heights = wavesOf(ByFunction::bends);
    const HeightMap map = sineMap(512, 0.03, 3);
    const DenseMesh rest = denseMesh(square());
    const Tangents tangents = computeTangents(rest);
    Rig rig{.rest = rest.positions, .jointCount = 1, .influenceCount = 1};
    rig.joints.assign(rest.positions.size(), 0);
    rig.weights.assign(rest.positions.size(), 1);
    const mat4 turn = glm::rotate(mat4(1), 0.4f, vec3(0, 1, 0)), joint = turn * glm::scale(mat4(1), vec3(2, 1, 1));
    DenseMesh moved = rest;
    for (vec3& p : moved.positions) p = vec3(joint * vec4(p, 1));
    for (vec3& n : moved.normals) n = vec3(turn * vec4(n, 0));
    const Tangents movedTangents = computeTangents(moved);
    const auto compare = [&](const FunctionHeights* function, const HeightMap* bump) {
        const auto make = [&] {
            return MeshModel(device(), {.mesh = &rest, .bump = bump, .function = function, .tangents = &tangents});
        };
        MeshModel skinned = make(), sent = make();
        MeshPoser skinner(device(), skinned, rest, rig), sender(device(), sent, rest, rig);
        skinner.pose({.positions = {}, .joints = {joint}, .morphWeights = {}});
        sender.upload(moved, &movedTangents);
        const std::vector<Seen> one = look(skinned, bilinear(), {0, 0, 4}, 0.9);
        const std::vector<Seen> other = look(sent, bilinear(), {0, 0, 4}, 0.9);
        ASSERT_EQ(one.size(), other.size());
        std::vector<double> angles, bends;
        for (std::size_t i = 0; i < one.size(); ++i) {
            angles.push_back(degreesBetween(one[i].normal, other[i].normal));
            bends.push_back(degreesBetween(one[i].normal, dvec3(turn * vec4(0, 0, 1, 0))));
        }
        EXPECT_LT(most(angles), 0.1);
        EXPECT_GT(rms(bends), 5);
    };
    compare(&heights, nullptr);
    compare(nullptr, &map);
}

// A cage that is turned looks as one that stands where it was and is turned by its place in the world.
TEST_F(MovedFunctionNormals, ofARigidMoveAreTurnedWithIt) {
    Islands& cube = cubeWithIslands();
    const mat3 turn(glm::rotate(mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3))));
    std::vector<vec3> turned = cube.cage.positions;
    for (vec3& p : turned) p = turn * p;
    for (const ByFunction how : {ByFunction::bends, ByFunction::both}) {
        const FunctionHeights heights = wavesOf(how);
        const SurfaceModelDesc desc{
            .surface = &cube.surface, .cagePositions = cube.cage.positions, .function = &heights};
        const SurfaceModel still(device(), desc);
        SurfaceModel moved(device(), desc);
        Poser poser(device(), moved, {.surface = &cube.surface, .restPositions = cube.cage.positions});
        poser.pose(poseOf(turned));
        for (const Path path : kDetailPaths) {
            RenderOptions options = bilinear();
            options.path = path;
            options.rate = 16;
            const std::vector<Seen> byPose = look(moved, options, {2, 3, 4}, 0.8);
            const std::vector<Seen> byPlace = look(Instance(still, {}, mat4(turn)), options, {2, 3, 4}, 0.8);
            // Pixels on outlines and edges of faces may see another face.
            std::vector<double> angles;
            for (std::size_t i = 0; i < std::min(byPose.size(), byPlace.size()); ++i)
                if (byPose[i].face == byPlace[i].face && glm::length(byPose[i].st - byPlace[i].st) < 0.01)
                    angles.push_back(degreesBetween(byPose[i].normal, byPlace[i].normal));
            EXPECT_GT(angles.size(), 3000u);
            EXPECT_LT(rms(angles), 0.2) << int(path) << " how " << int(how);
        }
    }
}

} // namespace
} // namespace relief::test
