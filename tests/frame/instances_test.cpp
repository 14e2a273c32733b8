// Pictures of several models: each stands where its transform puts it, in its own material.
#include <glm/gtc/matrix_transform.hpp>

#include "device.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

class Instances : public OnDevice {};

Renderer& instanceRenderer() {
    static Renderer instance(device(), {.width = 96, .height = 96, .shadowSide = 256});
    return instance;
}

/// A displaced ball that fits a box of side 2 around the origin, and its triangles as a mesh.
struct Ball {
    Cage cage = cube();
    HeightMap map = sineMap(32, 0.05);
    Surface surface = buildSurface(cage, {.isolation = 3});
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    DenseMesh triangles = Dicer(device()).diceToHost(model, {.rates = uniformRates(model, 8)});
    MeshModel mesh{device(), {.mesh = &triangles}};
};

Ball& ball() {
    static Ball instance;
    return instance;
}

RenderOptions optionsOf(Path path) {
    RenderOptions options;
    options.path = path;
    options.rate = 8;
    options.filtersHeights = false;
    options.bounds.add(dvec3(-4));
    options.bounds.add(dvec3(4));
    options.camera = {.eye = {0, 1, 9}, .target = {0, 0, 0}, .fieldOfView = 40, .nearDistance = 1, .farDistance = 20};
    return options;
}

constexpr Path kAllPaths[] = {Path::tessellation, Path::grid, Path::dice};

/// Pixels of which one picture sees something and the other does not, or sees it otherwise by more than `most`.
std::size_t differentPixels(const Image& a, const Image& b, float most) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += 4) {
        float largest = 0;
        for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a.texels[i + c] - b.texels[i + c]));
        count += largest > most ? 1 : 0;
    }
    return count;
}

/// A model that is turned, scaled and moved looks as it does from a camera, under a light, that are moved the other
/// way.
TEST_F(Instances, standWhereTheirTransformPutsThem) {
    const mat4 toWorld =
        glm::scale(glm::rotate(glm::translate(mat4(1), vec3(1.5f, -0.5f, 0.25f)), 0.6f, vec3(0, 1, 0)), vec3(1.4f));
    for (const Path path : kAllPaths) {
        RenderOptions options = optionsOf(path);
        options.lighting.castsShadows = false;
        options.show = Show::faces; // light from the eye: it moves with the camera
        const Image moved = instanceRenderer().render(Instance(ball().model, {}, toWorld), options).image();

        const glm::dmat4 back = glm::inverse(glm::dmat4(toWorld));
        const auto toModel = [&](const dvec3& p) { return dvec3(back * glm::dvec4(p, 1)); };
        options.camera.eye = toModel(options.camera.eye);
        options.camera.target = toModel(options.camera.target);
        options.camera.nearDistance /= 1.4, options.camera.farDistance /= 1.4;
        const Image still = instanceRenderer().render(ball().model, options).image();
        EXPECT_LT(differentPixels(moved, still, 0.02f), 96u * 96u / 200) << int(path);
        EXPECT_GT(differentPixels(moved, instanceRenderer().render(ball().model, optionsOf(path)).image(), 0.02f), 500u);
    }
}

// Normals of a turned model are in the world.
TEST_F(Instances, turnTheirNormals) {
    RenderOptions options = optionsOf(Path::grid);
    options.show = Show::normal;
    const mat4 half = glm::rotate(mat4(1), 3.14159265f, vec3(0, 1, 0)); // a cube of this map looks the same from behind
    const Image turned = instanceRenderer().render(Instance(ball().model, {}, half), options).image();
    const float* middle = turned.at(48, 48);
    EXPECT_GT(middle[2], 0.8f) << "the side that is seen faces +z, whichever it is in the model";
}

// Wherever a picture of both shows one of them, it shows what a picture of that one alone shows.
TEST_F(Instances, haveMaterialsOfTheirOwn) {
    const Instance red(ball().model, {.albedo = {0.8f, 0.05f, 0.05f}, .roughness = 0.2f},
                       glm::translate(mat4(1), vec3(-1.6f, 0, 0)));
    const Instance blue(ball().mesh, {.albedo = {0.05f, 0.05f, 0.8f}, .roughness = 0.9f},
                        glm::translate(mat4(1), vec3(1.6f, 0, 0)));
    for (const Path path : kAllPaths) {
        RenderOptions options = optionsOf(path);
        options.lighting.castsShadows = false;
        const Instance both[] = {red, blue};
        const Picture picture = instanceRenderer().render(both, options);
        const Image together = picture.image(), left = instanceRenderer().render(red, options).image(),
                    right = instanceRenderer().render(blue, options).image();
        Image sum = left;
        for (std::size_t i = 0; i < sum.texels.size(); ++i) sum.texels[i] += right.texels[i];
        EXPECT_EQ(differentPixels(together, sum, 0.0f), 0u) << int(path);
        EXPECT_GT(together.at(27, 48)[0], 2 * together.at(27, 48)[2]) << "red on the left";
        EXPECT_GT(together.at(68, 48)[2], 2 * together.at(68, 48)[0]) << "blue on the right";
        EXPECT_EQ(picture.stats.triangleCount, 2 * 6 * 2 * 8u * 8u);
    }
}

TEST_F(Instances, hideAndShadeEachOther) {
    const Instance front(ball().model, {}, glm::translate(mat4(1), vec3(0, 0, 3)));
    const Instance behind(ball().mesh, {.albedo = {0, 1, 0}}, glm::scale(mat4(1), vec3(0.5f)));
    RenderOptions options = optionsOf(Path::grid);
    options.lighting.castsShadows = false;
    const Instance both[] = {behind, front};
    const Image together = instanceRenderer().render(both, options).image(), alone = instanceRenderer().render(front, options).image();
    EXPECT_EQ(differentPixels(together, alone, 0.0f), 0u) << "what is behind is not seen";

    // A ball above another one, under light from above: the lower one is darker.
    options.lighting.castsShadows = true;
    options.lighting.keyElevation = 89;
    options.lighting.keyStrength = 12;
    const Instance lower(ball().model), upper(ball().mesh, {}, glm::translate(mat4(1), vec3(0, 2.5f, 0)));
    const Instance stack[] = {lower, upper};
    const Image shaded = instanceRenderer().render(stack, options).image(), lit = instanceRenderer().render(lower, options).image();
    EXPECT_LT(shaded.at(48, 42)[0], 0.8f * lit.at(48, 42)[0]);
}

// Each instance writes the layers of its own pixels, from its own tables.
TEST_F(Instances, writeTheirOwnLayers) {
    RenderOptions options = optionsOf(Path::grid);
    options.layers = {Layer::depth, Layer::face, Layer::height};
    const Instance both[] = {Instance(ball().model, {}, glm::translate(mat4(1), vec3(-1.6f, 0, 0))),
                             Instance(ball().model, {}, glm::translate(mat4(1), vec3(1.6f, 0, -2)))};
    const Picture together = instanceRenderer().render(both, options);
    const Picture alone[] = {instanceRenderer().render(both[0], options), instanceRenderer().render(both[1], options)};
    const auto at = [](const Picture& picture, int x, std::uint32_t channel) {
        return picture.layerValues[(48 * 96 + std::size_t(x)) * kLayerChannels + channel];
    };
    for (const int x : {27, 63})
        for (const std::uint32_t channel : {kLayerDepth, kLayerFace, kLayerHeight})
            EXPECT_EQ(at(together, x, channel), at(alone[x == 27 ? 0 : 1], x, channel)) << x << " channel " << channel;
    EXPECT_EQ(at(together, 0, kLayerFace), -1);
    EXPECT_NEAR(at(together, 63, kLayerDepth) - at(together, 27, kLayerDepth), 2, 0.5);
}

TEST_F(Instances, areAtLeastOneAndAtMost256) {
    expectFailure(Failure::usage, {"0 instances", "1..256"},
                  [] { instanceRenderer().render(std::span<const Instance>(), optionsOf(Path::grid)); });
    const std::vector<Instance> many(257, Instance(ball().mesh));
    expectFailure(Failure::usage, {"257 instances"}, [&] { instanceRenderer().render(many, optionsOf(Path::grid)); });
}

} // namespace
} // namespace relief::test
