// relief sample: known values, and rows that cannot be answered.
#include "cage/cage.h"
#include "program.h"

namespace relief::test {
namespace {

constexpr const char* kHeader = "face,u,v,px,py,pz,pux,puy,puz,pvx,pvy,pvz,nx,ny,nz,h,qx,qy,qz,mx,my,mz";

struct Row {
    int face = 0;
    dvec2 uv{0};
    dvec3 p{0}, pu{0}, pv{0}, n{0};
    double h = 0;
    dvec3 q{0}, m{0};
};

Row rowOf(const std::string& line) {
    std::istringstream fields(line);
    std::vector<double> x;
    for (std::string field; std::getline(fields, field, ',');) x.push_back(std::stod(field));
    EXPECT_EQ(x.size(), 22u) << line;
    x.resize(22);
    const auto vector = [&](int i) { return dvec3(x[i], x[i + 1], x[i + 2]); };
    return {int(x[0]), {x[1], x[2]}, vector(3), vector(6), vector(9), vector(12), x[15], vector(16), vector(19)};
}

class Sampled : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    Outcome sample(const std::string& cage, const std::string& points, const std::string& more = "") {
        putFile(folder_ / "points.csv", points);
        return relief({"sample", cage, "--at", folder_ / "points.csv", "-o", folder_ / "frames.csv"}, more);
    }

    std::vector<Row> rows(const std::string& cage, const std::string& points, const std::string& more = "") {
        expectDone(sample(cage, points, more));
        std::istringstream lines(readFile(folder_ / "frames.csv"));
        std::string line;
        std::getline(lines, line);
        EXPECT_EQ(line, kHeader);
        std::vector<Row> rows;
        while (std::getline(lines, line)) rows.push_back(rowOf(line));
        return rows;
    }
};

void expectNear(const dvec3& a, const dvec3& b, double tolerance) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

// The plane's limit surface is the plane, linear in each face; a map that rises by 1 along s is known in closed form
// away from its border, where it repeats.
TEST_F(Sampled, aPlaneUnderARampIsKnownExactly) {
    constexpr int kSide = 64;
    Image ramp{kSide, kSide, 1, {}};
    for (int i = 0; i < kSide * kSide; ++i) ramp.texels.push_back((float(i % kSide) + 0.5f) / kSide);
    writeImage(folder_ / "ramp.exr", ramp, SampleType::real);
    const Cage plane = readCage(cagePath("plane"));
    std::string points = "face,u,v\n";
    for (const char* row : {"9,0,0", "9,1,0", "27,0.25,0.5", "36,0.5,0.125", "54,1,1"})
        points += std::string(row) + "\n";
    for (const Row& row : rows(cagePath("plane"), points, "--scale 0.5 --height " + folder_ / "ramp.exr")) {
        const auto corner = [&](int k) { return dvec3(plane.positions[plane.corners[4 * row.face + k]]); };
        const dvec3 p =
            glm::mix(glm::mix(corner(0), corner(1), row.uv.x), glm::mix(corner(3), corner(2), row.uv.x), row.uv.y);
        expectNear(row.p, p, 1e-6);
        expectNear(row.pu, corner(1) - corner(0), 1e-5);
        expectNear(row.pv, corner(3) - corner(0), 1e-5);
        expectNear(row.n, {0, 1, 0}, 1e-6);
        const double s = (p.x + 1) / 2, slope = 0.5 / 2; // the plane is 2 wide
        EXPECT_NEAR(row.h, 0.5 * s, 1e-6);
        expectNear(row.q, p + dvec3(0, 0.5 * s, 0), 1e-6);
        expectNear(row.m, glm::normalize(dvec3(-slope, 1, 0)), 1e-5);
    }
}

TEST_F(Sampled, theBallsVerticesLieOnTheUnitSphere) {
    std::string points;
    for (int face = 0; face < 96; ++face) points += fmt::format("{0},0,0\n{0},1,1\n{0},0.5,0.5\n", face);
    const std::vector<Row> all = rows(cagePath("ball"), points);
    ASSERT_EQ(all.size(), 288u);
    for (const Row& row : all) {
        const bool isVertex = row.uv.x != 0.5;
        EXPECT_NEAR(glm::length(row.p), 1, isVertex ? 1e-5 : 0.02);
        EXPECT_GT(glm::dot(row.n, row.p), 0.98); // outwards
        EXPECT_EQ(row.h, 0);
        expectNear(row.q, row.p, 1e-7);
    }
}

TEST_F(Sampled, givesTheKindOfNormalThatIsAskedFor) {
    writeImage(folder_ / "h.exr", sineImage(32, 2), SampleType::real);
    const std::string map = "--scale 0.1 --height " + folder_ / "h.exr";
    const std::string point = "17,0.3,0.4\n";
    const Row limit = rows(cagePath("ball"), point, map + " --normal limit").at(0);
    const Row first = rows(cagePath("ball"), point, map + " --normal first-order").at(0);
    const Row full = rows(cagePath("ball"), point, map + " --normal full").at(0);
    expectNear(limit.m, limit.n, 1e-6);
    EXPECT_GT(glm::length(first.m - limit.m), 1e-2);
    EXPECT_GT(glm::length(full.m - first.m), 1e-3);
    expectNear(full.q, full.p + full.h * full.n, 1e-6);
}

TEST_F(Sampled, jsonCountsTheRows) {
    const nlohmann::json json = jsonOf(sample(cagePath("cube"), "\r\n0,0.5,0.5\r\n\n5, 1,0", "--json -q"));
    EXPECT_EQ(json.at("rows"), 2);
    EXPECT_EQ(json.at("output"), folder_ / "frames.csv");
    EXPECT_TRUE(json.at("device").is_string());
}

TEST_F(Sampled, noPointsGiveAHeaderAlone) { EXPECT_TRUE(rows(cagePath("cube"), "face,u,v\n").empty()); }

TEST_F(Sampled, rowsThatCannotBeAnsweredAreNamed) {
    const std::string cube = cagePath("cube"), file = folder_ / "points.csv";
    const auto refuse = [&](const std::string& cage, const std::string& points, const Words& parts) {
        expectRefused(sample(cage, points), Failure::input, parts);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "frames.csv"));
    };
    refuse(cube, "0,0.5,0.5\n6,0,0\n", {file, "point 1", "face 6", "0..5"});
    refuse(cube, "0,1.5,0\n", {file, "point 0", "1.5", "0..1"});
    refuse(cube, "0,0.5,nan\n", {file, "point 0", "nan"});
    refuse(cube, "0,0.5,0.5\n\nsome text\n", {file + ":3:", "face,u,v"});
    refuse(cube, "0,0.5\n", {file + ":1:", "face,u,v"});
    refuse(cube, "0,0.5,0.5,7\n", {file + ":1:", "face,u,v"});
    refuse(cube, "-1,0.5,0.5\n", {file + ":1:", "face,u,v"});
    putFile(folder_ / "hole.obj", readFile(cube) + "t hole 1/0/0 2\n");
    refuse(folder_ / "hole.obj", "1,0,0\n2,0.5,0.5\n", {file, "point 1", "face 2", "hole"});
}

TEST_F(Sampled, trianglesEndAtTheirLongSide) {
    putFile(folder_ / "tetrahedron.obj",
            "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const std::string cage = folder_ / "tetrahedron.obj";
    EXPECT_EQ(rows(cage, "0,0.5,0.5\n3,1,0\n", "--scheme loop").size(), 2u);
    expectRefused(sample(cage, "0,0.6,0.5\n", "--scheme loop"), Failure::input, {"point 0", "u + v <= 1"});
    expectRefused(sample(cage, "0,0.5,0.5\n"), Failure::usage, {cage, "--scheme"});
}

} // namespace
} // namespace relief::test
