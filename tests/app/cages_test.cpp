// Cages that are odd, by every verb: nothing drawn, faces without texture coordinates, unwelded vertices, flat
// triangles.
#include "program.h"

namespace relief::test {
namespace {

const std::string kCorners = "v -1 -1 1\nv 1 -1 1\nv 1 -1 -1\nv -1 -1 -1\nv -1 1 1\nv 1 1 1\nv 1 1 -1\nv -1 1 -1\n"
                             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string kTextured = "f 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n";
const std::string kPlain = "f 5 6 7 8\nf 4 3 2 1\n";
const std::string kClosing = "f 5/1 6/2 7/3 8/4\nf 4/1 3/2 2/3 1/4\n";

class OddCages : public ::testing::Test {
protected:
    TemporaryFolder folder_;
    std::string cage_ = folder_ / "cage.obj", map_ = folder_ / "h.exr", albedo_ = folder_ / "c.png";

    void SetUp() override {
        writeImage(map_, sineImage(16, 1), SampleType::real);
        writeImage(albedo_, {4, 4, 3, std::vector<float>(48, 0.5f)}, SampleType::uint8);
        putFile(folder_ / "points.csv", "0,0.5,0.5\n");
    }

    /// Words of each verb that draws or measures the cage.
    [[nodiscard]] std::vector<Words> verbs() const {
        return {{"render", cage_, "--size", "64,64", "--rate", "2", "-o", folder_ / "a.png"},
                {"export", cage_, "--rate", "2", "-o", folder_ / "a.ply"},
                {"check", cage_, "--rate", "2", "--points", "100"},
                {"sample", cage_, "--at", folder_ / "points.csv", "-o", folder_ / "a.csv"},
                {"animate", cage_, "--deform", "twist(angle=9*t)", "--frames", "0:1", "--size", "64,64", "--rate", "2",
                 "-o", folder_ / "a.{frame}.png"},
                {"bench", "bandwidth", "--quick", "--cage", cage_, "--height", map_}};
    }
    static Outcome with(Words words, const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
        return relief(words);
    }
    static std::size_t warningCount(const Outcome& outcome, const std::string& part) {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = outcome.err.find("warning: ", at)) != std::string::npos; ++at)
            count += outcome.err.substr(at, outcome.err.find('\n', at) - at).find(part) != std::string::npos ? 1 : 0;
        return count;
    }
};

// --- nothing is drawn ----------------------------------------------------------------------------------------------

TEST_F(OddCages, ofHolesAloneAreRefusedByEveryVerb) {
    putFile(cage_, kCorners + kTextured + kClosing + "t hole 6/0/0 0 1 2 3 4 5\n");
    for (const Words& verb : verbs()) expectRefused(relief(verb), Failure::input, {cage_, "all 6 faces are holes"});
    EXPECT_EQ(jsonOf(relief({"info", cage_, "--json"}))[0].at("holes"), 6);
}

TEST_F(OddCages, thatABoundaryRuleHidesAreRefusedByEveryVerb) {
    putFile(cage_, kCorners + "f 1/1 2/2 6/3 5/4\nt interpolateboundary 1/0/0 0\n");
    for (const Words& verb : verbs()) expectRefused(relief(verb), Failure::input, {cage_, "interpolateboundary"});
    expectDone(with(verbs()[0], {"--scheme", "none"}));
}

TEST_F(OddCages, ofDegenerateFacesAloneAreRefusedByEveryVerb) {
    putFile(cage_, kCorners + "f 1/1 1/1 2/2\nf 3 4\n");
    for (const Words& verb : verbs()) expectRefused(relief(verb), Failure::input, {cage_ + ":13:", "degenerate"});
}

TEST_F(OddCages, withTooManyNeighboursAreRefusedAtOnce) {
    std::string text, face = "f";
    for (int k = 1; k <= 1001; ++k) {
        text += fmt::format("v {} {} 0\n", std::cos(k * 6.2832 / 1001), std::sin(k * 6.2832 / 1001));
        face += fmt::format(" {}", k);
    }
    putFile(cage_, text + face + "\n");
    expectRefused(relief(verbs()[0]), Failure::input, {cage_, "face 0 has 1001 corners", "at most 1000"});
}

// --- texture coordinates on some faces only ------------------------------------------------------------------------

TEST_F(OddCages, withTextureCoordinatesOnSomeFacesAreDrawnWithoutAMap) {
    putFile(cage_, kCorners + kTextured + kPlain);
    for (std::size_t verb = 0; verb < 5; ++verb) {
        const Outcome outcome = relief(verbs()[verb]);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(warningCount(outcome, cage_ + ":17:"), 1u) << outcome.err;
    }
    const Outcome info = relief({"info", cage_, "--json"});
    EXPECT_EQ(warningCount(info, cage_ + ":17:"), 1u) << info.err;
}

TEST_F(OddCages, withTextureCoordinatesOnSomeFacesAreRefusedWhereAMapNeedsThem) {
    putFile(cage_, kCorners + kTextured + kPlain);
    for (std::size_t verb = 0; verb < 5; ++verb)
        expectRefused(with(verbs()[verb], {"--height", map_}), Failure::input, {cage_ + ":17:", map_});
    expectRefused(relief(verbs()[5]), Failure::input, {cage_ + ":17:", map_});
    expectRefused(relief({"info", cage_, "--height", map_}), Failure::input, {cage_ + ":17:", map_});
    for (const std::size_t verb : {0, 4})
        expectRefused(with(verbs()[verb], {"--albedo", albedo_}), Failure::input, {cage_ + ":17:", albedo_});
}

// --- triangles with tags -------------------------------------------------------------------------------------------

TEST_F(OddCages, ofTrianglesWithTagsAskForAScheme) {
    const std::string faces = "f 1 2 5\nf 2 3 5\nf 3 1 5\nf 3 2 1\n";
    for (const std::string tag : {"t crease 2/1/0 0 1 3\n", "t corner 1/1/0 2 3\n", "t hole 1/0/0 1\n"}) {
        putFile(cage_, kCorners + faces + tag);
        const Outcome outcome = relief(verbs()[0]);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(warningCount(outcome, "--scheme loop or catmark"), 1u) << outcome.err;
        for (const char* scheme : {"loop", "catmark", "none"})
            EXPECT_EQ(warningCount(with(verbs()[0], {"--scheme", scheme}), "--scheme"), 0u);
    }
    putFile(cage_, kCorners + faces);
    EXPECT_EQ(warningCount(relief(verbs()[0]), "--scheme"), 0u);
    putFile(cage_, kCorners + faces + "t crease 2/1/0 0 1 3\n");
    expectRefused(relief(verbs()[1]), Failure::usage, {"--scheme"});
}

// --- vertices at the same position ---------------------------------------------------------------------------------

/// A cube whose faces have vertices of their own; `shift` moves every second one along x.
std::string unweldedCube(double shift = 0) {
    const int corners[6][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}, {3, 2, 1, 0}};
    std::string text;
    int vertex = 0;
    for (const auto& face : corners) {
        for (const int corner : face) {
            ++vertex;
            const double x = corner % 4 == 1 || corner % 4 == 2 ? 1 : -1;
            text += fmt::format("v {} {} {}\nvt {} {}\n", x + (vertex % 2) * shift, corner < 4 ? -1 : 1,
                                corner % 4 < 2 ? 1 : -1, vertex % 4 / 2, vertex % 2);
        }
        text += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", vertex - 3, vertex - 2, vertex - 1, vertex);
    }
    return text;
}

TEST_F(OddCages, thatAreUnweldedAreWarnedOfUntilTheyAreWelded) {
    putFile(cage_, unweldedCube());
    for (std::size_t verb = 0; verb < 5; ++verb) {
        const Outcome plain = relief(verbs()[verb]), welded = with(verbs()[verb], {"--weld"});
        EXPECT_EQ(plain.exitCode, 0) << plain.err;
        EXPECT_EQ(warningCount(plain, "16 of 24 vertices"), 1u) << plain.err;
        EXPECT_EQ(welded.exitCode, 0) << welded.err;
        EXPECT_EQ(warningCount(welded, "vertices"), 0u) << welded.err;
    }
    const nlohmann::json certificate = jsonOf(with(verbs()[2], {"--weld", "--json"}));
    for (const nlohmann::json& path : certificate.at("paths")) EXPECT_EQ(path.at("boundary_segments"), 0);
}

TEST_F(OddCages, reportHowManyOfTheirVerticesCoincide) {
    putFile(cage_, unweldedCube());
    const auto before = jsonOf(relief({"info", cage_, "--json"}))[0];
    EXPECT_EQ(before.at("coincident_boundary_vertices"), 16);
    EXPECT_EQ(before.at("boundary_edges"), 24);
    for (const Words& weld : {Words{"--weld"}, Words{"--weld", "0"}, Words{"--weld=0.001"}, Words{"--weld", "0.01%"}}) {
        Words words = {"info", "--json"};
        words.insert(words.end(), weld.begin(), weld.end());
        words.push_back(cage_); // the word after --weld is no distance
        const auto after = jsonOf(relief(words))[0];
        EXPECT_EQ(after.at("coincident_boundary_vertices"), 0);
        EXPECT_EQ(after.at("boundary_edges"), 0);
        EXPECT_EQ(after.at("vertices"), 8);
    }
}

TEST_F(OddCages, weldWithinADistanceInCageUnitsOrOfTheDiagonal) {
    putFile(cage_, unweldedCube(0.01));
    const auto vertices = [&](const char* distance) {
        return jsonOf(relief({"info", cage_, "--json", "--weld", distance}))[0].at("vertices").get<int>();
    };
    EXPECT_EQ(vertices("0.02"), 8);
    EXPECT_GT(vertices("0.005"), 8);
    EXPECT_EQ(vertices("0.5%"), 8); // the diagonal is 3.47
    EXPECT_GT(vertices("0.1%"), 8);
}

TEST_F(OddCages, areNotWeldedOverInvalidDistances) {
    putFile(cage_, unweldedCube());
    for (const char* distance : {"-1", "-1%", "inf", "1e999"})
        expectRefused(relief({"info", cage_, "--weld", distance}), Failure::usage, {"no distance"});
    expectRefused(relief({"info", cage_, "--weld", "100"}), Failure::usage, {"--weld 100", "smaller"});
}

TEST_F(OddCages, areMovedByCachesOfTheirOwnPointsWhenTheyAreWelded) {
    putFile(cage_, unweldedCube());
    const std::string cache = folder_ / "walk.pc2", twist = "twist(axis=y, angle=40*t)";
    expectDone(relief({"animate", cage_, "--deform", twist, "--frames", "0:2", "--fps", "1", "-o", cache, "-q"}));
    const auto picture = [&](const std::string& name, const Words& motion) {
        Words words = {"render", cage_,    "--weld", "-q",    "--size", "64,64", "--rate",
                       "4",      "--time", "1.5",    "--fps", "1",      "-o",    folder_ / name};
        words.insert(words.end(), motion.begin(), motion.end());
        expectDone(relief(words));
        return readImage(folder_ / name).texels;
    };
    const auto cached = picture("cache.png", {"--cache", cache});
    EXPECT_EQ(cached.size(), 64u * 64u * 3u);
    EXPECT_NE(cached, picture("rest.png", {"--deform", "twist(angle=0)"}));
    // Frames 1 and 2 are mixed by position: close to the deformer between them.
    const auto deformed = picture("deform.png", {"--deform", twist});
    double sum = 0;
    for (std::size_t i = 0; i < cached.size(); ++i) sum += std::abs(double(cached[i]) - double(deformed[i]));
    EXPECT_LT(sum / double(cached.size()), 0.05);
    // A clip on the device, and its cache again: one point per vertex of the file.
    Words clip = {"animate", cage_, "--weld", "-q", "--cache", cache, "--fps", "1", "--frames", "0:2"};
    Words frames = clip, copy = clip;
    frames.insert(frames.end(), {"--size", "64,64", "--rate", "2", "-o", folder_ / "f.{frame}.png"});
    expectDone(relief(frames));
    copy.insert(copy.end(), {"-o", folder_ / "copy.pc2"});
    expectDone(relief(copy));
    EXPECT_EQ(readFile(folder_ / "copy.pc2"), readFile(cache));
}

} // namespace
} // namespace relief::test
