// Pictures of errors (--show error): the distance of triangles from surfaces that have a formula.
#include "seen.h"

namespace relief::test {
namespace {

class ErrorPictures : public OnDevice {};

/// Pixels that the surface fills, with the error that their colour stands for: pixels, -1..1, positive outside. Light
/// scales the channels alike; white, orange and blue are (237, 237, 237), (217, 97, 15) and (26, 77, 166).
struct SeenError {
    dvec2 at{0}; ///< of its centre, -1..1, y down
    double pixels = 0;
};

std::vector<SeenError> errorsIn(const Picture& picture) {
    const Image image = picture.image();
    std::vector<SeenError> all;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* texel = image.at(x, y);
            if (texel[3] < 1) continue;
            const double red = texel[0], blue = texel[2];
            const double share = blue < red ? blue / red : red / blue;
            const double error =
                blue < red ? 237 * (1 - share) / (222 - 20 * share) : -237 * (1 - share) / (211 - 71 * share);
            all.push_back({2.0 * (dvec2(x, y) + 0.5) / dvec2(image.width, image.height) - 1.0, error});
        }
    return all;
}

RenderOptions errorOptions(const dvec3& eye, double size) {
    RenderOptions options;
    options.show = Show::error;
    options.bounds.add(dvec3(-4));
    options.bounds.add(dvec3(4));
    const double distance = glm::length(eye);
    options.camera = {.eye = eye,
                      .target = {0, 0, 0},
                      .fieldOfView = glm::degrees(2 * std::atan(size / distance)),
                      .nearDistance = 0.5 * distance,
                      .farDistance = 2 * distance};
    return options;
}

// Over the square lies z = a x |x|: a chord from x0 to x1 is a (x - x0) (x1 - x) above it, or below where x is
// negative, and its distance is that times the cosine of the slope.
TEST_F(ErrorPictures, ofAParabolaAreThoseOfItsChords) {
    const Cage plane = squareCage(false);
    const Surface surface = buildSurface(plane, {.scheme = Scheme::bilinear});
    constexpr double kEye = 4, kSize = 0.9, a = 0.18;
    const FunctionHeights heights = heightsByFunction(fmt::format("{:.3f} * p.x * abs(p.x)", a), ByFunction::moves);
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = plane.positions, .function = &heights});
    for (const Way& way : detailWays()) {
        RenderOptions options = errorOptions({0, 0, kEye}, kSize);
        options.path = way.path, options.raster = way.raster;
        options.rate = 4;
        std::vector<double> differences;
        dvec2 range(0);
        for (const SeenError& seen : errorsIn(detailRenderer().render(model, options))) {
            double x = kSize * seen.at.x, toEye = kEye;
            for (int i = 0; i < 4; ++i) { // where its ray ends
                toEye = kEye - a * x * std::abs(x);
                x = kSize * seen.at.x * toEye / kEye;
            }
            const double from = 0.5 * std::floor(2 * x), pixel = 2 * kSize / 160 * toEye / kEye;
            const double chord = a * (x - from) * (from + 0.5 - x) / std::hypot(1, 2 * a * x) / pixel;
            const double expected = x < 0 ? -chord : chord;
            differences.push_back(std::abs(seen.pixels - expected));
            range = {std::min(range.x, expected), std::max(range.y, expected)};
        }
        EXPECT_GT(differences.size(), 25'000u);
        EXPECT_LT(range.x, -0.9);
        EXPECT_GT(range.y, 0.9);
        EXPECT_LT(rms(differences), 0.01) << nameOf(way);  // codes are hundredths
        EXPECT_LT(most(differences), 0.06) << nameOf(way); // pixels on both sides of a vertex
    }
}

double meanError(const Model& model, RenderOptions options, int rate) {
    options.rate = rate;
    double sum = 0;
    const std::vector<SeenError> seen = errorsIn(detailRenderer().render(Instance(model), options));
    EXPECT_GT(seen.size(), 4000u);
    for (const SeenError& each : seen) sum += std::abs(each.pixels);
    return sum / double(seen.size());
}

// Chords of half the length are four times nearer to a smooth surface, of quads and of triangles.
TEST_F(ErrorPictures, fallWithTheSquareOfTheSegments) {
    const Cage torus = torusWithSeams(), ball = icosahedron();
    const Surface quads = buildSurface(torus, {}), triangles = buildSurface(ball, {.scheme = Scheme::loop});
    const Model models[] = {SurfaceModel(device(), {.surface = &quads, .cagePositions = torus.positions}),
                            SurfaceModel(device(), {.surface = &triangles, .cagePositions = ball.positions})};
    for (const Model& model : models)
        for (const Way& way : detailWays()) {
            const bool isBall = &model == &models[1];
            RenderOptions options = errorOptions({0, 4, 8}, isBall ? 0.9 : 3);
            options.path = way.path, options.raster = way.raster;
            const double coarse = meanError(model, options, isBall ? 8 : 3),
                         fine = meanError(model, options, isBall ? 16 : 6);
            EXPECT_GT(coarse, 0.05);
            EXPECT_NEAR(coarse / fine, 4, 0.6) << isBall << " " << nameOf(way);
        }
}

// Where sides are cut into other numbers than the insides, and where rates are no whole ones, errors stay those of
// chords.
TEST_F(ErrorPictures, areSmallWhereSegmentsAreSmall) {
    const Cage torus = torusWithSeams();
    const Surface surface = buildSurface(torus, {});
    const Model model = SurfaceModel(device(), {.surface = &surface, .cagePositions = torus.positions});
    for (const Way& way : detailWays())
        for (const Spacing spacing : {Spacing::equal, Spacing::fractional}) {
            RenderOptions options = errorOptions({0, 2, 6}, 3);
            options.path = way.path, options.raster = way.raster;
            options.spacing = spacing;
            options.edgePixels = 4;
            std::vector<double> errors;
            for (const SeenError& seen : errorsIn(detailRenderer().render(Instance(model), options)))
                errors.push_back(std::abs(seen.pixels));
            // A tube of 20 pixels' radius: chords of 4 pixels, and of twice that in grids, are 0.1 to 0.4 away.
            EXPECT_GT(most(errors), 0.02);
            EXPECT_LT(rms(errors), 0.15) << nameOf(way) << " spacing " << int(spacing);
        }
}

// Segments as long as several waves of a map, with their ends where those are 0, are flat: what is missing is the map
// itself, which their mip level does not hold.
TEST_F(ErrorPictures, areThoseOfTheFullMap) {
    const Cage plane = squareCage(true);
    const Surface surface = buildSurface(plane, {.scheme = Scheme::bilinear});
    constexpr double kEye = 4, kSize = 0.9, kAmplitude = 0.008, kWave = 6.283185307179586 * 8;
    const HeightMap map = sineMap(256, kAmplitude, 8);
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = plane.positions, .height = &map});
    for (const Path path : {Path::grid, Path::dice}) {
        RenderOptions options = errorOptions({0, 0, kEye}, kSize);
        options.path = path;
        options.rate = 2;
        std::vector<double> differences;
        for (const SeenError& seen : errorsIn(detailRenderer().render(model, options))) {
            const dvec2 st = 0.5 * (kSize * dvec2(seen.at.x, -seen.at.y) + 1.0), phase = kWave * st;
            const double height = kAmplitude * std::sin(phase.x) * std::cos(phase.y);
            differences.push_back(std::abs(seen.pixels + height / (2 * kSize / 160)));
        }
        EXPECT_GT(differences.size(), 25'000u);
        EXPECT_LT(rms(differences), 0.03) << int(path); // of waves 0.7 pixels high, in texels of 0.7 pixels
    }
}

TEST_F(ErrorPictures, ofPolygonsAreNone) {
    const DenseMesh mesh = denseMesh(squareCage(false));
    const Model model = MeshModel(device(), {.mesh = &mesh});
    for (const SeenError& seen : errorsIn(detailRenderer().render(Instance(model), errorOptions({0, 0, 4}, 0.9))))
        ASSERT_EQ(seen.pixels, 0);
}

} // namespace
} // namespace relief::test
