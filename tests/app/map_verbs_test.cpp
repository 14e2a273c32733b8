// relief normal-map and relief height-map: what they write, what they say, and what they refuse.
#include "program.h"

namespace relief::test {
namespace {

/// Waves that repeat, of heights from -0.05 to 0.05.
Image waveImage(int width, int height) {
    Image image{.width = width, .height = height, .channels = 1, .texels = {}};
    const double turn = 2 * std::acos(-1);
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
            image.texels.push_back(
                float(0.05 * std::sin(turn * (i + 0.5) / width) * std::cos(turn * (j + 0.5) / height)));
    return image;
}

struct MapVerbs : testing::Test {
    TemporaryFolder folder;
    const std::string heights = folder / "heights.exr";

    void SetUp() override { writeImage(heights, waveImage(32, 16), SampleType::real); }

    [[nodiscard]] std::string normals(const std::string& name, const std::string& more = "") const {
        const std::string path = folder / name;
        expectDone(relief({"normal-map", heights, "-o", path, "-q"}, more));
        return path;
    }
    /// A picture of normals with three channels of one color.
    [[nodiscard]] std::string flat(const std::string& name, float red, float green, float blue,
                                   SampleType sample = SampleType::uint8) const {
        Image image{.width = 8, .height = 8, .channels = 3, .texels = {}};
        for (int i = 0; i < 64; ++i) image.texels.insert(image.texels.end(), {red, green, blue});
        writeImage(folder / name, image, sample);
        return folder / name;
    }
    [[nodiscard]] Outcome toHeights(const std::string& source, const std::string& more = "") const {
        return relief({"height-map", source, "-o", folder / "out.exr"}, more);
    }
    void expectNothingWritten() const { EXPECT_FALSE(std::filesystem::exists(folder / "out.exr")); }
};

double largestDifference(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    double largest = 0;
    for (std::size_t i = 0; i < std::min(a.texels.size(), b.texels.size()); ++i)
        largest = std::max(largest, std::abs(double(a.texels[i]) - b.texels[i]));
    return largest;
}

TEST_F(MapVerbs, writeEveryKindOfNormalMap) {
    const Image exact = readImage(normals("n.exr"));
    EXPECT_EQ(exact.channels, 3);
    const struct {
        const char *name, *more, *sample;
        double tolerance;
    } kinds[] = {{"a.png", "", "uint16", 1.0 / 65535},
                 {"b.png", "--bits 8", "uint8", 1.0 / 255},
                 {"c.tif", "", "uint16", 1.0 / 65535},
                 {"d.tiff", "--bits 8", "uint8", 1.0 / 255},
                 {"e.png", "--bits 16", "uint16", 1.0 / 65535}};
    for (const auto& kind : kinds) {
        const std::string path = normals(kind.name, kind.more);
        const ImageInfo info = readImageInfo(path);
        EXPECT_EQ(info.sample, kind.sample) << kind.name;
        EXPECT_EQ(info.colorTag, "") << kind.name << ": normals are no colors";
        EXPECT_LT(largestDifference(readImage(path), exact), kind.tolerance) << kind.name;
    }
    // n ~ (-h_x, -h_y, 1) in the texel right of the middle of the top row, where h_x is steepest and h_y is 0.
    const double step = 2 * std::acos(-1) / 32, slope = -0.05 * std::sin(step) / (1 / 32.0);
    EXPECT_GT(exact.at(16, 0)[0], 0.5);
    EXPECT_NEAR(exact.at(16, 0)[0], 0.5 - 0.5 * slope / std::sqrt(1 + slope * slope), 0.01);
}

TEST_F(MapVerbs, sayWhatTheyWrote) {
    const Outcome outcome = relief({"normal-map", heights, "-o", folder / "n.png"});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_TRUE(contains(outcome.err, "n.png: 32 x 16 normals, up to 30.9 degrees steep")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "the unit square is 1 by 0.5")) << outcome.err;
    const nlohmann::json json = jsonOf(relief({"normal-map", heights, "-o", folder / "n.png", "--json"}, "--scale 2"));
    EXPECT_EQ(json.at("output"), folder / "n.png");
    EXPECT_EQ(json.at("size"), (nlohmann::json{1, 0.5}));
    EXPECT_EQ(json.at("wrap"), "repeat");
    EXPECT_NEAR(json.at("steepest_degrees"), 50, 0.5); // near atan(2 * 0.05 * 2 pi / 0.5) = 51.5

    const Outcome back = toHeights(normals("n.exr"));
    EXPECT_EQ(back.exitCode, 0);
    EXPECT_TRUE(contains(back.err, "out.exr: 32 x 16 heights from -0.0")) << back.err;
    EXPECT_TRUE(contains(back.err, "use --mid 0 --scale 1\n")) << back.err;
    EXPECT_TRUE(contains(back.err, "not integrable: 0.00 % of the slopes\n")) << back.err;
}

TEST_F(MapVerbs, undoEachOther) {
    const Image before = readImage(heights);
    for (const std::string& options :
         {std::string(), std::string("--wrap clamp"), std::string("--normal-y down"), std::string("--size 3,0.7")}) {
        const std::string path = normals("n.exr", options);
        const nlohmann::json json = jsonOf(toHeights(path, options + " --json"));
        EXPECT_LT(json.at("not_integrable_percent"), 1e-3) << options;
        const Image after = readImage(folder / "out.exr");
        EXPECT_EQ(after.channels, 1);
        EXPECT_LT(largestDifference(after, before), 1e-6) << options; // both have mean 0
    }
    // Codes of 16 bits: heights with what makes them heights again.
    const std::string path = folder / "h.png";
    const nlohmann::json json = jsonOf(relief({"height-map", normals("n.png"), "-o", path, "--json"}));
    Image stored = readImage(path);
    EXPECT_EQ(readImageInfo(path).sample, "uint16");
    for (float& texel : stored.texels)
        texel = float((texel - json.at("mid").get<double>()) * json.at("scale").get<double>());
    EXPECT_LT(largestDifference(stored, before), 2e-5);
    EXPECT_NEAR(json.at("scale"), 0.1, 0.01);
}

TEST_F(MapVerbs, knowWhichWayGreenPoints) {
    const Image up = readImage(normals("up.exr")), down = readImage(normals("down.exr", "--normal-y down"));
    for (std::size_t i = 1; i < up.texels.size(); i += 3) EXPECT_NEAR(up.texels[i] + down.texels[i], 1, 1e-6);
    expectDone(relief({"height-map", folder / "down.exr", "-o", folder / "wrong.exr", "-q"}));
    EXPECT_GT(largestDifference(readImage(folder / "wrong.exr"), readImage(heights)), 0.02);
}

TEST_F(MapVerbs, sayWhatCannotRepeat) {
    const std::string slope = flat("slope.exr", 0.6f, 0.5f, 0.98f, SampleType::real);
    const Outcome outcome = toHeights(slope);
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_TRUE(contains(outcome.err, "the mean slope (-0.208, 0) cannot repeat")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "--wrap clamp keeps it")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "not integrable: 100.00 %")) << outcome.err;
    const Outcome clamped = toHeights(slope, "--wrap clamp");
    EXPECT_FALSE(contains(clamped.err, "warning")) << clamped.err;
    EXPECT_FALSE(contains(clamped.err, "not integrable: 100.00 %")) << clamped.err;
}

/// The root mean square of the angle between the normals of two pictures, degrees.
double angleBetween(const std::string& one, const std::string& other) {
    const Image a = readImage(one), b = readImage(other);
    const std::vector<std::string> names = readImageInfo(one).channelNames;
    const auto normalAt = [&](const Image& image, int x, int y) {
        dvec3 n;
        for (int k = 0; k < 3; ++k) {
            const auto channel = std::ranges::find(names, std::string("N.") + "XYZ"[k]) - names.begin();
            n[k] = image.at(x, y)[channel];
        }
        return n;
    };
    double sum = 0, count = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const dvec3 u = normalAt(a, x, y), v = normalAt(b, x, y);
            if (glm::length(u) < 0.9 || glm::length(v) < 0.9) continue; // background
            sum += std::pow(glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v))), 2);
            ++count;
        }
    EXPECT_GT(count, 1000);
    return std::sqrt(sum / count);
}

TEST_F(MapVerbs, shadeAsBumpDoes) {
    writeImage(heights, waveImage(128, 128), SampleType::real);
    const std::string view = "--scale 4 --azimuth 20 --elevation 60 --layers normal --size 96,96 --rate 2 -q";
    const std::string plane = cagePath("plane"); // 2 by 2
    expectDone(relief({"render", plane, "--height", heights, "--detail", "bump", "-o", folder / "bump.exr"}, view));
    for (const std::string& bits : {std::string("8"), std::string("16")}) {
        const std::string map = normals("n.png", "--scale 4 --size 2,2 --bits " + bits);
        expectDone(relief({"render", plane, "--normal-map", map, "-o", folder / "n.exr"}, view));
        EXPECT_LT(angleBetween(folder / "bump.exr", folder / "n.exr"), 0.5) << bits;
    }
    expectDone(relief({"render", plane, "-o", folder / "flat.exr"}, view));
    EXPECT_GT(angleBetween(folder / "bump.exr", folder / "flat.exr"), 5) << "there is something to see";
}

// --- bad input ----------------------------------------------------------------------------------------------------

TEST_F(MapVerbs, refusePicturesThatHoldNoNormals) {
    for (const int channels : {1, 2}) {
        Image image{.width = 4, .height = 4, .channels = channels, .texels = {}};
        image.texels.resize(std::size_t(16 * channels), 0.5f);
        writeImage(folder / "few.exr", image, SampleType::real);
        expectRefused(toHeights(folder / "few.exr"), Failure::input,
                      {"few.exr", "3 channels", "this picture has " + std::to_string(channels)});
    }
    expectRefused(toHeights(flat("below.png", 0.5f, 0.5f, 0)), Failure::input,
                  {"below.png", "64 of 64 normals", "column 0, row 0"});
    putFile(folder / "text.png", "no picture");
    expectRefused(toHeights(folder / "text.png"), Failure::input, {"text.png", "not a picture"});
    expectRefused(toHeights(folder / "missing.png"), Failure::file, {"missing.png"});
    expectNothingWritten();
}

TEST_F(MapVerbs, countTexelsThatHoldNoNormal) {
    const Outcome outcome = toHeights(flat("black.png", 0, 0, 0));
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_TRUE(contains(outcome.err, "black.png: 64 of 64 texels hold no normal")) << outcome.err;
    EXPECT_EQ(jsonOf(toHeights(folder / "black.png", "-q --json")).at("empty_texels"), 64);
}

TEST_F(MapVerbs, readNumbersThatAreTaggedAsColorsAsTheyAre) {
    using namespace std::string_literals;
    std::string bytes = readFile(normals("plain.png", "--bits 8"));
    bytes.insert(33, "\0\0\0\1sRGB\0\xae\xce\x1c\xe9"s); // behind the header
    putFile(folder / "tagged.png", bytes);
    const nlohmann::json plain = jsonOf(toHeights(folder / "plain.png", "--json"));
    const Outcome outcome = toHeights(folder / "tagged.png", "--json");
    EXPECT_TRUE(contains(outcome.err, "tagged.png: the file says that its numbers are colors (sRGB)")) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("slope_rms"), plain.at("slope_rms"));
}

TEST_F(MapVerbs, ofEightAndSixteenBitsAgree) {
    const nlohmann::json few = jsonOf(toHeights(normals("8.png", "--bits 8"), "--json"));
    const nlohmann::json many = jsonOf(toHeights(normals("16.png"), "--json"));
    EXPECT_NEAR(few.at("highest"), many.at("highest"), 1e-3);
    EXPECT_GT(few.at("not_integrable_percent"), 0.1); // rounding
    EXPECT_LT(few.at("not_integrable_percent"), 5);
    EXPECT_LT(many.at("not_integrable_percent"), 0.02);
}

TEST_F(MapVerbs, refuseSizesBeforeTheyTakeMemory) {
    using namespace std::string_literals;
    // The header of a PNG says 30000 x 30000 texels of 3 channels of 16 bits, with the checksum of that.
    std::string bytes = readFile(normals("n.png"));
    bytes.replace(16, 8, "\0\0\x75\x30\0\0\x75\x30"s);
    std::uint32_t crc = ~0u;
    for (const char letter : bytes.substr(12, 17)) {
        crc ^= static_cast<unsigned char>(letter);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    for (int i = 0; i < 4; ++i) bytes[std::size_t(29 + i)] = char(~crc >> (24 - 8 * i));
    putFile(folder / "huge.png", bytes);
#ifdef __SANITIZE_ADDRESS__ // it takes terabytes of addresses
    const std::string limit;
#else
    const std::string limit = "ulimit -v 1500000; ";
#endif
    const Outcome outcome = shell(limit + "exec \"$RELIEF\" height-map $IN/huge.png -o $IN/out.exr", folder);
    expectRefused(outcome, Failure::input, {"huge.png", "decodes to 5.4 GB"});
    expectNothingWritten();
}

TEST_F(MapVerbs, refuseWordsThatMakeNoSense) {
    const std::string map = normals("n.png");
    const std::pair<Words, Words> cases[] = {
        {{"normal-map", heights, "-o", folder / "out.exr", "--bits", "8"}, {"out.exr", "--bits is for .png and .tif"}},
        {{"normal-map", heights, "-o", folder / "out.png", "--bits", "12"}, {"12"}},
        {{"normal-map", heights, "-o", folder / "out.jpg"}, {"out.jpg", "unknown kind of picture '.jpg'"}},
        {{"normal-map", heights, "-o", heights}, {"heights.exr", "would replace an input"}},
        {{"normal-map", heights, "-o", folder / "out.exr", "--size", "1,0"}, {"0"}},
        {{"normal-map", heights, "-o", folder / "out.exr", "--size", "1"}, {"--size"}},
        {{"normal-map", heights, "-o", folder / "out.exr", "--wrap", "mirror"}, {"mirror", "repeat, clamp"}},
        {{"normal-map", heights}, {"--output"}},
        {{"height-map", map, "-o", map}, {"n.png", "would replace an input"}},
        {{"height-map", map, "-o", folder / "out.exr", "--normal-space", "object"}, {"n.png", "tangent space"}},
        {{"height-map", map, "-o", folder / "out.exr", "--normal-y", "left"}, {"left", "up, down"}},
    };
    for (const auto& [words, parts] : cases) expectRefused(relief(words), Failure::usage, parts);
    expectNothingWritten();
    expectRefused(relief({"normal-map", heights, "-o", folder / "none/n.png"}), Failure::file, {"none"});
}

TEST_F(MapVerbs, takeOneChannelOfSeveral) {
    Image two{.width = 8, .height = 8, .channels = 2, .texels = {}};
    for (int i = 0; i < 64; ++i) two.texels.insert(two.texels.end(), {0, float(i % 8) / 8});
    writeImage(folder / "two.exr", two, {{"flat"}, {"ramp"}});
    const Words words{"normal-map", folder / "two.exr", "-o", folder / "n.exr", "--json", "--channel"};
    const auto steepest = [&](const char* channel) {
        Words all = words;
        all.emplace_back(channel);
        return jsonOf(relief(all)).at("steepest_degrees").get<double>();
    };
    EXPECT_EQ(steepest("flat"), 0);
    EXPECT_GT(steepest("ramp"), 40);
    EXPECT_EQ(steepest("0"), 0);
}

} // namespace
} // namespace relief::test
