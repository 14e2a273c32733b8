// relief bake: sculpts of all kinds of files, maps that are checked again, and what is refused.
#include "meshes.h"
#include "program.h"

namespace relief::test {
namespace {

double noise(double s, double t) {
    double sum = 0;
    for (int k = 1; k <= 3; ++k)
        sum += std::sin(6.2831853 * (3 * k * s + 2 * t) + k) * std::cos(6.2831853 * (4 * k * t - s) + 2 * k) / k;
    return 0.03 * sum;
}

/// A torus, its sculpt exported with a map of noise, and small maps of it.
struct Bake : testing::Test {
    static constexpr int kSide = 128;
    TemporaryFolder folder;
    std::string cage = cagePath("torus"), sculpt = folder / "sculpt.ply", map = folder / "map.exr";

    Outcome bake(const Words& words, const std::string& more = "--size 128,128 -q") {
        Words all{"bake"};
        all.insert(all.end(), words.begin(), words.end());
        return relief(all, more);
    }
    void exportSculpt(int rate) {
        Image heights{kSide, kSide, 1, {}};
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                heights.texels.push_back(float(noise((x + 0.5) / kSide, 1 - (y + 0.5) / kSide)));
        writeImage(folder / "noise.exr", heights, SampleType::real);
        expectDone(relief({"export", cage, "--height", folder / "noise.exr", "-o", sculpt, "-q"},
                          fmt::format("--rate {}", rate)));
    }
    /// RMS of the heights' difference from the noise, and of the steps between neighbouring texels of the noise.
    dvec2 differences(const std::string& path, double mid = 0, double scale = 1) {
        const Image baked = readImage(path), own = readImage(folder / "noise.exr");
        dvec2 sums(0);
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const double h = scale * (double(*baked.at(x, y)) - mid), truth = double(*own.at(x, y));
                const double step = truth - double(*own.at((x + 1) % kSide, y));
                sums += dvec2((h - truth) * (h - truth), step * step);
            }
        return glm::sqrt(sums / double(kSide * kSide));
    }
};

TEST_F(Bake, comesBackWithinHalfAStepOfATexel) {
    exportSculpt(40);
    const Outcome outcome = bake({cage, sculpt, "-o", map, "--json"}, "--size 128,128 --samples 1");
    const nlohmann::json report = jsonOf(outcome);
    const dvec2 rms = differences(map);
    EXPECT_LT(rms.x, 0.5 * rms.y);
    EXPECT_LT(rms.x, 0.002);
    EXPECT_EQ(report["voids"], 0);
    EXPECT_EQ(report["texels"], kSide * kSide);
    EXPECT_LT(report["surface_to_sculpt"]["rms_percent"], 0.05);

    // Integers say how they are to be read, and are the same map.
    const nlohmann::json codes = jsonOf(bake({cage, sculpt, "-o", folder / "map.png", "--json", "--normal",
                                              folder / "n.png", "--curvature", folder / "c.exr"},
                                             "--size 128,128"));
    EXPECT_LT(differences(folder / "map.png", codes["mid"], codes["scale"]).x, 0.5 * rms.y);
    const nlohmann::json again =
        jsonOf(bake({cage, sculpt, "--check", "--height", folder / "map.png", "--json"},
                    fmt::format("--mid {} --scale {}", double(codes["mid"]), double(codes["scale"]))));
    EXPECT_NEAR(again["rms"], double(codes["rms"]), 1e-8);
    EXPECT_NEAR(again["seam_gap"], double(codes["seam_gap"]), 1e-8);

    // Normals look out of the surface, and are as steep as the heights.
    const Image normals = readImage(folder / "n.png"), curvature = readImage(folder / "c.exr");
    ASSERT_EQ(normals.channels, 3);
    ASSERT_EQ(curvature.channels, 1);
    for (int i = 0; i < kSide; ++i) {
        const float* n = normals.at(i, i);
        EXPECT_NEAR(glm::length(2.0f * vec3(n[0], n[1], n[2]) - 1.0f), 1, 1e-4);
        EXPECT_GT(n[2], 0.6f);
    }

    // The map is there, whatever the certificate says of it.
    std::filesystem::remove(map);
    expectRefused(bake({cage, sculpt, "-o", map}, "--size 32,32 -q --tolerance 0"), Failure::check,
                  {"map.exr", "apart"});
    EXPECT_TRUE(std::filesystem::exists(map));
}

TEST_F(Bake, refusesWhatCannotBeBaked) {
    exportSculpt(4);
    const std::string bytes = readFile(sculpt);
    putFile(folder / "cut.ply", bytes.substr(0, bytes.size() / 2));
    putFile(folder / "bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    putFile(folder / "far.obj", "v 90 0 0\nv 91 0 0\nv 91 1 0\nf 1 2 3\n");
    putFile(map, "an old map");
    const auto expect = [&](const Words& words, Failure failure, const Words& parts) {
        expectRefused(bake(words), failure, parts);
        EXPECT_EQ(readFile(map), "an old map");
    };
    expect({cage, folder / "cut.ply", "-o", map}, Failure::input, {"cut.ply", "bytes are left"});
    expect({cage, folder / "far.obj", "-o", map}, Failure::input, {"far.obj", "none of", "the cage's box is"});
    expect({folder / "bare.obj", sculpt, "-o", map}, Failure::input, {"bare.obj", "no texture coordinates to bake"});
    expect({cage, sculpt}, Failure::usage, {"-o"});
    expect({cage, sculpt, "--check"}, Failure::usage, {"--height"});
    expect({cage, sculpt, "-o", folder / "h.png", "--format", "half"}, Failure::usage, {"h.png", ".png holds no half"});
    expect({cage, sculpt, "-o", map, "--position", folder / "p.png"}, Failure::usage, {"p.png", "as .exr or .tif"});
    expect({cage, sculpt, "-o", map, "--max-distance", "-1"}, Failure::usage, {"--max-distance"});
    const Outcome full = shell("ulimit -f 8; exec \"$RELIEF\" bake " + cage +
                                   " $IN/sculpt.ply -o $IN/map.exr -q "
                                   "--size 256,256",
                               folder);
    expectRefused(full, Failure::file, {"map.exr", "cannot be written"});
    EXPECT_EQ(readFile(map), "an old map");
}

TEST_F(Bake, endsAtAnInterruptWithoutAMap) {
    exportSculpt(4);
    Program program({"bake", cage, sculpt, "-o", map, "--size", "8192,8192", "--progress", "always"});
    while (!contains(program.errorsSoFar(), "baking")) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait().exitCode, 130);
    EXPECT_FALSE(std::filesystem::exists(map));
}

} // namespace
} // namespace relief::test
