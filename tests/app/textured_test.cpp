// Normal maps of glTF files in pictures: green patches on all sides, as the public NormalTangentMirrorTest asks for.
#include "program.h"
#include "textured.h"

namespace relief::test {
namespace {

class Textured : public ::testing::Test {
protected:
    /// A pixel of a picture of the plane by its x and y in the world, -1..1; channels in the order of the names.
    [[nodiscard]] std::vector<float> pixelAt(double x, double y, const std::vector<std::string>& names) const {
        const Image image = readImage(picture_);
        const std::vector<std::string> channels = readImageInfo(picture_).channelNames;
        // The plane is seen from a distance of 8 with the default field of view; 0.24 of the picture per unit.
        const float* pixel = image.at(int(48 + 48 * x * scale_), int(48 - 48 * y * scale_));
        std::vector<float> values;
        for (const std::string& name : names) {
            const auto at = std::ranges::find(channels, name) - channels.begin();
            EXPECT_LT(std::size_t(at), channels.size()) << name;
            values.push_back(pixel[at]);
        }
        return values;
    }
    void render(const Words& more = {}) const {
        Words words{"render", folder_ / "a.glb", "--layers", "normal", "--size", "96,96", "-o", picture_, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        expectDone(relief(words, "--azimuth 0 --elevation 0 --distance 8 --look-at 0,0,0 --fov 20"));
    }
    void expectNormal(double x, double y, const vec3& expected) const {
        const std::vector<float> n = pixelAt(x, y, {"N.X", "N.Y", "N.Z"});
        EXPECT_LT(glm::length(vec3(n[0], n[1], n[2]) - glm::normalize(expected)), 0.02f)
            << x << ' ' << y << ": " << n[0] << ' ' << n[1] << ' ' << n[2];
    }

    TemporaryFolder folder_;
    std::string picture_ = folder_ / "out.exr";
    double scale_ = 1 / (8 * std::tan(glm::radians(10.0))); ///< half pictures per unit
};

TEST_F(Textured, mirroredHalvesAreLitFromTheSameSide) {
    const vec3 tilted(0.5f, 0.25f, 0.8f);
    GltfFile file = mirroredPlane(colored({0.1f, 0.8f, 0.1f}), tiltedBelow(tilted));
    putFile(folder_ / "a.glb", file.glb());
    for (const char* filter : {"bilinear", "mipmap"}) {
        render({"--filter", filter});
        for (const double x : {-0.7, -0.3, 0.3, 0.7}) {
            expectNormal(x, 0.5, {0, 0, 1}); // the upper half of the picture
            expectNormal(x, -0.5, {x < 0 ? tilted.x : -tilted.x, tilted.y, tilted.z});
        }
    }
    // Close to where the halves meet in common vertices.
    expectNormal(-0.06, -0.5, tilted);
    expectNormal(0.06, -0.5, {-tilted.x, tilted.y, tilted.z});
    // The attribute TANGENT, pointing anywhere, changes nothing.
    file.attributes()["TANGENT"] = file.add(std::vector<vec4>(6, vec4(0, 1, 0, -1)));
    putFile(folder_ / "a.glb", file.glb());
    render();
    expectNormal(-0.3, -0.5, tilted);
}

TEST_F(Textured, baseColorsAreSeen) {
    putFile(folder_ / "a.glb", mirroredPlane(colored({0.1f, 0.8f, 0.1f}), tiltedBelow({0, 0, 1})).glb());
    render();
    const std::vector<float> rgb = pixelAt(0.3, 0.3, {"R", "G", "B"});
    EXPECT_GT(rgb[1], 4 * rgb[0]);
    EXPECT_GT(rgb[1], 4 * rgb[2]);
}

TEST_F(Textured, subdividedCagesHaveThemToo) {
    putFile(folder_ / "a.glb", mirroredPlane(colored({0.1f, 0.8f, 0.1f}), tiltedBelow({0.5f, 0.25f, 0.8f})).glb());
    render({"--scheme", "bilinear"});
    expectNormal(-0.5, -0.5, {0.5f, 0.25f, 0.8f});
    expectNormal(0.5, -0.5, {-0.5f, 0.25f, 0.8f});
    expectNormal(-0.5, 0.5, {0, 0, 1});
}

} // namespace
} // namespace relief::test
