// Cameras and light of a scene.
#include <cmath>

#include "scene/scene.h"
#include "support.h"

namespace relief::test {
namespace {

const std::vector<dvec3> kPoints = {{-3, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0.5}};

/// Whether a point is inside the picture of a camera.
bool isSeen(const Camera& camera, const dvec3& point, double aspect) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0))), up = glm::cross(right, forward);
    const dvec3 d = point - camera.eye;
    const double depth = glm::dot(d, forward), half = depth * std::tan(glm::radians(camera.fieldOfView) / 2);
    return depth > camera.nearDistance && depth < camera.farDistance && std::abs(glm::dot(d, up)) < half &&
           std::abs(glm::dot(d, right)) < half * aspect;
}

TEST(SceneCamera, isPlacedInTheWorld) {
    SceneDesc scene;
    scene.camera.lookAt = dvec3(1000, 0, 0);
    scene.camera.distance = 8;
    const Coordinates coordinates{.origin = dvec3(1000, 0, 0), .unit = 2};
    const Camera camera = makeCamera(scene, coordinates, kPoints);
    EXPECT_EQ(camera.target, dvec3(0));
    EXPECT_NEAR(glm::length(camera.eye), 4, 1e-12);
}

TEST(SceneCamera, ofATurnSeesAllPointsFromAllSides) {
    constexpr double kAspect = 1.5;
    const CameraOptions held = holdAllPoints({}, kPoints, kAspect, true);
    EXPECT_EQ(*held.lookAt, computeBounds(kPoints).center());
    for (int degrees = 0; degrees < 360; degrees += 15) {
        CameraOptions side = held;
        side.azimuth += degrees;
        const Camera camera = placeCamera(side, computeBounds(kPoints));
        for (const dvec3& p : kPoints) EXPECT_TRUE(isSeen(camera, p, kAspect)) << degrees;
    }
}

TEST(SceneCamera, thatIsHeldIsTheOneThatFramesThePoints) {
    const Camera framed = frameCamera(kPoints, {}, 1);
    const Camera held = placeCamera(holdAllPoints({}, kPoints, 1, false), computeBounds(kPoints));
    EXPECT_LT(glm::length(framed.eye - held.eye), 1e-12);
    EXPECT_EQ(framed.target, held.target);
    EXPECT_NEAR(framed.nearDistance, held.nearDistance, 1e-12);
}

TEST(SceneLight, turnsWithTheCameraUnlessItIsGiven) {
    const Lighting usual = makeLighting({}, CameraOptions().azimuth, nullptr);
    EXPECT_EQ(usual.keyAzimuth, Lighting().keyAzimuth);
    EXPECT_EQ(makeLighting({}, CameraOptions().azimuth + 90, nullptr).keyAzimuth, Lighting().keyAzimuth + 90);
    const Lighting given = makeLighting({.key = dvec2(7, 8)}, 123, nullptr);
    EXPECT_EQ(given.keyAzimuth, 7);
    EXPECT_EQ(given.keyElevation, 8);
}

TEST(SceneMaterial, isWhiteUnderAColorMapUnlessItIsGiven) {
    EXPECT_EQ(makeMaterial({}).albedo, Material().albedo);
    EXPECT_EQ(makeMaterial({.albedo = "map.png"}).albedo, vec3(1));
    EXPECT_EQ(makeMaterial({.albedo = "map.png", .color = vec3(0.5f)}).albedo, vec3(0.5f));
}

} // namespace
} // namespace relief::test
