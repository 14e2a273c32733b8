// relief check: the certificate as words and as JSON, and what breaks it.
#include "cage/cage.h"
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
        EXPECT_EQ(path.at("expected_triangles"), path.at("triangles"));
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
    EXPECT_LT(c.at("seams").at("max_of_displacement_bound"), 1e-6);
}

TEST(Check, reportsFoldsWithoutFailing) {
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

// Heights past the end of floats leave no point where it should be.
TEST(Check, endsWithSixWhenAPromiseIsBroken) {
    const TemporaryFolder folder;
    writeImage(folder / "waves.exr", sineImage(64, 2), SampleType::real);
    const Outcome outcome = relief({"check", cagePath("torus"), "--height", folder / "waves.exr"},
                                   "--scale 1e60 --rate 2 --path grid --points 2000");
    EXPECT_EQ(outcome.exitCode, int(Failure::check)) << outcome.out;
    EXPECT_TRUE(contains(outcome.err, "relief: " + cagePath("torus") + ": ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "vertices that are not finite")) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "\nexact")) << "the certificate is printed all the same: " << outcome.out;
}

/// Pixels of a picture of bytes that are more blue than red, or the other way round, by more than noise.
struct Tints {
    int blue = 0, orange = 0;
};

Tints tintsOf(const std::string& path, float noise = 0.3f) {
    const Image image = readImage(path);
    Tints tints;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* pixel = image.at(x, y);
            tints.blue += pixel[2] > pixel[0] + noise;
            tints.orange += pixel[0] > pixel[2] + noise;
        }
    return tints;
}

TEST(Check, drawsFoldsBlueAndErrorsOrange) {
    const TemporaryFolder folder;
    writeImage(folder / "flat.exr", {4, 4, 1, std::vector<float>(16, 1)}, SampleType::real);
    const Words words{"check", cagePath("torus"), "--height", folder / "flat.exr", "--heatmap", folder / "heat.png"};
    EXPECT_EQ(relief(words, "--scale -0.6 --rate 1 --path grid --points 5000").exitCode, 0);
    const Tints folded = tintsOf(folder / "heat.png");
    EXPECT_GT(folded.blue, 20'000);
    EXPECT_EQ(relief(words, "--scale 0.01 --rate 1 --path grid --points 5000").exitCode, 0);
    EXPECT_EQ(tintsOf(folder / "heat.png").blue, 0);
    EXPECT_EQ(readImage(folder / "heat.png").width, 1024);
}

// Points of deep levels lie close together: no error comes near a promise there either.
TEST(Check, drawsNoErrorsOfExactSurfaces) {
    const TemporaryFolder folder;
    for (const std::string caps : {"", "--end-caps gregory --isolation 6"}) {
        expectDone(relief({"check", cagePath("cube"), "--heatmap", folder / "heat.png"},
                          "--rate 1 --path grid --points 2000 -q " + caps));
        EXPECT_EQ(tintsOf(folder / "heat.png", 0.05f).orange, 0) << caps;
    }
}

TEST(Check, drawsTriangularFaces) {
    const TemporaryFolder folder;
    putFile(folder / "octahedron.obj",
            "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n"
            "f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    const Outcome outcome = relief({"check", folder / "octahedron.obj", "--heatmap", folder / "heat.exr"},
                                   "--scheme loop --rate 1 --path grid --points 800 -q");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Image image = readImage(folder / "heat.exr");
    int covered = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) covered += image.at(x, y)[3] == 1;
    EXPECT_GT(covered, 300'000);
}

TEST(Check, readsAsText) {
    const Outcome outcome = relief({"check", cagePath("lantern")}, "--rate 3 --path dice --points 5000");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.out.starts_with(cagePath("lantern") + " on ")) << outcome.out;
    for (const char* part : {"\nwatertight\n", "\n  dice ", "\nexact", "everywhere", " of "})
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
    expectRefused(relief({"check", folder / "missing.obj", "--heatmap", "heat.jpg"}), Failure::usage,
                  {"heat.jpg", ".png or .exr"});
    expectRefused(relief({"check", cagePath("cube"), "--points", "0"}), Failure::usage, {"--points"});
    expectRefused(relief({"check", cagePath("cube"), "--rate", "0"}), Failure::usage, {"1..64"});
}

} // namespace
} // namespace relief::test
