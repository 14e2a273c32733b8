// --layer, --map-repeat and --map-offset from the command line.
#include "program.h"

namespace relief::test {
namespace {

struct LayerOption : testing::Test {
    TemporaryFolder folder;
    const std::string torus = cagePath("torus");

    /// A map of one channel of steps that floats hold exactly, and so does their sum.
    [[nodiscard]] std::string write(const std::string& name, int seed, int channels = 1, int side = 16) const {
        Image image{.width = side, .height = side, .channels = channels, .texels = {}};
        for (int i = 0; i < side * side * channels; ++i) image.texels.push_back(float((i * 37 + seed * 11) % 32) / 256);
        writeImage(folder / name, image, SampleType::real);
        return folder / name;
    }
    [[nodiscard]] std::string sumOf(const std::string& name, std::initializer_list<std::string> files) const {
        Image sum;
        for (const std::string& file : files) {
            const Image image = readImage(file);
            if (sum.texels.empty())
                sum = image;
            else
                for (std::size_t i = 0; i < sum.texels.size(); ++i) sum.texels[i] += image.texels[i];
        }
        writeImage(folder / name, sum, SampleType::real);
        return folder / name;
    }
    /// The texels of a small picture.
    [[nodiscard]] std::vector<float> picture(const Words& words) const {
        Words all{"render", "-o", folder / "p.png", "-q", "--path", "grid", "--rate", "6", "--size", "64,64"};
        all.insert(all.end(), words.begin(), words.end());
        expectDone(relief(all));
        return readImage(folder / "p.png").texels;
    }
};

TEST_F(LayerOption, addsMaps) {
    const std::string a = write("a.exr", 1), b = write("b.exr", 2), c = write("c.exr", 3);
    const std::string sum = sumOf("sum.exr", {a, b, c});
    EXPECT_EQ(picture({torus, "--height", a, "--layer", b, "--layer", c + ",scale=1"}),
              picture({torus, "--height", sum}));
    EXPECT_NE(picture({torus, "--height", a, "--layer", b}), picture({torus, "--height", sum}));
    // Heights and vectors, a mask and a repeat of its own: watertight and exact as any map.
    const std::string vectors = write("v.exr", 4, 3), mask = write("mask.exr", 5);
    const nlohmann::json json =
        jsonOf(relief({"check", torus, "--height", a, "--layer", vectors + ",vector=tangent,preset=mudbox", "--layer",
                       b + ",repeat=2:3,offset=0.25:0,mask=" + mask, "--json"},
                      "--rate 3 --points 2000 --path dice"));
    EXPECT_GT(json.at("displacement_bound").get<double>(), 0.12);
}

// A map per face, a set of tiles, a map that repeats, a mask: each is looked up in its own way.
TEST_F(LayerOption, addsMapsOfAllKinds) {
    const std::string a = write("a.exr", 1), b = write("b.exr", 2), set = folder / "t.<UDIM>.exr";
    (void)write("t.1001.exr", 3), (void)write("v.1001.exr", 4, 3);
    expectDone(relief({"map", torus, a, "-o", folder / "faces.exr", "-q"}));
    const Words layers{"--layer", set, "--layer", b + ",repeat=2:3,mask=" + a};
    Words words{"check", torus, "--height", folder / "faces.exr", "--json"},
        others{"check", torus, "--height", a, "--json"};
    words.insert(words.end(), layers.begin(), layers.end()), others.insert(others.end(), layers.begin(), layers.end());
    const std::string more = "--rate 3 --points 2000 --path dice";
    const double perFace = jsonOf(relief(words, more)).at("displacement_bound").get<double>();
    const double perTexel = jsonOf(relief(others, more)).at("displacement_bound").get<double>();
    EXPECT_NEAR(perFace, perTexel, 0.2 * perTexel);
    // Vectors over tiles, with heights.
    const nlohmann::json json = jsonOf(
        relief({"check", torus, "--vector", folder / "v.<UDIM>.exr", "--layer", set, "--layer", a, "--json"}, more));
    EXPECT_GT(json.at("displacement_bound").get<double>(), 0.12);
}

TEST_F(LayerOption, placesAllMapsAtOnce) {
    // The same as texture coordinates that are written so.
    std::string text = readFile(torus), moved;
    for (std::istringstream lines(text); std::getline(lines, text);) {
        double s = 0, t = 0;
        if (std::sscanf(text.c_str(), "vt %lf %lf", &s, &t) == 2)
            text = fmt::format("vt {:.17g} {:.17g}", 2 * double(float(s)) + 0.25, 3 * double(float(t)) - 0.5);
        moved += text + "\n";
    }
    putFile(folder / "moved.obj", moved);
    const Words maps{"--height", write("h.exr", 1), "--albedo", write("c.exr", 2, 3), "--detail", "both"};
    Words given{folder / "moved.obj"}, placed{torus, "--map-repeat", "2,3", "--map-offset", "0.25,-0.5"};
    given.insert(given.end(), maps.begin(), maps.end()), placed.insert(placed.end(), maps.begin(), maps.end());
    EXPECT_EQ(picture(placed), picture(given));
}

TEST_F(LayerOption, refusesWhatMakesNoSense) {
    const std::string a = write("a.exr", 1), set = write("t.1001.exr", 1), out = folder / "out.png";
    const auto refused = [&](const Words& more, Failure failure, const Words& parts) {
        Words words{"render", torus, "-o", out, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        expectRefused(relief(words), failure, parts);
    };
    refused({"--layer", a}, Failure::usage, {"a.exr", "--height or --vector"});
    refused({"--height", a, "--layer", a + ",scael=2"}, Failure::usage, {"scael"});
    refused({"--height", a, "--layer", a + ",scale=x"}, Failure::usage, {"scale=x"});
    refused({"--height", a, "--layer", a + ",repeat=0"}, Failure::usage, {"repeat="});
    refused({"--height", a, "--layer", a + ",order=xzy"}, Failure::usage, {"vector="});
    refused({"--height", a, "--layer", a + ",vector=object"}, Failure::input, {"a.exr", "3 channels"});
    refused({"--height", a, "--layer", folder / "none.exr"}, Failure::file, {"none.exr"});
    refused({"--height", a, "--map-repeat", "0,1"}, Failure::usage, {"--map-repeat"});
    refused({"--height", folder / "t.<UDIM>.exr", "--map-repeat", "2,2"}, Failure::usage, {"<UDIM>", "--map-repeat"});
    refused({"--vector", folder / "t.<UDIM>.exr"}, Failure::input, {"t.1001.exr", "3 channels"});
    refused({"--height", a, "--uv-set", "1"}, Failure::usage, {"--uv-set", ".obj"});
    refused({"--environment", folder / "t.<UDIM>.exr"}, Failure::usage, {"<UDIM>", "one tile"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace relief::test
