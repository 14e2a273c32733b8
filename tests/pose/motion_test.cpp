// Moving cages in pictures: layers, motion between frames, and triangles that stay closed.
#include "animation/animation.h"
#include "check/check.h"
#include "frame/device.h"
#include "meshes.h"
#include "pose/pose.h"
#include "pose/poses.h"

namespace relief::test {
namespace {

class Motion : public OnDevice {};

std::vector<vec3> moved(const std::vector<vec3>& positions, const mat3& turn, const vec3& shift) {
    std::vector<vec3> all;
    for (const vec3& p : positions) all.push_back(turn * p + shift);
    return all;
}

Camera cameraFor(const Cage& cage) { return optionsFor(cage).camera; }

constexpr int kSide = 96;

/// (x, y) in pixels, by the camera's definition: independent of the renderer's matrices.
dvec2 pixelOf(const Camera& camera, const dvec3& p) {
    const dvec3 back = glm::normalize(camera.eye - camera.target);
    const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)), up = glm::cross(back, right);
    const dvec3 d = p - camera.eye;
    const double depth = -glm::dot(d, back), f = 0.5 * kSide / std::tan(glm::radians(camera.fieldOfView) / 2);
    return dvec2(0.5 * kSide) + dvec2(glm::dot(d, right), -glm::dot(d, up)) * (f / depth);
}

/// The point that pixel (x, y) sees at a depth.
dvec3 pointAt(const Camera& camera, double x, double y, double depth) {
    const dvec3 back = glm::normalize(camera.eye - camera.target);
    const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)), up = glm::cross(back, right);
    const double f = 0.5 * kSide / std::tan(glm::radians(camera.fieldOfView) / 2);
    return camera.eye + depth * ((x - 0.5 * kSide) / f * right - (y - 0.5 * kSide) / f * up - back);
}

/// Hands every seen pixel's layers to `check`, and counts them.
template <typename Check>
int eachPixel(const Picture& picture, const Check& check) {
    int count = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const float* values = &picture.layerValues[std::size_t(y * kSide + x) * kLayerChannels];
            if (values[kLayerFace] < 0) continue;
            check(dvec2(x + 0.5, y + 0.5), values);
            ++count;
        }
    return count;
}

/// Cage, map and model that stand in one pose now and stood in another before.
struct MovingScene {
    Cage cage;
    HeightMap map = sineMap(64, 0.1);
    Surface surface = buildSurface(cage, {.isolation = 3});
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    Poser poser{device(), model, {.surface = &surface, .keepsBefore = true}};
    RenderOptions options;

    explicit MovingScene(Cage of) : cage(std::move(of)) {
        options.camera = cameraFor(cage);
        options.camera.eye *= 1.3;
        options.lighting.castsShadows = false;
        options.rate = 24;
        options.layers = {Layer::motion};
        for (const vec3& p : cage.positions) options.bounds.add(2.0 * dvec3(p));
        fitDepth(options.camera, options.bounds);
    }
};

// A cage that is turned and shifted takes its displaced surface along: what a pixel sees now was elsewhere before, by
// hand.
TEST_F(Motion, ofARigidMoveIsThatOfThePointsThatAreSeen) {
    MovingScene scene(torusWithSeams());
    const double angle = 0.12;
    const mat3 turn(float(std::cos(angle)), 0, float(-std::sin(angle)), 0, 1, 0, float(std::sin(angle)), 0,
                    float(std::cos(angle)));
    const vec3 shift(0.05f, 0.1f, -0.08f);
    scene.poser.pose(poseOf(moved(scene.cage.positions, turn, shift)), nullptr);
    const Pose now = poseOf(moved(scene.cage.positions, turn, shift)), before = poseOf(scene.cage.positions);
    scene.poser.pose(now, &before);
    Renderer renderer(device(), {.width = kSide, .height = kSide});
    scene.options.cameraBefore = scene.options.camera;
    scene.options.cameraBefore->eye += dvec3(0.1, 0, 0.05); // the camera moves as well
    for (const Path path : {Path::tessellation, Path::grid, Path::dice}) {
        scene.options.path = path;
        const Picture picture = renderer.render(scene.model, scene.options);
        double worst = 0, longest = 0;
        const int count = eachPixel(picture, [&](const dvec2& pixel, const float* values) {
            const dvec3 seen = pointAt(scene.options.camera, pixel.x, pixel.y, values[kLayerDepth]);
            const dvec3 origin = glm::transpose(glm::dmat3(turn)) * (seen - dvec3(shift));
            const dvec2 expected = pixel - pixelOf(*scene.options.cameraBefore, origin);
            const dvec2 motion(values[kLayerMotion], values[kLayerMotion + 1]);
            worst = std::max(worst, glm::length(motion - expected));
            longest = std::max(longest, glm::length(motion));
        });
        EXPECT_GT(count, 1000) << "path " << int(path);
        EXPECT_GT(longest, 3) << "path " << int(path);
        EXPECT_LT(worst, 0.02) << "path " << int(path); // chords of 24 segments lie a little off the surface
    }
}

// A sheared cage without heights: its surface is sheared with it, and rates that change from frame to frame do not
// matter.
TEST_F(Motion, ofAShearIsExactWhateverTheRates) {
    Cage cage = torusWithSeams();
    const Surface surface = buildSurface(cage, {.isolation = 3});
    SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    Poser poser(device(), model, {.surface = &surface, .keepsBefore = true});
    const mat3 shear(1.05f, 0, 0.1f, 0.08f, 0.95f, 0, 0, 0.12f, 1);
    const Pose now = poseOf(moved(cage.positions, shear, vec3(0))), before = poseOf(cage.positions);
    poser.pose(now, &before);
    RenderOptions options;
    options.camera = cameraFor(cage);
    options.camera.eye *= 1.3;
    options.bounds = poser.bounds();
    fitDepth(options.camera, options.bounds);
    options.layers = {Layer::motion};
    options.spacing = Spacing::fractional;
    options.edgePixels = 0.5;
    Renderer renderer(device(), {.width = kSide, .height = kSide});
    const Picture picture = renderer.render(model, options);
    double worst = 0;
    const glm::dmat3 back = glm::inverse(glm::dmat3(shear));
    eachPixel(picture, [&](const dvec2& pixel, const float* values) {
        const dvec3 seen = pointAt(options.camera, pixel.x, pixel.y, values[kLayerDepth]);
        const dvec2 expected = pixel - pixelOf(options.camera, back * seen);
        worst = std::max(worst, glm::length(dvec2(values[kLayerMotion], values[kLayerMotion + 1]) - expected));
    });
    EXPECT_LT(worst, 0.02);
}

/// Every kind of side that a face can have: of two edges, run backwards, of triangles, with creases.
struct ShearedCage {
    const char* name;
    Cage cage;
    Spacing spacing = Spacing::equal;
    Scheme scheme = Scheme::catmark;
};
std::vector<ShearedCage> shearedCages() {
    return {{"torus", torusWithSeams(), Spacing::fractional},
            {"prism", nGonPrism(5)},
            {"mixed", mixedFaces(), Spacing::fractional},
            {"creases", creasedCube()},
            {"loop", icosahedron(), Spacing::fractional, Scheme::loop}};
}

// Motion is evaluated at the (u,v) that a pixel sees in its face: a vertex of a diced mesh, which several faces share,
// has another one in each of them.
TEST_F(Motion, ofAShearIsExactOnDicedFacesOfEveryKind) {
    Renderer renderer(device(), {.width = kSide, .height = kSide});
    const mat3 shear(1.2f, 0, 0.3f, 0.2f, 0.8f, 0, 0, 0.3f, 1);
    const glm::dmat3 back = glm::inverse(glm::dmat3(shear));
    for (const ShearedCage& one : shearedCages()) {
        const Surface surface = buildSurface(one.cage, {.scheme = one.scheme, .isolation = 3});
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = one.cage.positions});
        Poser poser(device(), model, {.surface = &surface, .keepsBefore = true});
        const Pose now = poseOf(moved(one.cage.positions, shear, vec3(0))), before = poseOf(one.cage.positions);
        poser.pose(now, &before);
        RenderOptions options;
        options.camera = cameraFor(one.cage);
        options.camera.eye *= 1.3;
        options.bounds = poser.bounds();
        fitDepth(options.camera, options.bounds);
        options.layers = {Layer::motion};
        options.path = Path::dice;
        options.spacing = one.spacing;
        options.edgePixels = 1.5;
        const Picture picture = renderer.render(model, options);
        double worst = 0, longest = 0;
        const int count = eachPixel(picture, [&](const dvec2& pixel, const float* values) {
            const dvec3 seen = pointAt(options.camera, pixel.x, pixel.y, values[kLayerDepth]);
            const dvec2 expected = pixel - pixelOf(options.camera, back * seen);
            const dvec2 motion(values[kLayerMotion], values[kLayerMotion + 1]);
            worst = std::max(worst, glm::length(motion - expected));
            longest = std::max(longest, glm::length(motion));
        });
        EXPECT_GT(count, 500) << one.name;
        EXPECT_GT(longest, 3) << one.name;
        EXPECT_LT(worst, 0.05) << one.name;
    }
}

TEST_F(Motion, ofAStillPoseIsNone) {
    MovingScene scene(cubeOfIslands());
    const Pose still = poseOf(scene.cage.positions);
    scene.poser.pose(still, &still);
    Renderer renderer(device(), {.width = kSide, .height = kSide});
    const Picture picture = renderer.render(scene.model, scene.options);
    EXPECT_GT(eachPixel(picture,
                        [&](const dvec2&, const float* values) {
                            EXPECT_EQ(values[kLayerMotion], 0);
                            EXPECT_EQ(values[kLayerMotion + 1], 0);
                        }),
              1000);
}

TEST_F(Motion, layersAreTheSurfacesOwn) {
    MovingScene scene(torusWithSeams());
    const Pose still = poseOf(scene.cage.positions);
    scene.poser.pose(still, &still);
    const ReferenceSurface reference(scene.cage, {.isolation = 3});
    Renderer renderer(device(), {.width = kSide, .height = kSide});
    const Picture picture = renderer.render(scene.model, scene.options);
    const double heightBound = scene.map.heightBound();
    eachPixel(picture, [&](const dvec2& pixel, const float* values) {
        const dvec3 n(values[kLayerNormal], values[kLayerNormal + 1], values[kLayerNormal + 2]);
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
        EXPECT_LE(std::abs(values[kLayerHeight]), heightBound * 1.001);
        EXPECT_LT(values[kLayerFace], float(scene.cage.faceCount()));
        // The height that the map has at the layer's texture coordinates; triangles are flat between their corners.
        const dvec2 st(values[kLayerTexCoords], values[kLayerTexCoords + 1]);
        EXPECT_NEAR(values[kLayerHeight], sampleHeight(scene.map, st).h, 0.03 * heightBound);
        const dvec3 seen = pointAt(scene.options.camera, pixel.x, pixel.y, values[kLayerDepth]);
        const Bounds& box = scene.poser.bounds();
        EXPECT_TRUE(glm::all(glm::lessThan(box.lower, seen)) && glm::all(glm::lessThan(seen, box.upper)));
    });
}

// --- watertight while it moves -------------------------------------------------------------------------------------

TEST_F(Motion, keepsTheTrianglesClosed) {
    const HeightMap map = sineMap(64, 0.1);
    EdgeRater rater(device());
    Capturer capturer(device());
    for (const NamedCage& named :
         {NamedCage{"cube of islands", cubeOfIslands()}, NamedCage{"creased cube", creasedCube()},
          NamedCage{"mixed faces", mixedFaces()}, NamedCage{"torus with seams", torusWithSeams()}}) {
        const Surface surface = buildSurface(named.cage, {});
        for (const HeightSpace space : {HeightSpace::absolute, HeightSpace::stretch}) {
            SurfaceModel model(device(), {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
            Poser poser(device(), model,
                        {.surface = &surface, .heightSpace = space, .restPositions = named.cage.positions});
            const auto animation =
                deform(stillPose(named.cage), named.cage, "twist(axis=y, angle=90*t) bend(angle=40*t)");
            for (const double seconds : {0.0, 0.4, 1.0})
                for (const Path path : {Path::tessellation, Path::grid, Path::dice}) {
                    poser.pose(animation->pose(seconds));
                    const TriangleOptions options{.path = path, .edgePixels = 12};
                    const EdgeRates rates = rater.rates(model, options, viewOf(cameraFor(named.cage), 128));
                    const Watertightness w =
                        checkWatertight(capturer.capture(model, options, rates), boundarySegments(model, rates),
                                        plannedTriangles(model, path, rates));
                    EXPECT_TRUE(w.isWatertight()) << named.name << ", path " << int(path) << ", " << seconds
                                                  << " s: " << w.openEdges << " open edges";
                    EXPECT_GT(w.triangles, 100u);
                }
        }
    }
}

} // namespace
} // namespace relief::test
