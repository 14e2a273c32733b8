// relief geometry-image, and the verbs that read what it writes.
#include "program.h"

namespace relief::test {
namespace {

/// A geometry image of a torus with waves, made once for all tests.
const TemporaryFolder& madeImage() {
    static const TemporaryFolder folder;
    static const bool isMade = [] {
        writeImage(folder / "waves.exr", sineImage(64, 4), SampleType::real);
        const Outcome outcome = relief(
            {"geometry-image", cagePath("torus"), "--height", folder / "waves.exr", "-o", folder / "gi.exr", "--json"},
            "--scale 0.03 --size 65 --rate 12");
        putFile(folder / "report.json", outcome.out);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return true;
    }();
    EXPECT_TRUE(isMade);
    return folder;
}

TEST(GeometryImageVerb, statesItsErrorAndThatItIsClosed) {
    const nlohmann::json report = nlohmann::json::parse(readFile(madeImage() / "report.json"));
    EXPECT_EQ(report["genus"], 1);
    EXPECT_EQ(report["boundaries"], 0);
    EXPECT_EQ(report["size"], 65);
    EXPECT_EQ(report["open_edges"], nlohmann::json::array({0, 0, 0, 0}));
    EXPECT_EQ(report["triangles"], 2 * 64 * 64);
    EXPECT_EQ(report["turned_triangles"], 0);
    for (const char* way : {"image_to_source", "source_to_image"}) {
        EXPECT_GT(report[way]["rms_percent"], 0.0);
        EXPECT_LT(report[way]["rms_percent"], 0.1);
        EXPECT_LE(report[way]["rms"], report[way]["max"]);
    }
}

// The exported mesh is the source again: it is measured by making an image of it.
TEST(GeometryImageVerb, exportsAMeshThatIsReadBack) {
    const TemporaryFolder& folder = madeImage();
    expectDone(relief({"export", folder / "gi.exr", "-o", folder / "mesh.ply"}, "-q --mip 1"));
    const nlohmann::json report = jsonOf(
        relief({"geometry-image", folder / "mesh.ply", "-o", folder / "again.exr", "--json"}, "--size 65 --half"));
    EXPECT_EQ(report["source_triangles"], 2 * 32 * 32);
    EXPECT_EQ(report["genus"], 1);
    EXPECT_LT(report["rms"].get<double>() / report["diagonal"].get<double>(), 2e-3);
}

TEST(GeometryImageVerb, isDrawnAtTheMipThatFits) {
    const TemporaryFolder& folder = madeImage();
    const auto trianglesOf = [&](const std::string& options) {
        return jsonOf(relief({"render", folder / "gi.exr", "-o", folder / "p.png", "--json"}, options))["triangles"];
    };
    EXPECT_EQ(trianglesOf("--size 400,400"), 2 * 64 * 64);
    EXPECT_LE(trianglesOf("--size 12,12"), 2 * 32 * 32);
    EXPECT_EQ(trianglesOf("--size 12,12 --mip 0"), 2 * 64 * 64);
    const nlohmann::json info = jsonOf(relief({"info", folder / "gi.exr", "--json"}))[0];
    EXPECT_EQ(info["geometry_image_mips"], 4);
    EXPECT_EQ(info["mesh_open_edges"], nlohmann::json::array({0, 0, 0, 0}));
}

TEST(GeometryImageVerb, refusesInOneLine) {
    const TemporaryFolder& folder = madeImage();
    const std::string out = folder / "no.exr";
    expectRefused(relief({"geometry-image", cagePath("torus"), "-o", folder / "no.png"}), Failure::usage, {".exr"});
    expectRefused(relief({"geometry-image", folder / "none.ply", "-o", out}), Failure::file, {"none.ply"});
    expectRefused(relief({"geometry-image", cagePath("torus"), "-o", out}, "--size 9"), Failure::usage, {"--size"});
    putFile(folder / "two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n");
    expectRefused(relief({"geometry-image", folder / "two.obj", "-o", out}), Failure::input, {"2 parts"});
    EXPECT_FALSE(std::filesystem::exists(out));
    for (const char* verb : {"render", "export"}) {
        const std::string target = folder / (std::string(verb) == "render" ? "no.png" : "no.ply");
        expectRefused(relief({verb, folder / "waves.exr", "-o", target}), Failure::input, {"no geometry image"});
        expectRefused(relief({verb, folder / "gi.exr", "-o", target}, "--mip 7"), Failure::usage, {"0 to 3"});
    }
    expectRefused(relief({"render", cagePath("torus"), "-o", folder / "no.png"}, "--mip 1"), Failure::usage, {"--mip"});
    // What geometry images do not have.
    expectRefused(relief({"export", folder / "gi.exr", "-o", folder / "no.ply"}, "--isolation 3"), Failure::usage,
                  {"--isolation is for cages"});
    expectRefused(relief({"export", folder / "gi.exr", "-o", folder / "no.ply"}, "--mip 1 --edge-pixels 2 -q"),
                  Failure::usage, {"--edge-pixels is for cages"});
    expectRefused(relief({"animate", folder / "gi.exr", "-o", folder / "no.pc2"}, "--deform twist(angle=30)"),
                  Failure::usage, {"a geometry image is not"});
    for (const char* name : {"no.ply", "no.pc2"}) EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
    // A full disk leaves what was there, the picture of normals as well.
    putFile(folder / "old.exr", "an old image");
    putFile(folder / "old.png", "an old picture");
    expectRefused(shell("ulimit -f 16; exec \"$RELIEF\" geometry-image $IN/gi.exr -o $IN/old.exr --picture "
                        "$IN/old.png -q --size 65",
                        folder),
                  Failure::file, {"old.exr", "cannot be written"});
    EXPECT_EQ(readFile(folder / "old.exr"), "an old image");
    EXPECT_EQ(readFile(folder / "old.png"), "an old picture");
    // Not within the tolerance: the image is there all the same.
    const Outcome far = relief({"geometry-image", folder / "gi.exr", "-o", out}, "-q --size 17 --tolerance 1e-6");
    EXPECT_EQ(far.exitCode, int(Failure::check)) << far.err;
    EXPECT_TRUE(std::filesystem::exists(out));
}

} // namespace
} // namespace relief::test
