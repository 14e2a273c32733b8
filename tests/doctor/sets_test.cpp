// The doctor on sets of tiles and on maps per face.
#include "patients.h"

namespace relief::test {
namespace {

using DoctorOnSets = DoctorOnMaps;

// Of a set each tile is a patient of its own; what several have is one finding.
TEST_F(DoctorOnSets, examinesSetsOfTiles) {
    Cage cage = torusWithSeams();
    for (vec2& st : cage.texCoords) st = vec2(0.1f + 1.8f * st.x, 0.1f + 0.8f * st.y); // the island crosses the border
    const Patient patient(cage);
    const auto tile = [](int place) {
        return mapOf(96, 64, [&](double s, double t) { return waves((s + place - 0.1) / 1.8, (t - 0.1) / 0.8); });
    };
    const auto put = [&](const std::string& name, const Image& image, SampleType type = SampleType::real) {
        writeImage(folder / name, image, type);
    };
    const auto examineSet = [&](const std::string& name) {
        return examine(patient, folder / (name + ".<UDIM>." + (name == "bits" ? "png" : "exr")), {}, 0.2);
    };
    put("good.1001.exr", tile(0)), put("good.1002.exr", tile(1));
    const Examination good = examineSet("good");
    expectSilent(good);
    EXPECT_EQ(listRendererSettings(good, 1)[0].value, "UDIM Tiles");

    put("bits.1001.png", centred(tile(0)), SampleType::uint16),
        put("bits.1002.png", centred(tile(1)), SampleType::uint8);
    const Examination bits = examineSet("bits");
    expectFound(FindingKind::bitDepth, bits);
    EXPECT_TRUE(only(bits).text.starts_with("tile 1002: ")) << only(bits).text;

    put("mid.1001.exr", changed(tile(0), [](double h) { return 0.4 + h; }));
    put("mid.1002.exr", changed(tile(1), [](double h) { return 0.4 + h; }));
    const Examination mid = examineSet("mid");
    expectFound(FindingKind::midlevel, mid);
    EXPECT_TRUE(only(mid).text.starts_with("tile 1001 and 1 more: ")) << only(mid).text;

    put("gone.1001.exr", tile(0));
    const Examination gone = examineSet("gone");
    const auto outside = std::ranges::find(gone.findings, FindingKind::outside, &Finding::kind);
    ASSERT_NE(outside, gone.findings.end());
    EXPECT_FALSE(outside->isFault);
    EXPECT_NEAR(outside->figure, 0.5, 0.02);

    put("swapped.1001.exr", tile(1)), put("swapped.1002.exr", tile(0));
    EXPECT_FALSE(examineSet("swapped").isHealthy()) << "the sides of seams disagree";
    EXPECT_GT(drawFindings(examineSet("swapped"), patient.subject(), 128).texels.size(), 0u);
}

TEST_F(DoctorOnSets, examinesVectorsInTiles) {
    Image image{.width = 32, .height = 32, .channels = 3, .texels = {}};
    for (const float h : mapOf(32, 32, bumps).texels) image.texels.insert(image.texels.end(), {0, h, 0});
    writeImage(folder / "v.1001.exr", image, SampleType::real);
    const auto examined = [&](const std::string& order) {
        return examineMap(
            folder / "v.<UDIM>.exr",
            {.height = {.scale = 1, .limits = {}}, .vectors = VectorOptions{.order = order, .limits = {}}},
            torusPatient().subject());
    };
    EXPECT_TRUE(examined("xzy").isHealthy());
    expectFound(FindingKind::axes, examined("xyz"), false);
}

TEST_F(DoctorOnSets, examinesMapsPerFace) {
    const Patient& torus = torusPatient();
    DoctorSubject subject = torus.subject();
    subject.topology = hashTopology(torus.cage);
    const auto examined = [&](double mid, double scale, std::uint64_t topology) {
        HeightMap map = makeFaceMap(torus.surface, std::vector<ivec2>(torus.surface.faces.size(), ivec2(3)),
                                    [&](int face, const dvec2& uv) {
                                        const dvec2 st = torus.reference.texture(face, uv).st;
                                        return mid + waves(st.x, st.y);
                                    });
        map.topology = topology;
        const std::string path = folder / fmt::format("faces{}.exr", count++);
        saveFaceMap(path, map);
        return examineMap(path, {.height = {.scale = scale, .limits = {}}}, subject);
    };
    expectSilent(examined(0, 1, subject.topology));
    expectFound(FindingKind::midlevel, examined(0.4, 1, subject.topology));
    const Examination folded = examined(0, 30, subject.topology);
    expectFound(FindingKind::fold, folded);
    EXPECT_GT(drawFindings(folded, subject, 128).texels.size(), 0u);
    EXPECT_NE(listRendererSettings(folded, 1)[0].value.find("relief map"), std::string::npos);
    expectFailure(Failure::input, {"another cage"}, [&] { examined(0, 1, 5); });
}

} // namespace
} // namespace relief::test
