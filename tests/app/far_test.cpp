// Objects far from the origin, very small and very large, through the command line: what they look like, and the
// numbers that leave.
#include "cage/cage.h"
#include "program.h"

namespace relief::test {
namespace {

const dvec3 kAway(1e7, -1e7, 2e7), kUtm(512347.078, 120.5, 4187654.321);

class Far : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    Far() { writeImage(folder_ / "waves.exr", sineImage(64, 2), SampleType::real); }

    /// A cage of the project's with its vertices scaled and moved; returns its path.
    std::string put(const std::string& name, const dvec3& offset, double scale = 1) {
        std::istringstream lines(readFile(cagePath(name)));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            dvec3 p;
            if (std::sscanf(line.c_str(), "v %lf %lf %lf", &p.x, &p.y, &p.z) == 3) {
                p = scale * p + offset;
                line = fmt::format("v {:.17g} {:.17g} {:.17g}", p.x, p.y, p.z);
            }
            text += line + "\n";
        }
        const std::string path = folder_ / fmt::format("{}{}.obj", name, count_++);
        putFile(path, text);
        return path;
    }

    Image draw(const std::string& cage, const std::string& more) {
        const Outcome outcome = relief({"render", cage, "-o", folder_ / "a.exr", "-q"}, "--size 96,96 " + more);
        expectDone(outcome);
        EXPECT_EQ(outcome.err, "");
        return readImage(folder_ / "a.exr");
    }

private:
    int count_ = 0;
};

/// Samples at an edge may fall to its other side where a point moves by its last bit.
void expectSamePicture(const Image& a, const Image& b, const std::string& what) {
    ASSERT_EQ(a.texels.size(), b.texels.size());
    std::size_t different = 0, covered = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        different += std::abs(a.texels[i] - b.texels[i]) > 0.012f;
        covered += b.texels[i] > 0;
    }
    EXPECT_GT(covered, a.texels.size() / 10) << what;
    EXPECT_LE(double(different), 0.002 * double(a.texels.size())) << what;
}

TEST_F(Far, looksAsItDoesNearby) {
    for (const std::string more :
         {"--rate 6 --path tessellation", "--rate 6 --path grid", "--edge-pixels 4 --path dice", "--scheme none",
          "--rate 4 --show normal --deform twist(angle=40)"}) {
        const bool isSurface = !contains(more, "none");
        const std::string words = more + (isSurface ? " --scale 0.08 --height " + folder_ / "waves.exr" : "");
        const Image near = draw(cagePath("torus"), words);
        expectSamePicture(draw(put("torus", kUtm), words), near, words);
    }
}

TEST_F(Far, looksTheSameToTheBitWhereTheDistanceIsAMultipleOfTheRounding) {
    for (const std::string more : {"--rate 6", "--scheme none"})
        EXPECT_EQ(draw(put("cube", kAway), more).texels, draw(cagePath("cube"), more).texels) << more;
}

TEST_F(Far, looksTheSameInAnySize) {
    const std::string words = "--rate 6 --height " + folder_ / "waves.exr";
    const Image usual = draw(cagePath("cube"), words + " --scale 0.1");
    for (const double scale : {1e-60, 1e-15, 1e7, 1e38})
        expectSamePicture(draw(put("cube", dvec3(0), scale), words + fmt::format(" --scale {}", 0.1 * scale)), usual,
                          fmt::format("{}", scale));
}

// Under heights of 10^12 sizes the cage is a point, and so it is under 10^7.
TEST_F(Far, heightsOfAnySizeAreLitTheSame) {
    const std::string words = "--rate 6 --height " + (folder_ / "waves.exr") + " --scale ";
    const Image usual = draw(cagePath("torus"), words + "1e7");
    expectSamePicture(draw(cagePath("torus"), words + "1e12"), usual, "1e12");
}

TEST_F(Far, theCameraIsPlacedInTheWorld) {
    const Image near = draw(cagePath("torus"), "--rate 6 --look-at 0.5,0.25,0 --distance 9");
    expectSamePicture(draw(put("torus", kAway), "--rate 6 --look-at 10000000.5,-9999999.75,20000000 --distance 9"),
                      near, "far");
    expectSamePicture(draw(put("torus", dvec3(0), 1e-12), "--rate 6 --look-at 5e-13,2.5e-13,0 --distance 9e-12"), near,
                      "small");
}

TEST_F(Far, layersHaveTheUnitsOfTheWorld) {
    const std::string words = "--rate 6 --layers depth,height --height " + folder_ / "waves.exr";
    const Image usual = draw(cagePath("cube"), words + " --scale 0.1");
    const double scale = std::ldexp(1.0, -40);
    const Image small = draw(put("cube", dvec3(0), scale), words + fmt::format(" --scale {}", 0.1 * scale));
    ASSERT_EQ(usual.channels, 6);
    std::size_t seen = 0;
    for (int y = 0; y < usual.height; ++y)
        for (int x = 0; x < usual.width; ++x) {
            const float *a = usual.at(x, y), *b = small.at(x, y);
            if (a[3] < 1 || b[3] < 1) continue;
            ++seen;
            EXPECT_NEAR(b[4], scale * a[4], 1e-4 * scale);
            EXPECT_NEAR(b[5], scale * a[5], 1e-2 * scale);
        }
    EXPECT_GT(seen, 1000u);
}

TEST_F(Far, isCertified) {
    for (const dvec3& offset : {dvec3(30, 0, 0), dvec3(3, 3, 3), kUtm}) {
        const nlohmann::json c =
            jsonOf(relief({"check", put("torus", offset), "--json"}, "--rate 3 --points 4000 --path dice"));
        EXPECT_LT(c.at("frames").at("regular").at("point").at("max"), 1e-6);
        EXPECT_NEAR(c.at("diagonal").get<double>(), 4.1, 0.1);
    }
}

TEST_F(Far, isCertifiedWhereAPoseTakesItAway) {
    const Outcome outcome = relief({"check", cagePath("torus"), "--deform", "translate(x=100,z=-40)", "-q"},
                                   "--rate 3 --points 4000 --path dice");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

TEST_F(Far, theCertificateHasTheUnitsOfTheWorld) {
    const std::string words = "--rate 3 --points 4000 --path dice --height " + folder_ / "waves.exr";
    const auto certify = [&](double scale) {
        return jsonOf(relief({"check", put("torus", dvec3(0), scale), "--json"},
                             words + fmt::format(" --scale {}", 0.05 * scale)));
    };
    const nlohmann::json usual = certify(1), large = certify(std::ldexp(1.0, 40));
    const double scale = std::ldexp(1.0, 40);
    EXPECT_NEAR(large.at("diagonal").get<double>() / scale, usual.at("diagonal").get<double>(), 1e-6);
    EXPECT_NEAR(large.at("displacement_bound").get<double>() / scale, usual.at("displacement_bound").get<double>(),
                1e-9);
    EXPECT_NEAR(large.at("curvature").at("area").get<double>() / (scale * scale),
                usual.at("curvature").at("area").get<double>(), 1e-4);
}

std::vector<std::vector<double>> rowsOf(const std::string& path) {
    std::istringstream lines(readFile(path));
    std::string line;
    std::getline(lines, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(std::stod(field));
    }
    return rows;
}

TEST_F(Far, isSampledInDoublePrecision) {
    putFile(folder_ / "points.csv", "0,0.25,0.5\n17,1,0\n100,0.3,0.7\n");
    const auto sample = [&](const std::string& cage, double scale) {
        expectDone(relief({"sample", cage, "--at", folder_ / "points.csv", "-o", folder_ / "rows.csv", "--height",
                           folder_ / "waves.exr"},
                          fmt::format("--scale {}", 0.1 * scale)));
        return rowsOf(folder_ / "rows.csv");
    };
    const auto near = sample(cagePath("torus"), 1), far = sample(put("torus", kUtm), 1),
               small = sample(put("torus", dvec3(0), 1e-12), 1e-12);
    ASSERT_EQ(far.size(), 3u);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 3; i < 22; ++i) {
            const bool isPosition = i < 6 || (i >= 16 && i < 19), isLength = i < 12 || (i >= 15 && i < 19);
            const double offset = isPosition ? kUtm[int((i + (i < 6 ? 0 : 2)) % 3)] : 0;
            EXPECT_NEAR(far[row][i] - offset, near[row][i], 4e-6) << row << ' ' << i;
            EXPECT_NEAR(small[row][i] / (isLength ? 1e-12 : 1), near[row][i], 4e-6) << row << ' ' << i;
        }
}

TEST_F(Far, isExportedWhereItIs) {
    const auto boundsOf = [&](const std::string& cage, const std::string& name) {
        expectDone(relief({"export", cage, "-o", folder_ / name, "-q"}, "--rate 3"));
        return summarize(readCage(folder_ / name)).bounds;
    };
    for (const std::string name : {"mesh.obj", "mesh.glb"}) {
        const Bounds near = boundsOf(cagePath("torus"), name);
        const Bounds far = boundsOf(put("torus", kUtm), name);
        EXPECT_LT(glm::length(far.lower - kUtm - near.lower), 1e-6) << name;
        EXPECT_LT(glm::length(far.upper - kUtm - near.upper), 1e-6) << name;
        const Bounds small = boundsOf(put("torus", dvec3(0), 1e-12), name);
        EXPECT_LT(glm::length(small.upper * 1e12 - near.upper), 1e-6) << name;
    }
    expectDone(relief({"export", put("torus", kUtm), "-o", folder_ / "mesh.ply", "-q"}, "--rate 1"));
    EXPECT_TRUE(contains(readFile(folder_ / "mesh.ply"), "property double x\n"));
}

TEST_F(Far, isDescribedWhereItIs) {
    const std::string cage = put("cube", kUtm);
    const nlohmann::json bounds = jsonOf(relief({"info", "--json", cage})).at(0).at("bounds");
    EXPECT_NEAR(bounds.at("lower").at(2).get<double>(), kUtm.z - 1, 1e-6);
    EXPECT_NEAR(bounds.at("diagonal").get<double>(), std::sqrt(12.0), 1e-6);
    EXPECT_TRUE(contains(relief({"info", cage}).out, "4187655.321")) << relief({"info", cage}).out;
}

// --- motion --------------------------------------------------------------------------------------------------------

TEST_F(Far, movesAsItDoesNearby) {
    const auto draw = [&](const std::string& cage) {
        const Outcome outcome =
            relief({"animate", cage, "--deform", "twist(angle=60*t)", "-q", "-o", folder_ / "f.{frame}.exr"},
                   "--size 96,96 --rate 4 --fps 10 --frames 3");
        expectDone(outcome);
        return readImage(folder_ / "f.3.exr");
    };
    const Image near = draw(cagePath("torus"));
    expectSamePicture(draw(put("torus", kAway)), near, "far");
    expectSamePicture(draw(put("torus", dvec3(0), 1e-15)), near, "small");
}

TEST_F(Far, turnsAsItDoesNearby) {
    const auto draw = [&](const std::string& cage) {
        expectDone(relief({"animate", cage, "-q", "-o", folder_ / "f.{frame}.exr"},
                          "--size 96,96 --rate 4 --turntable 8 --frames 3"));
        return readImage(folder_ / "f.3.exr");
    };
    expectSamePicture(draw(put("torus", kUtm)), draw(cagePath("torus")), "turn");
}

TEST_F(Far, cachesAreWrittenInTheWorld) {
    const auto write = [&](const std::string& cage) {
        const Outcome outcome = relief({"animate", cage, "--deform", "twist(angle=60*t)", "-o", folder_ / "walk.pc2"},
                                       "--fps 10 --frames 0:2");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(contains(outcome.err, "warning: "), cage != cagePath("torus")) << outcome.err;
        const std::string bytes = readFile(folder_ / "walk.pc2");
        std::vector<vec3> points((bytes.size() - 32) / sizeof(vec3));
        std::memcpy(points.data(), bytes.data() + 32, points.size() * sizeof(vec3));
        return points;
    };
    const std::vector<vec3> near = write(cagePath("torus")), far = write(put("torus", kAway));
    ASSERT_EQ(far.size(), near.size());
    for (std::size_t i = 0; i < near.size(); ++i)
        EXPECT_LE(glm::length(dvec3(far[i]) - dvec3(near[i]) - kAway), 2) << "floats are 1 and 2 apart there";
}

} // namespace
} // namespace relief::test
