// What pictures of each shape show in a direction, and what is left of them after they are converted.
#include <gtest/gtest.h>

#include "light/pictures.h"

namespace relief::test {
namespace {

constexpr EnvironmentShape kShapes[] = {EnvironmentShape::equirect, EnvironmentShape::cube, EnvironmentShape::sphere};

struct Errors {
    double mean = 0, largest = 0;
};

/// Errors of lookups against the light, in directions more than `angle` radians from -Z.
Errors errorsOf(const EnvironmentPicture& picture, const Light& light, int count, double angle = 0) {
    Errors errors;
    int used = 0;
    for (const dvec3& d : randomDirections(count)) {
        if (std::acos(-d.z) < angle) continue;
        const dvec3 difference = glm::abs(lookUp(picture, d) - light(d));
        const double error = std::max({difference.x, difference.y, difference.z});
        errors.mean += error, ++used;
        errors.largest = std::max(errors.largest, error);
    }
    errors.mean /= used;
    return errors;
}

// Directions that stand in a sphere map's last ring of texels are what it cannot hold: 4 / sqrt(side) radians around
// -Z.
TEST(Shapes, showTheLightOfEveryDirection) {
    for (const EnvironmentShape shape : kShapes) {
        const bool isSphere = shape == EnvironmentShape::sphere;
        const int side = isSphere ? 512 : 128;
        EnvironmentPicture picture = drawPicture(shape, side, smoothLight);
        if (isSphere) fillRing(picture.images.front());
        const Errors errors = errorsOf(picture, smoothLight, 100'000, isSphere ? 4 / std::sqrt(side) : 0);
        EXPECT_LT(errors.largest, isSphere ? 0.02 : 0.012) << int(shape);
        EXPECT_LT(errors.mean, 0.001) << int(shape);
        if (isSphere) {
            EXPECT_LT(errorsOf(picture, smoothLight, 100'000).largest, 0.12);
        }
    }
}

TEST(Shapes, haveDirectionsThatLeadBackToTheirPoints) {
    for (const EnvironmentShape shape : kShapes)
        for (const dvec3& d : randomDirections(10'000)) {
            const PicturePoint point = pointOf(shape, 3.0 * d);
            EXPECT_LT(glm::length(directionOf(shape, point) - d), 1e-6) << int(shape) << ' ' << d.x << ' ' << d.y;
            EXPECT_TRUE(point.at.x >= 0 && point.at.x <= 1 && point.at.y >= 0 && point.at.y <= 1);
        }
    EXPECT_LT(glm::length(directionOf(EnvironmentShape::sphere, pointOf(EnvironmentShape::sphere, {0, 0, -1})) -
                          dvec3(0, 0, -1)),
              1e-9);
}

TEST(Shapes, areContinuousAcrossSeamsEdgesAndPoles) {
    for (const EnvironmentShape shape : kShapes) {
        const EnvironmentPicture picture = drawPicture(shape, 32, smoothLight);
        // Across the seam of longitudes, along the edges and corners of the cube, around a pole.
        const dvec3 points[] = {{0, 0.3, 1}, {1, 0.2, -1}, {1, 1, 1}, {1, 1, -1}, {0, 1, 0.001}, {-1, -1, 0.5}};
        for (const dvec3& point : points)
            for (const dvec3& aside : {dvec3(1e-6, 0, 0), dvec3(0, 1e-6, 0), dvec3(0, 0, 1e-6)})
                EXPECT_LT(glm::length(lookUp(picture, point + aside) - lookUp(picture, point - aside)), 0.02)
                    << int(shape) << ' ' << point.x << ' ' << point.y << ' ' << point.z;
    }
    // Around the pole of eight rows, the outermost texels are eleven degrees from it.
    const EnvironmentPicture coarse = drawPicture(EnvironmentShape::equirect, 8, smoothLight);
    for (const double y : {1.0, -1.0})
        EXPECT_LT(glm::length(lookUp(coarse, {1e-6, y, 0}) - lookUp(coarse, {-1e-6, y, 0})), 0.001) << y;
}

// cube -> sphere -> cube and equirect -> cube -> equirect, texel by texel.
TEST(Conversions, goThereAndBack) {
    const struct {
        EnvironmentShape from, to;
        double mean, largest;
    } trips[] = {{EnvironmentShape::equirect, EnvironmentShape::cube, 0.0006, 0.006},
                 {EnvironmentShape::cube, EnvironmentShape::equirect, 0.0006, 0.006},
                 {EnvironmentShape::cube, EnvironmentShape::sphere, 0.002, 0.12},
                 {EnvironmentShape::equirect, EnvironmentShape::sphere, 0.002, 0.12}};
    for (const auto& trip : trips) {
        const EnvironmentPicture before = drawPicture(trip.from, 64, smoothLight);
        const EnvironmentPicture between = convert(before, trip.to, sideOf(before, trip.to));
        const EnvironmentPicture after = convert(between, trip.from, 64);
        double sum = 0, largest = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < before.images.size(); ++i)
            for (std::size_t k = 0; k < before.images[i].texels.size(); ++k, ++count) {
                const double error = std::abs(before.images[i].texels[k] - after.images[i].texels[k]);
                sum += error, largest = std::max(largest, error);
            }
        EXPECT_LT(sum / double(count), trip.mean) << int(trip.from) << ' ' << int(trip.to);
        EXPECT_LT(largest, trip.largest) << int(trip.from) << ' ' << int(trip.to);
    }
}

TEST(Conversions, keepTheLightOfASmallLampWhateverTheSizes) {
    // One texel in 512 x 256; all of its light arrives in a cube of eight texels.
    EnvironmentPicture lamp = drawPicture(EnvironmentShape::equirect, 256, [](const dvec3&) { return dvec3(0); });
    for (int c = 0; c < 3; ++c) lamp.images.front().at(300, 120)[c] = 1000;
    const double before = 1000 * texelSolidAngle(lamp.images.front(), 120);
    const EnvironmentPicture cube = convert(lamp, EnvironmentShape::cube, 8);
    double after = 0;
    for (const Image& face : cube.images)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                const dvec2 at = 2.0 * (dvec2(x, y) + 0.5) / 8.0 - 1.0;
                after += face.at(x, y)[0] * (4.0 / 64) / std::pow(1 + glm::dot(at, at), 1.5);
            }
    EXPECT_NEAR(after / before, 1, 0.1);
}

/// The color of the face that a direction belongs to, or of the mark there.
void expectLabels(const EnvironmentPicture& picture, const char* what) {
    // What stands in front of an eye that looks along -Z, up along +Y: face pz; to its right, face px.
    const struct {
        int face;
        dvec3 forward, right, up;
    } views[] = {{4, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, {0, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                 {5, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {1, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                 {2, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {3, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}}};
    for (const auto& view : views) {
        const float* c = kFaceColors[view.face];
        const auto expect = [&](double right, double up, const dvec3& color, const char* mark) {
            const dvec3 seen = lookUp(picture, view.forward + right * view.right + up * view.up);
            EXPECT_LT(glm::length(seen - color), 0.12) << what << ", face " << view.face << ": " << mark;
        };
        expect(-0.5, 0, {c[0], c[1], c[2]}, "its color");
        expect(0.74, 0, dvec3(1), "the square at the right");
        expect(-0.74, 0, {c[0], c[1], c[2]}, "no square at the left");
        expect(0, 0.5, dvec3(0), "the arrow's head");
        expect(0, -0.72, {c[0], c[1], c[2]}, "nothing below the arrow");
        expect(0.15, 0.4, dvec3(0), "the head is wide");
        expect(0.15, -0.4, {c[0], c[1], c[2]}, "the shaft is narrow");
    }
}

TEST(Conversions, keepOrderOrientationAndHandedness) {
    const EnvironmentPicture cube = labelledCube(96);
    expectLabels(cube, "cube");
    for (const EnvironmentShape shape : kShapes) {
        const EnvironmentPicture there = convert(cube, shape, 192);
        if (shape != EnvironmentShape::sphere) { // whose rim smears what is behind the ball
            expectLabels(there, "converted");
        } else {
            EXPECT_LT(glm::length(lookUp(there, {0, 0.5, 1})), 0.1) << "the arrow behind the eye";
            EXPECT_LT(glm::length(lookUp(there, {-0.74, 0, 1}) - dvec3(1)), 0.1) << "and the square to its right";
        }
        expectLabels(
            convert(convert(cube, shape, shape == EnvironmentShape::sphere ? 384 : 128), EnvironmentShape::cube, 48),
            "there and back");
    }
}

// --- blur ---------------------------------------------------------------------------------------------------------

TEST(Blur, keepsEvenLightAndSpreadsALampByItsLobe) {
    const EnvironmentPicture even =
        drawPicture(EnvironmentShape::cube, 16, [](const dvec3&) { return dvec3(0.7, 0.5, 0.3); });
    for (const Image& face : blur(even, 0.6).images)
        for (std::size_t i = 0; i < face.texels.size(); i += 3) EXPECT_NEAR(face.texels[i], 0.7, 1e-4);
    // A lamp along +X: at an angle a the lobe of GGX has n.h = cos(a/2), and falls off by D(h) (n.l).
    const EnvironmentPicture lamp = drawPicture(EnvironmentShape::equirect, 64,
                                                [](const dvec3& d) { return dvec3(d.x > std::cos(0.1) ? 100 : 0); });
    const double roughness = 0.6, a2 = std::pow(roughness, 4);
    const EnvironmentPicture blurred = blur(lamp, roughness);
    const auto lobe = [&](double angle) {
        const double nh2 = std::pow(std::cos(angle / 2), 2), d = nh2 * (a2 - 1) + 1;
        return a2 / (d * d) * std::cos(angle);
    };
    const double middle = lookUp(blurred, {1, 0, 0}).x;
    for (const double angle : {0.3, 0.6, 0.9}) {
        const double seen = lookUp(blurred, {std::cos(angle), std::sin(angle), 0}).x;
        EXPECT_NEAR(seen / middle, lobe(angle) / lobe(0), 0.06) << angle;
    }
}

} // namespace
} // namespace relief::test
