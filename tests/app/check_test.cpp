// relief check: the certificate as words and as JSON, and what breaks it.
#include "program.h"

namespace relief::test {
namespace {

const nlohmann::json& pathOf(const nlohmann::json& certificate, const std::string& name) {
    for (const nlohmann::json& path : certificate.at("paths"))
        if (path.at("path") == name) return path;
    throw std::runtime_error(name + " is missing");
}

TEST(Check, certifiesAllPathsOfACageAndItsMap) {
    const TemporaryFolder folder;
    writeImage(folder / "waves.exr", sineImage(64, 2), SampleType::real);
    const nlohmann::json c = jsonOf(relief({"check", cagePath("torus"), "--height", folder / "waves.exr"},
                                           "--scale 0.05 --rate 5 --points 5000 --json"));
    EXPECT_EQ(c.at("cage"), cagePath("torus"));
    EXPECT_EQ(c.at("broken_promises"), nlohmann::json::array());
    for (const char* name : {"grid", "dice"}) {
        const nlohmann::json& path = pathOf(c, name);
        EXPECT_TRUE(path.at("watertight"));
        EXPECT_EQ(path.at("triangles"), c.at("faces").get<int>() * 50);
        EXPECT_EQ(path.at("distinct_points"), c.at("faces").get<int>() * 25);
        EXPECT_EQ(path.at("open_edges"), 0);
        EXPECT_EQ(path.at("crack_pixels"), 0);
        EXPECT_EQ(path.at("expected_boundary_segments"), 0);
    }
    const nlohmann::json& regular = c.at("frames").at("regular");
    EXPECT_GT(regular.at("points"), 3000);
    EXPECT_LT(regular.at("point").at("max"), 1e-6);
    EXPECT_GT(regular.at("point").at("max"), 0);
    EXPECT_LT(regular.at("tangents").at("max"), 1e-5);
    EXPECT_LT(regular.at("displaced_normal_degrees").at("max"), 0.05);
    EXPECT_GT(c.at("curvature").at("min_one_plus_h_kappa"), 0.5);
    EXPECT_LT(c.at("curvature").at("min_one_plus_h_kappa"), 1);
    EXPECT_EQ(c.at("curvature").at("folded_fraction"), 0);
    EXPECT_GT(c.at("curvature").at("first_order_normal_max_degrees"), 0.1);
    EXPECT_LT(c.at("seams").at("max_of_reach"), 1e-6);
}

TEST(Check, tellsFoldsWithoutCallingThemBroken) {
    const TemporaryFolder folder;
    writeImage(folder / "flat.exr", {4, 4, 1, std::vector<float>(16, 1)}, SampleType::real);
    const Words words{"check", cagePath("torus"), "--height", folder / "flat.exr"};
    const Outcome folded = relief(words, "--scale -2 --rate 2 --path grid --points 2000");
    EXPECT_EQ(folded.exitCode, 0) << folded.err;
    EXPECT_TRUE(contains(folded.out, "The map folds the surface")) << folded.out;
    const nlohmann::json c = jsonOf(relief(words, "--scale -2 --rate 2 --path grid --points 2000 --json"));
    EXPECT_LT(c.at("curvature").at("min_one_plus_h_kappa"), 0);
    EXPECT_GT(c.at("curvature").at("folded_fraction"), 0.5);
    EXPECT_EQ(c.at("paths").size(), 1u);
}

TEST(Check, readsAsText) {
    const Outcome outcome = relief({"check", cagePath("lantern")}, "--rate 3 --path dice --points 5000");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.out.starts_with(cagePath("lantern") + " on ")) << outcome.out;
    for (const char* part : {"\nwatertight\n", "\n  dice ", "\nexact", "outside end caps", "in end caps", " of "})
        EXPECT_TRUE(contains(outcome.out, part)) << part << " in " << outcome.out;
    EXPECT_FALSE(contains(outcome.out, "seams")) << "there is no map: " << outcome.out;
    EXPECT_EQ(relief({"check", cagePath("lantern")}, "--rate 3 --path dice --points 5000 -q").out, "");
}

TEST(Check, countsTheBoundaryOfOpenCages) {
    const nlohmann::json c = jsonOf(relief({"check", cagePath("plane")}, "--rate 3 --path grid --points 2000 --json"));
    const nlohmann::json& grid = pathOf(c, "grid");
    EXPECT_GT(grid.at("boundary_segments"), 0);
    EXPECT_EQ(grid.at("boundary_segments"), grid.at("expected_boundary_segments"));
    EXPECT_TRUE(grid.at("crack_pixels").is_null());
    EXPECT_FALSE(c.contains("seams"));
}

TEST(Check, refusesWhatItCannotCertify) {
    const TemporaryFolder folder;
    putFile(folder / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expectRefused(relief({"check", folder / "triangle.obj"}), Failure::usage, {"triangle.obj", "--scheme"});
    expectRefused(relief({"check", cagePath("cube"), "--path", "other"}), Failure::usage, {"other"});
    expectRefused(relief({"check", cagePath("cube"), "--points", "0"}), Failure::usage, {"--points"});
    expectRefused(relief({"check", cagePath("cube"), "--rate", "0"}), Failure::usage, {"1..64"});
}

} // namespace
} // namespace relief::test
