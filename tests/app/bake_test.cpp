// relief bake: sculpts of all kinds of files, maps that are checked again, and what is refused.
#include "bake/bake.h"
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
    // Read in another way there is a word about it, as of a TIFF.
    const auto hasWarning = [&](const std::string& path, const std::string& more) {
        const Outcome outcome = relief({"export", cage, "--height", path, "-o", folder / "x.ply"}, "--rate 1 " + more);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return contains(outcome.err, "was baked for --mid");
    };
    EXPECT_TRUE(hasWarning(folder / "map.png", ""));
    EXPECT_FALSE(hasWarning(folder / "map.png",
                            fmt::format("--mid {:.9g} --scale {:.9g}", double(codes["mid"]), double(codes["scale"]))));
    expectDone(bake({cage, sculpt, "-o", folder / "map.tif"}, "--size 32,32 -q --tolerance 50%"));
    EXPECT_FALSE(hasWarning(folder / "map.tif", ""));
    EXPECT_TRUE(hasWarning(folder / "map.tif", "--scale 2"));
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

// With --smooth-cage lines begin above the sculpt even where that lies nowhere above the surface.
TEST_F(Bake, findsASculptThatIsTheSurface) {
    const std::string cube = cagePath("cube"), same = folder / "same.ply";
    expectDone(relief({"export", cube, "-o", same, "-q"}, "--rate 16"));
    const nlohmann::json report =
        jsonOf(bake({cube, same, "-o", folder / "same.exr", "--smooth-cage", "--json"}, "--size 64,64"));
    EXPECT_EQ(report["voids"], 0);
    EXPECT_LT(report["surface_to_sculpt"]["rms_percent"], 0.05);
}

TEST_F(Bake, needsNoTextureCoordinatesPerFace) {
    exportSculpt(16);
    std::string bare;
    std::istringstream lines(readFile(cage));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("vt ")) continue;
        for (std::size_t at = line.find('/'); line.starts_with("f ") && at != std::string::npos; at = line.find('/'))
            line.erase(at, std::min(line.find(' ', at), line.size()) - at);
        bare += line + "\n";
    }
    putFile(folder / "bare.obj", bare);
    const nlohmann::json report =
        jsonOf(bake({folder / "bare.obj", sculpt, "-o", map, "--per-face", "--json"}, "--size 128,128"));
    EXPECT_EQ(report["kind"], "faces");
    EXPECT_EQ(report["tiles"], 128);
    EXPECT_EQ(report["voids"], 0);
    EXPECT_LT(report["surface_to_sculpt"]["rms_percent"], 0.05);
    EXPECT_LT(report["sculpt_to_surface"]["rms_percent"], 0.05);
    const nlohmann::json again =
        jsonOf(bake({folder / "bare.obj", sculpt, "--check", "--height", map, "--smooth-cage", "--json"}, ""));
    EXPECT_NEAR(again["rms"], double(report["rms"]), 1e-8);
    // Halves, and a mask of voids, which are maps per face as well. A sculpt of every other face leaves voids.
    std::string half;
    std::istringstream cageLines(readFile(folder / "bare.obj"));
    int faceCount = 0;
    for (std::string line; std::getline(cageLines, line);)
        if (!line.starts_with("f ") || faceCount++ % 2 == 0) half += line + "\n";
    putFile(folder / "half.obj", half);
    const nlohmann::json holes = jsonOf(bake({folder / "bare.obj", folder / "half.obj", "-o", folder / "h.exr",
                                              "--per-face", "--format", "half", "--voids", folder / "v.exr", "--json"},
                                             "--face-size 4 --tolerance 50%"));
    EXPECT_GT(holes["voids"], 0);
    EXPECT_EQ(readImageInfo(folder / "h.exr").sample, "half");
    EXPECT_EQ(readImageInfo(folder / "v.exr").attributes.at("relief:faces"),
              readImageInfo(folder / "h.exr").attributes.at("relief:faces"));
    const Image mask = readImage(folder / "v.exr");
    EXPECT_GT(std::ranges::count(mask.texels, 1.0f), 0);
    EXPECT_EQ(std::ranges::count(mask.texels, 1.0f) + std::ranges::count(mask.texels, 0.0f),
              std::ptrdiff_t(mask.texels.size()));
    // The surface stays closed, and the map says which cage it is for.
    expectDone(relief({"export", folder / "bare.obj", "--height", map, "-o", folder / "closed.ply", "-q"}, "--rate 8"));
    TriangleMesh mesh = readTriangles(folder / "closed.ply");
    EXPECT_EQ(windAlike(mesh).boundaryCount, 0u);
    expectRefused(relief({"render", cagePath("cube"), "--height", map, "-o", folder / "p.png"}), Failure::input,
                  {"another cage"});
}

TEST_F(Bake, writesTheTilesThatFacesLieIn) {
    exportSculpt(16);
    std::string wide;
    std::istringstream lines(readFile(cage));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("vt ")) {
            std::istringstream numbers(line.substr(3));
            dvec2 st;
            numbers >> st.x >> st.y;
            line = fmt::format("vt {} {}", 2 * st.x, st.y);
        }
        wide += line + "\n";
    }
    putFile(folder / "wide.obj", wide);
    const std::string set = folder / "m.<UDIM>.exr", first = folder / "m.1001.exr";
    const nlohmann::json report = jsonOf(
        bake({folder / "wide.obj", sculpt, "-o", set, "--voids", folder / "v.<UDIM>.png", "--json"}, "--size 64,128"));
    EXPECT_EQ(report["tiles"], 2);
    EXPECT_EQ(report["texels"], kSide * kSide);
    EXPECT_LT(report["surface_to_sculpt"]["rms_percent"], 0.05);
    for (const char* name : {"m.1001.exr", "m.1002.exr", "v.1001.png", "v.1002.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "m.1003.exr"));

    // A map that is read in another way than it was baked for is drawn, with a word about it.
    const auto warningsOf = [&](const Words& words) {
        Words all{"export"};
        all.insert(all.end(), words.begin(), words.end());
        const Outcome outcome = relief(all, "--rate 1 -o " + (folder / "x.ply"));
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return outcome.err;
    };
    EXPECT_FALSE(contains(warningsOf({folder / "wide.obj", "--height", set}), "was baked"));
    EXPECT_TRUE(contains(warningsOf({cagePath("plane"), "--height", first}), "was baked over another cage"));
    EXPECT_TRUE(contains(warningsOf({cage, "--height", first, "--scale", "2"}),
                         "for --mid 0 --scale 1; it is read with --mid 0 --scale 2"));

    // A full disk leaves all tiles as they were, also where it holds all files but the last: masks are small.
    const std::string before = readFile(first), voids = folder / "v.1001.png";
    putFile(voids, "an old mask");
    const Outcome full = shell("ulimit -f 8; exec \"$RELIEF\" bake $IN/wide.obj $IN/sculpt.ply -o '" + set +
                                   "' --voids $IN/'v.<UDIM>.png' -q --size 128,128",
                               folder);
    expectRefused(full, Failure::file, {"m.1001.exr", "cannot be written"});
    EXPECT_EQ(readFile(first), before);
    EXPECT_EQ(readFile(voids), "an old mask");
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
    expect({folder / "bare.obj", sculpt, "-o", map}, Failure::input,
           {"bare.obj", "no texture coordinates to bake", "--per-face"});
    expect({cage, sculpt}, Failure::usage, {"-o"});
    expect({cage, sculpt, "--check"}, Failure::usage, {"--height"});
    expect({cage, sculpt, "-o", folder / "h.png", "--format", "half"}, Failure::usage, {"h.png", ".png holds no half"});
    expect({cage, sculpt, "-o", map, "--position", folder / "p.png"}, Failure::usage, {"p.png", "as .exr or .tif"});
    expect({cage, sculpt, "-o", map, "--max-distance", "-1"}, Failure::usage, {"--max-distance"});
    const Words perFace{cage, sculpt, "-o", map, "--per-face"};
    const auto expectPerFace = [&](const Words& more, const Words& parts) {
        Words words = perFace;
        words.insert(words.end(), more.begin(), more.end());
        expect(words, Failure::usage, parts);
    };
    expectPerFace({"--face-size", "3"}, {"--face-size 3", "1, 2, 4"});
    expectPerFace({"--voids", folder / "v.png"}, {"v.png", "one .exr of floats or halves"});
    expectPerFace({"--normal", folder / "n.png"}, {"n.png", "heights and --voids alone"});
    expectPerFace({"--format", "unorm16"}, {".exr holds no unorm16"});
    putFile(folder / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    expect({folder / "tri.obj", sculpt, "-o", map, "--per-face", "--scheme", "loop"}, Failure::usage,
           {"faces need four sides"});
    expect({cage, sculpt, "-o", map, "--face-size", "4"}, Failure::usage, {"--face-size is for maps with --per-face"});
    expect({cage, sculpt, "-o", map, "--voids", folder / "v.<UDIM>.png"}, Failure::usage, {"v.<UDIM>.png", "none is"});
    expect({cage, sculpt, "-o", map, "--cage", cagePath("cube")}, Failure::input, {"cube.obj", "are not those of"});
    putFile(folder / "point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
    expect({cage, folder / "point.obj", "-o", map}, Failure::input, {"point.obj", "has an area"});
    const Outcome fullPerFace = shell("ulimit -f 8; exec \"$RELIEF\" bake " + cage +
                                          " $IN/sculpt.ply -o $IN/map.exr -q --per-face --size 256,256",
                                      folder);
    expectRefused(fullPerFace, Failure::file, {"map.exr", "cannot be written"});
    EXPECT_EQ(readFile(map), "an old map");
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
