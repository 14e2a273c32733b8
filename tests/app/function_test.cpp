// --height-function on the command line.
#include "program.h"

namespace relief::test {
namespace {

class FunctionOption : public ::testing::Test {
protected:
    void SetUp() override { setenv("RELIEF_CACHE", (folder_ / "cache").c_str(), 1); }
    void TearDown() override { unsetenv("RELIEF_CACHE"); }

    /// A file with this function.
    std::string file(const std::string& text) {
        const std::string path = folder_ / fmt::format("f{}.glsl", count_++);
        putFile(path, text);
        return path;
    }
    std::string fileOf(const std::string& expression) {
        return file("float height(vec3 p, vec2 st, float t) { return " + expression + "; }\n");
    }
    [[nodiscard]] std::string target(const std::string& name = "x.png") const { return folder_ / name; }

    Outcome render(const std::string& function, const std::string& more = "", const std::string& cage = "torus") {
        return relief({"render", cagePath(cage), "--height-function", function, "-o", target()},
                      "-q --rate 8 --size 64,64 " + more);
    }

    void expectNothingWritten() const { EXPECT_FALSE(std::filesystem::exists(target())); }

    TemporaryFolder folder_;
    int count_ = 0;
};

double meanDifference(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) sum += std::abs(a.texels[i] - b.texels[i]);
    return sum / double(a.texels.size());
}

// --- what it draws

TEST_F(FunctionOption, drawsWhatAMapOfTheSameFormulaDraws) {
    writeImage(target("map.exr"), sineImage(512, 3), SampleType::real);
    const std::string formula = "sin(18.84955592 * st.x) * cos(18.84955592 * (1.0 - st.y))";
    const std::string look = "-q --scale 0.1 --rate 16 --size 96,96 --look-at 0,0,0 --distance 5";
    expectDone(relief({"render", cagePath("torus"), "--height", target("map.exr"), "-o", target("map.png")}, look));
    expectDone(relief({"render", cagePath("torus"), "-o", target("flat.png")}, look));
    for (const char* path : {"tessellation", "grid", "dice"}) {
        expectDone(relief({"render", cagePath("torus"), "--height-function", fileOf(formula), "--height-bound", "1",
                           "--path", path, "--mid", "0", "-o", target("function.png")},
                          look));
        const Image map = readImage(target("map.png")), function = readImage(target("function.png"));
        EXPECT_LT(meanDifference(map, function), 0.001) << path;
        EXPECT_GT(meanDifference(function, readImage(target("flat.png"))), 0.02) << path;
    }
}

TEST_F(FunctionOption, hasFunctionsThatAreBuiltIn) {
    expectDone(render("golf"));
    const Image golf = readImage(target());
    for (const char* name : {"waves", "fractal"}) {
        expectDone(render(name));
        EXPECT_GT(meanDifference(golf, readImage(target())), 0.005) << name;
    }
    EXPECT_TRUE(contains(relief({"render", "--help"}).out, "fractal, golf, waves"));
}

TEST_F(FunctionOption, isAnimatedByTheTimeOfFrames) {
    const Words words{"animate", cagePath("plane"), "--height-function", "waves", "-o", target("w.{frame:4}.png")};
    expectDone(relief(words, "-q --rate 8 --size 48,48 --fps 10 --frames 0:4x2"));
    const std::string first = readFile(target("w.0000.png")), last = readFile(target("w.0004.png"));
    EXPECT_NE(first, last);
    EXPECT_NE(readFile(target("w.0002.png")), last);
    // Whatever is drawn with it.
    expectDone(relief(words, "-q --rate 8 --size 48,48 --fps 10 --frames 4"));
    EXPECT_EQ(readFile(target("w.0004.png")), last);
    expectRefused(relief(words, "-q"), Failure::usage, {"nothing moves", "--frames of the height function"});
}

TEST_F(FunctionOption, isGivenTheTimeAndThePointAtRest) {
    putFile(target("points.csv"), "3,0.25,0.75\n10,0.5,0.5\n");
    const auto heights = [&](const std::string& more) {
        expectDone(relief({"sample", cagePath("torus"), "--height-function", fileOf("p.x + 10.0 * t"), "--at",
                           target("points.csv"), "-o", target("out.csv")},
                          "-q --height-bound 100 " + more));
        std::istringstream rows(readFile(target("out.csv")));
        std::vector<double> found;
        std::string row;
        for (std::getline(rows, row); std::getline(rows, row);) {
            std::istringstream fields(row);
            std::string field;
            for (int i = 0; i <= 15; ++i) std::getline(fields, field, ',');
            found.push_back(std::stod(field));
        }
        EXPECT_EQ(found.size(), 2u);
        return found;
    };
    const std::vector<double> still = heights(""), later = heights("--time 2"),
                              moved = heights("--time 2 --deform twist(axis=y,angle=90*t)");
    for (std::size_t i = 0; i < still.size(); ++i) {
        EXPECT_NEAR(later[i], still[i] + 20, 1e-5);
        EXPECT_NEAR(moved[i], still[i] + 20, 1e-5) << "p is the point at rest";
    }
}

TEST_F(FunctionOption, passesTheCertificate) {
    const auto json = jsonOf(relief({"check", cagePath("torus"), "--height-function", "golf"},
                                    "-q --json --rate 6 --points 5000 --time 0.5 --deform twist(axis=y,angle=40*t)"));
    EXPECT_EQ(json["broken_promises"].size(), 0u);
    EXPECT_EQ(json["height"], "golf");
    EXPECT_NEAR(json["displacement_bound"].get<double>(), 0.03, 1e-6);
    EXPECT_EQ(json["paths"].size(), 3u);
    for (const auto& path : json["paths"]) EXPECT_TRUE(path["watertight"]);
    EXPECT_EQ(json["frames"]["regular"]["misplaced_points"], 0);
    EXPECT_EQ(json["seams"]["disagreement_max"].get<double>(), 0.0);
}

TEST_F(FunctionOption, movesWhatIsExported) {
    const std::string mesh = target("mesh.ply");
    expectDone(relief({"export", cagePath("cube"), "--height-function", "fractal", "-o", mesh}, "-q --rate 4"));
    const std::string displaced = readFile(mesh);
    expectDone(relief({"export", cagePath("cube"), "-o", mesh}, "-q --rate 4"));
    EXPECT_NE(readFile(mesh), displaced);
}

// --- bump

TEST_F(FunctionOption, bendsNormalsWhereTheSurfaceStays) {
    const auto draw = [&](const std::string& more) {
        const std::string picture = target("bump.exr");
        expectDone(relief({"render", cagePath("torus"), "--height-function", "golf", "-o", picture},
                          "-q --size 128,128 --distance 5 --look-at 0,0,0 --no-shadows --show normal " + more));
        return readImage(picture);
    };
    const Image flat = draw("--detail none --rate 32"), moved = draw("--scale 0.1 --rate 64 --path grid");
    for (const char* path : {"tessellation", "grid", "dice"}) {
        const Image bump = draw(std::string("--detail bump --scale 0.1 --rate 32 --path ") + path);
        EXPECT_LT(meanDifference(bump, moved), 0.4 * meanDifference(flat, moved)) << path;
        // As high as it may be, the outline stays.
        const Image high = draw(std::string("--detail bump --scale 3 --rate 32 --path ") + path);
        for (std::size_t i = 3; i < flat.texels.size(); i += 4) ASSERT_EQ(high.texels[i], flat.texels[i]) << path;
        EXPECT_GT(meanDifference(high, flat), 3 * meanDifference(bump, flat)) << path;
    }
}

// --detail both shades what the triangles cannot follow, on a cage that moves and on one that stands.
TEST_F(FunctionOption, bendsNormalsOfWhatMoves) {
    const auto draw = [&](const std::string& more) {
        const std::string picture = target("moved.exr");
        expectDone(relief({"render", cagePath("torus"), "--height-function", "golf", "-o", picture},
                          "-q --size 128,128 --distance 5 --look-at 0,0,0 --no-shadows --show normal "
                          "--deform twist(axis=y,angle=60) " +
                              more));
        return readImage(picture);
    };
    const Image fine = draw("--rate 128 --path grid"), coarse = draw("--rate 8 --path grid");
    const Image both = draw("--detail both --rate 8 --path grid");
    EXPECT_LT(meanDifference(both, fine), 0.6 * meanDifference(coarse, fine));
    // Bump keeps the outline of the cage's pose.
    const Image bump = draw("--detail bump --rate 16"), none = draw("--detail none --rate 16");
    for (std::size_t i = 3; i < none.texels.size(); i += 4) ASSERT_EQ(bump.texels[i], none.texels[i]);
    EXPECT_GT(meanDifference(bump, none), 0.01);
}

TEST_F(FunctionOption, bendsNormalsOfPlainTriangles) {
    const std::string mesh = target("mesh.obj");
    expectDone(relief({"export", cagePath("torus"), "-o", mesh}, "-q --rate 16"));
    const auto draw = [&](const std::string& object, const std::string& more) {
        const std::string picture = target("mesh.exr");
        expectDone(relief({"render", object, "--height-function", "golf", "-o", picture},
                          "-q --size 128,128 --distance 5 --look-at 0,0,0 --no-shadows --show normal " + more));
        return readImage(picture);
    };
    const Image cage = draw(cagePath("torus"), "--detail bump --rate 16"), none = draw(mesh, "--detail none");
    EXPECT_LT(meanDifference(draw(mesh, "--detail bump"), cage), 0.1 * meanDifference(none, cage));
    // What moves the triangles takes the dimples along.
    expectDone(
        relief({"animate", mesh, "--height-function", "golf", "-o", target("m.{frame:4}.exr")},
               "-q --size 128,128 --distance 5 --look-at 0,0,0 --no-shadows --show normal --detail bump --frames 0:1 "
               "--fps 1 --deform twist(axis=y,angle=20*t)"));
    EXPECT_LT(meanDifference(readImage(target("m.0000.exr")), cage), 0.1 * meanDifference(none, cage));
    const Image posed = draw(mesh, "--detail bump --deform twist(axis=y,angle=20)");
    EXPECT_LT(meanDifference(readImage(target("m.0001.exr")), posed), 1e-4);
    expectRefused(relief({"render", mesh, "--height-function", "golf", "-o", target()}), Failure::usage,
                  {"--detail bump"});
}

TEST_F(FunctionOption, isReportedByInfoAndRefusedByBench) {
    const auto report = jsonOf(relief({"info", cagePath("torus"), "--height-function", "golf"}, "--json"))[0];
    EXPECT_EQ(report["height_function"], "golf");
    EXPECT_NEAR(report["displacement_bound"].get<double>(), 0.03, 1e-6);
    EXPECT_EQ(report["seam_disagreement_max"].get<double>(), 0);
    expectRefused(relief({"bench", "frame", "--height-function", "golf"}), Failure::usage, {"--height-function golf"});
    expectRefused(render("gulf"), Failure::file, {"gulf", "fractal, golf, waves"});
}

// --- bounds

TEST_F(FunctionOption, withoutABoundIsMeasuredAndSaysSo) {
    const std::string function = fileOf("0.2 * sin(7.0 * p.x)");
    const Outcome outcome =
        relief({"render", cagePath("torus"), "--height-function", function, "-o", target()}, "--rate 4 --size 32,32");
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_TRUE(contains(outcome.err, "states no kBound")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "0.2,") && contains(outcome.err, "0.25")) << outcome.err;
    const Outcome stated = relief({"render", cagePath("torus"), "--height-function", function, "-o", target()},
                                  "--rate 4 --size 32,32 --height-bound 0.2");
    EXPECT_FALSE(contains(stated.err, "kBound")) << stated.err;
}

TEST_F(FunctionOption, thatPassesItsBoundIsRefusedWithTheFace) {
    expectRefused(render(file("const float kBound = 0.01;\n"
                              "float height(vec3 p, vec2 st, float t) { return p.x; }\n")),
                  Failure::input, {"at face ", "(u,v) = (", "more than its bound 0.01"});
    expectNothingWritten();
    expectRefused(render(fileOf("p.x"), "--height-bound 0.5"), Failure::input, {"at face ", "more than its bound 0.5"});
    expectRefused(render(file("const float kBound = -1.0;\n"
                              "float height(vec3 p, vec2 st, float t) { return 0.0; }\n")),
                  Failure::input, {"kBound is -1"});
}

TEST_F(FunctionOption, thatIsNoNumberIsRefusedWithTheFace) {
    expectRefused(render(fileOf("sqrt(p.x - 0.3)")), Failure::input, {"height is nan at face ", "(u,v) = ("});
    expectRefused(render(fileOf("1.0 / (p.x - p.x)")), Failure::input, {"at face ", "(u,v) = ("});
    expectNothingWritten();
    // Of a later frame alone.
    expectRefused(relief({"animate", cagePath("torus"), "--height-function", fileOf("0.01 * sqrt(0.15 - t)"), "-o",
                          target("f.{frame:4}.png")},
                         "-q --rate 2 --size 16,16 --fps 10 --frames 0:3"),
                  Failure::input, {"height is nan at face ", "t = 0.2 s"});
}

// --- mistakes

TEST_F(FunctionOption, withASyntaxErrorIsOneLineWithItsOwn) {
    const std::string path = file("// a comment\nfloat height(vec3 p, vec2 st, float t) {\n    return q.x;\n}\n");
    expectRefused(render(path), Failure::input, {path + ":3: 'q' : undeclared identifier"});
    expectRefused(render(file("float elevation(vec3 p) { return p.x; }")), Failure::input,
                  {"there is no function float height(vec3 p, vec2 st, float t)"});
    expectRefused(render(file(std::string(10'000'000, ' '))), Failure::input, {"longer than"});
    expectRefused(render(target("none.glsl")), Failure::file, {"none.glsl"});
    expectNothingWritten();
}

TEST_F(FunctionOption, thatNeverEndsIsEnded) {
    for (const char* loop : {"while (true) x += 1.0;", "for (;;) for (;;) x -= 1.0;"})
        expectRefused(
            render(file(fmt::format("float height(vec3 p, vec2 st, float t) {{ float x = p.y; {} return x; }}", loop))),
            Failure::device, {"loops take more than 1000 turns at face ", "does one never end?"});
    expectNothingWritten();
    EXPECT_EQ(folder_.fileCount(), 3u) << "two functions and the cache";
}

TEST_F(FunctionOption, isRefusedWhereItMeansNothing) {
    writeImage(target("map.exr"), sineImage(16, 1), SampleType::real);
    expectRefused(render("golf", "--height " + target("map.exr")), Failure::usage, {"--height"});
    expectRefused(render("golf", "--wrap clamp"), Failure::usage, {"--wrap"});
    expectRefused(render("golf", "--scheme none"), Failure::usage, {"--scheme"});
    expectRefused(render("golf", "--scale 1e30"), Failure::usage, {"lower --scale"});
    EXPECT_EQ(relief({"render", cagePath("torus"), "--height-bound", "1", "-o", target()}).exitCode,
              int(Failure::usage));
}

// --- cache

TEST_F(FunctionOption, isCompiledByTheFirstProcessAlone) {
    const auto costs = [&] { return jsonOf(render("waves", "--json --path grid")); };
    const auto first = costs(), second = costs();
    EXPECT_EQ(first["function_compiled"], 2) << "alone, and with grid.vert";
    EXPECT_EQ(first["function_cached"], 0);
    EXPECT_EQ(second["function_compiled"], 0);
    EXPECT_EQ(second["function_cached"], 2);
    // Damaged files are made anew.
    for (const auto& entry : std::filesystem::directory_iterator(target("cache"))) putFile(entry.path(), "damaged");
    EXPECT_EQ(costs()["function_compiled"], 2);
    EXPECT_EQ(costs()["function_compiled"], 0);
}

} // namespace
} // namespace relief::test
