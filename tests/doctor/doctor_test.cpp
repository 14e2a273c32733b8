// The doctor finds each fault that is planted in a small map, and says nothing of good ones.
#include "patients.h"

namespace relief::test {
namespace {

TEST_F(DoctorOnMaps, isSilentOnGoodOnes) {
    const Patient &torus = torusPatient(), &cube = cubePatient();
    const Image wavy = mapOf(96, 64, waves), bumpy = mapOf(96, 96, bumps);
    expectSilent(examine(torus, writeFloat(wavy)));
    expectSilent(examine(torus, write16(centred(wavy)), {}, 0.2));
    expectSilent(examine(torus, write(wavy, SampleType::half, ".exr")));
    expectSilent(examine(torus, writeFloat(bumpy)));
    expectSilent(examine(torus, write16(centred(bumpy)), {}, 0.2));
    expectSilent(examine(torus, write16(changed(bumpy, [](double h) { return 10 * h; })), 0, 0.1));
    expectSilent(examine(Patient(triangleTorus(), Scheme::loop), writeFloat(wavy)));
    const Image swell = bakedOnCube(192, swellAt), knobs = bakedOnCube(192, knobAt);
    expectSilent(examine(cube, writeFloat(swell)));
    expectSilent(examine(cube, write(centred(swell), SampleType::uint16, ".tif"), {}, 0.2));
    expectSilent(examine(cube, writeFloat(knobs)));
    std::mt19937 random(3);
    const Image noise = mapOf(64, 64, [&](double, double) { return 0.01 * (double(random() % 4096) / 2048 - 1); });
    expectSilent(
        examine(Patient(boundaryGrid()), write16(changed(noise, [](double h) { return 0.5 + 40 * h; })), {}, 0.02));
}

TEST_F(DoctorOnMaps, findsMidlevels) {
    const Patient& torus = torusPatient();
    const Examination raised =
        examine(torus, writeFloat(changed(mapOf(96, 96, bumps), [](double h) { return 0.5 + h; })));
    expectFound(FindingKind::midlevel, raised);
    EXPECT_NEAR(only(raised).figure, 0.5, 1e-3);
    EXPECT_EQ(only(raised).advice, "--mid 0.5");
    const Examination black =
        examine(torus, write16(changed(mapOf(96, 96, bumps), [](double h) { return 8 * h; })), {}, 0.1);
    expectFound(FindingKind::midlevel, black);
    EXPECT_NEAR(only(black).figure, 0, 1e-3);
    expectFound(FindingKind::midlevel,
                examine(torus, writeFloat(changed(mapOf(96, 64, waves), [](double h) { return 0.4 + h; }))));
}

TEST_F(DoctorOnMaps, examinesVectors) {
    const Image heights = mapOf(96, 96, bumps);
    /// The heights in one of three channels, around a midlevel.
    const auto vectorsIn = [&](int channel, float mid) {
        Image image{.width = 96, .height = 96, .channels = 3, .texels = {}};
        for (const float h : heights.texels)
            for (int k = 0; k < 3; ++k) image.texels.push_back(mid + (k == channel ? h : 0));
        return writeFloat(image);
    };
    const auto examined = [&](const std::string& path, const std::string& order) {
        return examineMap(
            path, {.height = {.scale = 1, .limits = {}}, .vectors = VectorOptions{.order = order, .limits = {}}},
            torusPatient().subject());
    };
    const Examination good = examined(vectorsIn(2, 0), "xyz");
    expectSilent(good);
    EXPECT_EQ(listRendererSettings(good, 1)[2].value, "R, B, G") << "Blender has the normal in green";
    EXPECT_EQ(listRendererSettings(good, 1)[3].value, "Tangent Space");
    expectSilent(examined(vectorsIn(1, 0), "xzy"));
    expectFound(FindingKind::axes, examined(vectorsIn(1, 0), "xyz"), false);
    expectFound(FindingKind::midlevel, examined(vectorsIn(2, 0.5f), "xyz"));
    const Examination steep = examineMap(
        vectorsIn(2, 0), {.height = {.scale = 30, .limits = {}}, .vectors = VectorOptions{}}, torusPatient().subject());
    expectFound(FindingKind::fold, steep, false);
    const auto countRed = [](const Image& picture) {
        int count = 0;
        for (int y = 0; y < 128; ++y) // above the legend
            for (int x = 0; x < 128; ++x) count += picture.at(x, y)[0] > picture.at(x, y)[1] + 0.3f ? 1 : 0;
        return count;
    };
    EXPECT_EQ(countRed(drawFindings(good, torusPatient().subject(), 128)), 0);
    EXPECT_GT(countRed(drawFindings(steep, torusPatient().subject(), 128)), 10);
}

TEST_F(DoctorOnMaps, findsSigns) {
    const Patient& torus = torusPatient();
    const Image wrapped = changed(mapOf(96, 64, waves), [](double h) { return h < 0 ? h + 65536.0 / 65535 : h; });
    expectFound(FindingKind::sign, examine(torus, write16(wrapped), 0, 0.01));
    expectFound(FindingKind::sign, examine(torus, writeFloat(mapOf(96, 96, bumps)), {}, -1), false);
}

TEST_F(DoctorOnMaps, findsFewBits) {
    const Patient& torus = torusPatient();
    const Image map = centred(mapOf(96, 64, waves));
    const struct {
        std::string path;
        double bits;
    } cases[] = {
        {write(map, SampleType::uint8, ".png"), 8},
        {write16(inSteps(map, 255, 257)), 8},
        {write16(inSteps(map, 1023, 64)), 10},
        {writeFloat(changed(map, [](double x) { return std::lround(255 * x) / 255.0; })), 8},
        {write16(changed(map, [](double x) { return 0.5 + (x - 0.5) / 256; })), 7.01},
    };
    for (const auto& [path, bits] : cases) {
        const Examination found = examine(torus, path, 0.5, 0.2);
        expectFound(FindingKind::bitDepth, found);
        EXPECT_NEAR(only(found).figure, bits, 0.02) << only(found).text;
    }
}

TEST_F(DoctorOnMaps, findsHeightsThatAreColors) {
    const Patient& torus = torusPatient();
    const auto decode = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
    const auto encode = [](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; };
    const Image map = centred(mapOf(96, 64, waves)), flat = centred(mapOf(96, 96, bumps));
    const auto decoded8 = [&](double x) { return decode(std::lround(255 * x) / 255.0); };
    expectFound(FindingKind::colors, examine(torus, writeFloat(changed(map, decoded8)), 0.214, 0.2));
    expectFound(FindingKind::colors, examine(torus, write16(changed(flat, encode)), {}, 0.2));
    expectFound(FindingKind::colors, examine(torus, write16(changed(flat, decode)), {}, 0.2));
    using namespace std::string_literals;
    std::string bytes = readFile(write16(map));
    bytes.insert(33, "\0\0\0\1sRGB\0\xae\xce\x1c\xe9"s); // behind the header
    putFile(folder / "tagged.png", bytes);
    expectFound(FindingKind::colors, examine(torus, folder / "tagged.png", {}, 0.2), false);
}

TEST_F(DoctorOnMaps, findsFlips) {
    const Image map = bakedOnCube(192, swellAt);
    const int last = map.width - 1;
    const struct {
        Image image;
        const char* name;
    } cases[] = {
        {moved(map, [&](int x, int y) { return ivec2(last - x, y); }), "mirrored along s"},
        {moved(map, [&](int x, int y) { return ivec2(x, last - y); }), "mirrored along t"},
        {moved(map, [&](int x, int y) { return ivec2(last - x, last - y); }), "half a turn"},
        {moved(map, [&](int x, int y) { return ivec2(last - y, last - x); }), "s and t exchanged"},
    };
    for (const auto& [image, name] : cases) {
        const Examination found = examine(cubePatient(), writeFloat(image));
        expectFound(FindingKind::flip, found);
        EXPECT_NE(only(found).text.find(name), std::string::npos) << only(found).text;
    }
    // Without seams: what is painted lies outside of the islands.
    Cage corner = boundaryGrid();
    for (vec2& st : corner.texCoords) st = 0.1f + 0.3f * st;
    const auto painted = [](double s, double t) {
        return std::min(s, t) > 0.09 && std::max(s, t) < 0.41 ? waves(3 * s, 3 * t) : 0.0;
    };
    const Image good = mapOf(96, 96, painted);
    const Patient patient(corner);
    expectSilent(examine(patient, writeFloat(good)));
    expectFound(FindingKind::flip,
                examine(patient, writeFloat(moved(good, [](int x, int y) { return ivec2(x, 95 - y); }))));
}

TEST_F(DoctorOnMaps, findsSeamsAndSaysWhere) {
    Image map = bakedOnCube(192, swellAt);
    for (int y = 128; y < 192; ++y) // the first island: lower left
        for (int x = 0; x < 64; ++x) *map.at(x, y) += 0.04f;
    const Examination found = examine(cubePatient(), writeFloat(map));
    expectFound(FindingKind::seam, found);
    EXPECT_NEAR(only(found).figure, 0.04, 2e-3);
    EXPECT_NE(only(found).text.find("on 4 of 12 edges"), std::string::npos) << only(found).text;
}

TEST_F(DoctorOnMaps, findsIslandsWithoutHeights) {
    Image map = bakedOnCube(192, swellAt);
    for (int y = 128; y < 192; ++y)
        for (int x = 0; x < 64; ++x) *map.at(x, y) = 0.02f;
    const Examination found = examine(cubePatient(), writeFloat(map));
    bool isFound = false;
    for (const Finding& finding : found.findings) {
        EXPECT_TRUE(finding.kind == FindingKind::island || finding.kind == FindingKind::seam) << finding.text;
        if (finding.kind == FindingKind::island) isFound = finding.isFault && finding.figure == 1;
    }
    EXPECT_TRUE(isFound);
}

TEST_F(DoctorOnMaps, findsLayoutsThatDoNotFit) {
    const std::string path = writeFloat(mapOf(96, 64, [](double, double) { return 0.01; }));
    Cage twice = torusWithSeams();
    for (vec2& st : twice.texCoords) st *= 2.0f;
    const std::string wavy = writeFloat(mapOf(96, 64, waves));
    expectFound(FindingKind::outside, examine(Patient(twice), wavy));
    const Patient wide(twice);
    expectSilent(examineMap(wavy, {.height = {.limits = {}}, .namesWrap = true}, wide.subject()));
    Cage pinched = torusWithSeams();
    for (vec2& st : pinched.texCoords) st.x = std::pow(st.x, 4.0f);
    expectFound(FindingKind::stretch, examine(Patient(pinched), wavy));
}

TEST_F(DoctorOnMaps, findsFoldsAndAScaleWithoutThem) {
    const std::string path = writeFloat(mapOf(96, 64, waves));
    const Examination found = examine(torusPatient(), path, {}, 30);
    expectFound(FindingKind::fold, found);
    const Finding& fold = only(found);
    EXPECT_LT(fold.figure, 0);
    const double scale = std::stod(fold.advice.substr(fold.advice.find("--scale ") + 8));
    expectSilent(examine(torusPatient(), path, {}, scale));
    expectFound(FindingKind::fold, examine(torusPatient(), path, {}, scale / 0.85));
}

TEST_F(DoctorOnMaps, findsWhatIsMissing) {
    Image holes = mapOf(96, 64, waves);
    for (int x = 10; x < 30; ++x) *holes.at(x, 20) = -9999;
    const Examination voids = examine(torusPatient(), writeFloat(holes));
    expectFound(FindingKind::voids, voids);
    EXPECT_EQ(only(voids).figure, 20);
    const std::string integers = write16(centred(mapOf(96, 64, waves)));
    const Examination bare = examineMap(integers, {.height = {.limits = {}}}, torusPatient().subject());
    EXPECT_EQ(bare.findings.front().kind, FindingKind::scale);
    Image two{.width = 96, .height = 64, .channels = 2, .texels = {}};
    for (const float h : mapOf(96, 64, waves).texels) two.texels.insert(two.texels.end(), {h, -h});
    writeImage(folder / "two.exr", two, {{"skin.R"}, {"pores.R"}});
    expectFound(FindingKind::channel, examine(torusPatient(), folder / "two.exr"), false);
}

TEST_F(DoctorOnMaps, drawsWhatItFinds) {
    Image map = bakedOnCube(192, swellAt);
    for (int y = 128; y < 192; ++y)
        for (int x = 0; x < 64; ++x) *map.at(x, y) = 0.02f;
    const Examination found = examine(cubePatient(), writeFloat(map));
    const Image picture = drawFindings(found, cubePatient().subject(), 240);
    const auto share = [&](int left, int top, const auto& isColor) {
        int hits = 0;
        for (int y = top; y < top + 80; ++y)
            for (int x = left; x < left + 80; ++x) hits += isColor(picture.at(x, y)) ? 1 : 0;
        return hits / 6400.0;
    };
    const auto isBlue = [](const float* c) { return c[2] > c[0] + 0.2f && c[2] > c[1] + 0.1f; };
    const auto isMagenta = [](const float* c) { return c[0] > 0.6f && c[2] > 0.6f && c[1] < 0.45f; };
    EXPECT_GT(share(0, 160, isBlue), 0.1) << "the first island, lower left";
    EXPECT_LT(share(80, 160, isBlue), 0.01);
    EXPECT_GT(share(0, 160, isMagenta), 0.01);
    EXPECT_LT(share(160, 0, isMagenta), 0.001) << "no island there";
}

TEST_F(DoctorOnMaps, saysWhatOtherRenderersNeed) {
    const Examination map = examine(torusPatient(), write16(centred(mapOf(96, 64, waves))), 0.25, 0.2);
    const auto valueOf = [&](const std::string& renderer, const std::string& name) {
        for (const RendererSetting& setting : listRendererSettings(map, 1))
            if (setting.renderer == renderer && setting.name.find(name) != std::string::npos) return setting.value;
        return std::string();
    };
    EXPECT_EQ(valueOf("blender", "Midlevel"), "0.25");
    EXPECT_EQ(valueOf("blender", "Scale"), "0.2");
    EXPECT_EQ(valueOf("arnold", "disp_zero_value"), "0.25");
    EXPECT_EQ(valueOf("arnold", "disp_height"), "0.2");
    // scale * (x - mid) = colorScale * x + colorOffset
    EXPECT_EQ(valueOf("renderman", "colorScale"), "0.2");
    EXPECT_EQ(valueOf("renderman", "colorOffset"), "-0.05");
    EXPECT_NEAR(std::stod(valueOf("renderman", "displacementbound")), map.bound, 1e-6);
    EXPECT_EQ(valueOf("arnold", "disp_padding"), valueOf("renderman", "displacementbound"));
    EXPECT_EQ(valueOf("blender", "Subdivision"), "Catmull-Clark, adaptive");

    // Of the three RenderMan alone has Loop's scheme.
    Examination loop = map;
    loop.scheme = Scheme::loop;
    for (const RendererSetting& setting : listRendererSettings(loop, 1)) {
        if (setting.name.find("ubdiv") == std::string::npos) continue;
        const std::string expected = setting.renderer == "renderman" ? "loop" : "none: it has no Loop subdivision";
        EXPECT_EQ(setting.value, expected) << setting.renderer;
    }
}

} // namespace
} // namespace relief::test
