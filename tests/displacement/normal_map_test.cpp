#include <cmath>

#include "displacement/displacement.h"
#include "support.h"

namespace relief::test {
namespace {

Image pictureOf(int width, int height, const std::vector<vec3>& texels, int channels = 3) {
    Image image{.width = width, .height = height, .channels = channels, .texels = {}};
    for (const vec3& texel : texels)
        for (int k = 0; k < channels; ++k) image.texels.push_back(k < 3 ? texel[k] : 0.25f);
    return image;
}

vec3 codeOf(const vec3& n) { return 0.5f * glm::normalize(n) + 0.5f; }

/// Four normals of a surface that rises, 2 x 2.
const std::vector<vec3> kNormals = {{1, 2, 2}, {-3, 0, 4}, {0, 0, 1}, {-2, -3, 6}};

std::vector<vec3> codes(const std::vector<vec3>& normals = kNormals) {
    std::vector<vec3> texels;
    for (const vec3& n : normals) texels.push_back(codeOf(n));
    return texels;
}

float largestAngle(const NormalMap& map, const std::vector<vec3>& expected) {
    EXPECT_EQ(map.normals.size(), expected.size());
    float largest = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        largest = std::max(largest, glm::length(map.normals[i] - glm::normalize(expected[i])));
    return largest;
}

NormalMap make(const Image& picture, const NormalOptions& options = {}, const Warn& warn = warnOnStderr) {
    return makeNormalMap(picture, "picture", options, warn);
}

/// Chunks that follow the header of a PNG (8 bytes of signature, 25 of IHDR).
using namespace std::string_literals;
const std::string kSrgbChunk = "\0\0\0\1sRGB\0\xae\xce\x1c\xe9"s;
const std::string kGammaChunk = "\0\0\0\4gAMA\0\0\xb1\x8f\x0b\xfc\x61\x05"s; // 1 / 2.2
void addChunk(const std::string& path, const std::string& chunk) {
    std::string bytes = readFile(path);
    bytes.insert(33, chunk);
    putFile(path, bytes);
}

TEST(NormalMap, decodesCodesToUnitNormals) {
    for (const int channels : {3, 4}) {
        Warnings warnings;
        const NormalMap map = make(pictureOf(2, 2, codes(), channels), {}, warnings.warn());
        EXPECT_EQ(map.width, 2);
        EXPECT_EQ(map.height, 2);
        EXPECT_EQ(map.byteCount(), 4 * sizeof(vec3));
        EXPECT_LT(largestAngle(map, kNormals), 1e-6);
        for (const vec3& n : map.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
        EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
    }
}

TEST(NormalMap, turnsGreenUpwards) {
    const std::vector<vec3> up = {{1, -2, 2}, {-3, 0, 4}, {0, 0, 1}, {-2, 3, 6}};
    EXPECT_LT(largestAngle(make(pictureOf(2, 2, codes()), {.y = NormalY::down}), up), 1e-6);
}

TEST(NormalMap, objectSpaceKeepsAllDirections) {
    const std::vector<vec3> normals = {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {1, 1, -1}};
    Warnings warnings;
    const NormalOptions options{.space = NormalSpace::object, .y = NormalY::down, .scale = 3};
    const NormalMap map = make(pictureOf(2, 2, codes(normals)), options, warnings.warn());
    EXPECT_LT(largestAngle(map, normals), 1e-6);
    EXPECT_EQ(map.space, NormalSpace::object);
    EXPECT_EQ(map.belowCount, 0u);
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
}

TEST(NormalMap, scalesSlopes) {
    const NormalMap map = make(pictureOf(2, 2, codes()), {.scale = 0.5});
    EXPECT_LT(largestAngle(map, {{0.5f, 1, 2}, {-1.5f, 0, 4}, {0, 0, 1}, {-1, -1.5f, 6}}), 1e-6);
}

TEST(NormalMap, countsTexelsWithoutANormal) {
    std::vector<vec3> texels = codes();
    texels[0] = vec3(0);
    texels[3] = vec3(128.0f / 255); // grey
    Warnings warnings;
    const NormalMap map = make(pictureOf(2, 2, texels), {}, warnings.warn());
    EXPECT_EQ(map.emptyCount, 2u);
    EXPECT_EQ(map.belowCount, 0u);
    EXPECT_LT(largestAngle(map, {{0, 0, 1}, kNormals[1], kNormals[2], {0, 0, 1}}), 1e-6);
    EXPECT_TRUE(warnings.has("picture: 2 of 4 texels hold no normal"));
}

TEST(NormalMap, saysThatNormalsPointBelowTheSurface) {
    Warnings warnings;
    const std::vector<vec3> normals = {{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 1, -1}};
    const NormalMap map = make(pictureOf(2, 2, codes(normals)), {}, warnings.warn());
    EXPECT_EQ(map.belowCount, 2u);
    EXPECT_EQ(map.firstBelow, 1u);
    EXPECT_TRUE(warnings.has("picture: 2 of 4 normals point below the surface"));
    EXPECT_TRUE(warnings.has("--normal-space object"));
}

TEST(NormalMap, takesNegativeNumbersForComponents) {
    Warnings warnings;
    const NormalMap map = make(pictureOf(2, 2, kNormals), {}, warnings.warn());
    EXPECT_LT(largestAngle(map, kNormals), 1e-6);
    EXPECT_TRUE(warnings.has("taken for components from -1 to 1"));
}

TEST(NormalMap, refusesWhatHoldsNoNormals) {
    for (const int channels : {1, 2})
        expectFailure(Failure::input, {"picture:", "3 channels", "this picture has " + std::to_string(channels)},
                      [&] { make(pictureOf(2, 2, codes(), channels)); });
    std::vector<vec3> texels = codes();
    texels[3].y = NAN;
    expectFailure(Failure::input, {"picture:", "channel 1", "column 1, row 1", "nan"},
                  [&] { make(pictureOf(2, 2, texels)); });
}

TEST(LoadNormalMap, readsEveryKindOfSample) {
    const TemporaryFolder folder;
    const struct {
        const char* name;
        SampleType sample;
        double tolerance;
    } kinds[] = {{"a.png", SampleType::uint8, 1.5 / 255}, {"b.png", SampleType::uint16, 1.5 / 65535},
                 {"c.tif", SampleType::uint8, 1.5 / 255}, {"d.tif", SampleType::real, 1e-6},
                 {"e.exr", SampleType::half, 2e-3},       {"f.exr", SampleType::real, 1e-6}};
    for (const auto& kind : kinds) {
        for (const int channels : {3, 4}) {
            Warnings warnings;
            writeImage(folder / kind.name, pictureOf(2, 2, codes(), channels), kind.sample);
            const NormalMap map = loadNormalMap(folder / kind.name, {}, warnings.warn());
            EXPECT_LT(largestAngle(map, kNormals), kind.tolerance) << kind.name;
            EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
        }
    }
}

TEST(LoadNormalMap, neverDecodesColors) {
    const TemporaryFolder folder;
    const std::string plain = folder / "plain.png", tagged = folder / "tagged.png";
    writeImage(plain, pictureOf(2, 2, codes()), SampleType::uint8);
    writeImage(tagged, pictureOf(2, 2, codes()), SampleType::uint8);
    addChunk(tagged, kSrgbChunk);
    Warnings warnings;
    EXPECT_EQ(loadNormalMap(plain, {}, warnings.warn()).normals, loadNormalMap(tagged, {}, warnings.warn()).normals);
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("tagged.png: the file says that its numbers are colors (sRGB)"));
    // ImageMagick gives a gamma to every PNG.
    warnings.lines.clear();
    addChunk(plain, kGammaChunk);
    EXPECT_EQ(readImageInfo(plain).colorTag, "gamma 2.2");
    EXPECT_EQ(loadNormalMap(plain, {}, warnings.warn()).normals, loadNormalMap(tagged, {}).normals);
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
}

TEST(LoadNormalMap, checksTheHeaderFirst) {
    const TemporaryFolder folder;
    const std::string grey = folder / "grey.png", large = folder / "large.png";
    writeImage(grey, {.width = 2, .height = 2, .channels = 1, .texels = {0, 1, 0, 1}}, SampleType::uint8);
    expectFailure(Failure::input, {"grey.png", "3 channels", "has 1"}, [&] { loadNormalMap(grey, {}); });
    writeImage(large, pictureOf(2, 2, codes()), SampleType::uint8);
    NormalOptions options;
    options.limits.side = 1;
    expectFailure(Failure::input, {"large.png", "2 x 2"}, [&] { loadNormalMap(large, options); });
    expectFailure(Failure::file, {"missing.png"}, [&] { loadNormalMap(folder / "missing.png", {}); });
}

} // namespace
} // namespace relief::test
