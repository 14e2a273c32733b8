// How drags move the camera: each test states what the cursor may expect of it.
#include <gtest/gtest.h>

#include "view/orbit.h"

namespace relief::test {
namespace {

const ivec2 kSize(640, 400);

/// The camera of an orbit, in the world.
Camera cameraOf(const Orbit& orbit) {
    Camera camera;
    camera.target = orbit.target;
    camera.eye = orbit.target + directionAt(orbit.azimuth, orbit.elevation) * orbit.distance;
    camera.fieldOfView = orbit.fieldOfView;
    return camera;
}

const Orbit kOrbit{.target = {1, 2, 3}, .azimuth = 40, .elevation = 25, .distance = 12, .fieldOfView = 30};

TEST(Orbit, looksAtItsTarget) {
    const auto center = toPixel(cameraOf(kOrbit), kOrbit.target, kSize);
    ASSERT_TRUE(center.has_value());
    EXPECT_NEAR(center->x, 320, 1e-9);
    EXPECT_NEAR(center->y, 200, 1e-9);
}

TEST(Orbit, showsWhatIsHigherAboveAndNothingBehindTheEye) {
    const auto above = toPixel(cameraOf(kOrbit), kOrbit.target + dvec3(0, 1, 0), kSize);
    ASSERT_TRUE(above.has_value());
    EXPECT_LT(above->y, 200 - 10);
    const Camera camera = cameraOf(kOrbit);
    EXPECT_FALSE(toPixel(camera, camera.eye + (camera.eye - camera.target), kSize).has_value());
}

TEST(Orbit, turnsTheFrontOfTheObjectWithTheCursor) {
    // A point in front of the target moves to the right and down when the cursor does.
    const dvec3 front = kOrbit.target + directionAt(kOrbit.azimuth, kOrbit.elevation);
    const auto before = toPixel(cameraOf(kOrbit), front, kSize);
    const auto after = toPixel(cameraOf(turn(kOrbit, {20, 10})), front, kSize);
    EXPECT_GT(after->x, before->x + 1);
    EXPECT_GT(after->y, before->y + 1);
}

TEST(Orbit, stopsAtThePoles) {
    EXPECT_EQ(turn(kOrbit, {0, 1000}).elevation, 90);
    EXPECT_EQ(turn(kOrbit, {0, -1000}).elevation, -90);
    EXPECT_LE(std::abs(turn(kOrbit, {1e6, 0}).azimuth), 180);
}

TEST(Orbit, movesWhatIsInTheTargetsPlaneWithTheCursor) {
    const dvec2 moved(37, -21);
    const auto now = toPixel(cameraOf(pan(kOrbit, moved, kSize.y)), kOrbit.target, kSize);
    EXPECT_NEAR(now->x, 320 + moved.x, 1e-6);
    EXPECT_NEAR(now->y, 200 + moved.y, 1e-6);
}

TEST(Orbit, zoomsToTheCursor) {
    // The point of the target's plane that the cursor is on stays below it.
    const dvec2 cursor(500, 90);
    Orbit at = kOrbit;
    at = pan(at, dvec2(320, 200) - cursor, kSize.y); // its target is that point
    for (const double factor : {0.5, 0.9, 1.7}) {
        const Orbit zoomed = zoom(kOrbit, factor, cursor, kSize);
        EXPECT_DOUBLE_EQ(zoomed.distance, factor * kOrbit.distance);
        const auto seen = toPixel(cameraOf(zoomed), at.target, kSize);
        EXPECT_NEAR(seen->x, cursor.x, 1e-6) << factor;
        EXPECT_NEAR(seen->y, cursor.y, 1e-6) << factor;
    }
}

TEST(Orbit, keepsTheSizeInAParallelView) {
    const Orbit parallel = widen(kOrbit, kParallelView);
    const dvec3 right = directionAt(kOrbit.azimuth + 90, 0);
    const auto before = toPixel(cameraOf(kOrbit), kOrbit.target + right, kSize);
    const auto after = toPixel(cameraOf(parallel), kOrbit.target + right, kSize);
    EXPECT_NEAR(after->x, before->x, 1e-6);
    // And what is nearer by one unit is hardly larger.
    const dvec3 near = right + directionAt(kOrbit.azimuth, kOrbit.elevation);
    EXPECT_NEAR(toPixel(cameraOf(parallel), kOrbit.target + near, kSize)->x, after->x, 0.5);
    EXPECT_GT(toPixel(cameraOf(kOrbit), kOrbit.target + near, kSize)->x, before->x + 3);
}

TEST(Orbit, ofOptionsIsTheirCamera) {
    // Of an object with coordinates of its own, the point looked at and the distance are those of the world.
    const Coordinates coordinates{.origin = {100, 0, 0}, .unit = 4};
    Camera placed;
    placed.target = {1, 1, 1}, placed.eye = {1, 1, 4};
    const Orbit orbit = makeOrbit({.azimuth = 0, .elevation = 0}, placed, coordinates);
    EXPECT_EQ(orbit.target, dvec3(104, 4, 4));
    EXPECT_EQ(orbit.distance, 12);
    const CameraOptions options = toOptions(orbit);
    EXPECT_EQ(options.distance, 12);
    EXPECT_EQ(options.lookAt, dvec3(104, 4, 4));
}

} // namespace
} // namespace relief::test
