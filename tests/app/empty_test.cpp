// Pictures in which nothing is drawn say why, in one line; all others say nothing.
#include "program.h"

namespace relief::test {
namespace {

class Empty : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    /// The cube with its vertices put elsewhere.
    std::string putCube(const std::function<dvec3(const dvec3&)>& move, const std::string& more = "") {
        std::istringstream lines(readFile(cagePath("cube")));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            dvec3 p;
            if (std::sscanf(line.c_str(), "v %lf %lf %lf", &p.x, &p.y, &p.z) == 3) {
                p = move(p);
                line = fmt::format("v {:.17g} {:.17g} {:.17g}", p.x, p.y, p.z);
            }
            text += line + "\n";
        }
        putFile(folder_ / "cube.obj", text + more);
        return folder_ / "cube.obj";
    }

    Outcome render(const std::string& cage, const std::string& more = "") {
        return relief({"render", cage, "-o", folder_ / "a.png"}, "--size 64,64 --rate 4 " + more);
    }

    static void expectReason(const Outcome& outcome, const Words& parts) {
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("warning: ")) << outcome.err;
        const std::string line = outcome.err.substr(0, outcome.err.find('\n'));
        EXPECT_TRUE(contains(line, "there is nothing to see: ")) << outcome.err;
        EXPECT_FALSE(contains(outcome.err.substr(line.size()), "warning: ")) << outcome.err;
        for (const std::string& part : parts) EXPECT_TRUE(contains(line, part)) << part << " in " << outcome.err;
    }
};

TEST_F(Empty, saysThatAllPointsCoincide) {
    const std::string cage = putCube([](const dvec3&) { return dvec3(1, 2, 3); });
    expectReason(render(cage), {cage, "coincide at (1, 2, 3)"});
    expectReason(render(cage, "--scheme none"), {"coincide at (1, 2, 3)"});
    EXPECT_EQ(render(cage, "-q").err, "");
}

TEST_F(Empty, saysThatAllPointsLieOnOneLine) {
    const std::string cage = putCube([](const dvec3& p) { return (p.x + 3 * p.y + 9 * p.z) * dvec3(1, 2, -0.5); });
    expectReason(render(cage), {"on one line", "no area"});
    expectReason(render(cage, "--scheme none"), {"on one line"});
}

TEST_F(Empty, saysThatTheCameraSeesNothing) {
    const std::string cage = cagePath("cube");
    expectReason(render(cage, "--look-at 100,0,0 --distance 5"), {"outside of the picture", "--look-at"});
    expectReason(render(cage, "--look-at 0,0,-100 --distance 5 --azimuth 0 --elevation 0"),
                 {"behind the camera", "--look-at"});
    expectReason(render(cage, "--distance 1e7"), {"pixels large", "--distance"});
}

TEST_F(Empty, saysThatASheetIsSeenFromItsEdge) {
    expectReason(render(cagePath("plane"), "--azimuth 0 --elevation 0"), {"edge"});
}

TEST_F(Empty, saysThatHeightsAreTooLarge) {
    writeImage(folder_ / "waves.exr", sineImage(32, 2), SampleType::real);
    const Outcome outcome = render(cagePath("torus"), "--scale 1e30 --height " + folder_ / "waves.exr");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("warning: heights of up to ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "lower --scale")) << outcome.err;
}

TEST_F(Empty, isNotReportedWhereSomethingIsSeen) {
    for (const char* name : {"cube", "torus", "plane"})
        EXPECT_FALSE(contains(render(cagePath(name)).err, "warning")) << name;
    for (const char* angle : {"30", "-30"}) // cubes of one pixel and some
        EXPECT_FALSE(
            contains(render(cagePath("cube"), fmt::format("--distance 200 --azimuth={}", angle)).err, "warning"));
    EXPECT_FALSE(contains(render(putCube([](const dvec3& p) { return 1e-15 * p; })).err, "warning"));
}

TEST_F(Empty, isReportedOncePerClipWithTheFirstFrame) {
    const Outcome outcome = relief({"animate", cagePath("cube"), "--deform",
                                    "scale(x=max(0,1-t), y=max(0,1-t), z=max(0,1-t))", "-o", folder_ / "f.{frame}.png"},
                                   "--size 64,64 --rate 4 --fps 2 --frames 0:5");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::string mark = "frame 2: there is nothing to see: all of its points coincide";
    EXPECT_TRUE(contains(outcome.err, mark)) << outcome.err;
    const std::size_t first = outcome.err.find("nothing to see");
    EXPECT_EQ(outcome.err.find("nothing to see", first + 1), std::string::npos) << outcome.err;
}

} // namespace
} // namespace relief::test
