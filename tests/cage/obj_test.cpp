// What OBJ files may hold, and what comes of it.
#include <cmath>
#include <limits>

#include "cage/square.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

Cage parse(const std::string& text) {
    Warnings warnings;
    Cage cage = parseObj(text, "test.obj", warnings.warn());
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
    return cage;
}

void expectSame(const Cage& a, const Cage& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.faceSizes, b.faceSizes);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.texCoords, b.texCoords);
    EXPECT_EQ(a.texCorners, b.texCorners);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.normalCorners, b.normalCorners);
    EXPECT_EQ(a.creaseEdges, b.creaseEdges);
    EXPECT_EQ(a.creaseSharpness, b.creaseSharpness);
    EXPECT_EQ(a.sharpVertices, b.sharpVertices);
    EXPECT_EQ(a.vertexSharpness, b.vertexSharpness);
    EXPECT_EQ(a.holes, b.holes);
    EXPECT_EQ(a.boundaryRule, b.boundaryRule);
    EXPECT_EQ(a.texBoundaryRule, b.texBoundaryRule);
    EXPECT_EQ(a.creaseMethod, b.creaseMethod);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t i = 0; i < a.parts.size(); ++i) {
        EXPECT_EQ(a.parts[i].name, b.parts[i].name);
        EXPECT_EQ(a.parts[i].material, b.parts[i].material);
        EXPECT_EQ(a.parts[i].firstFace, b.parts[i].firstFace);
        EXPECT_EQ(a.parts[i].faceCount, b.parts[i].faceCount);
    }
}

TEST(ObjLoader, readsASquare) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\n");
    EXPECT_EQ(cage.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(cage.faceSizes, Indices{4});
    EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 3}));
    EXPECT_FALSE(cage.hasTexCoords());
    EXPECT_TRUE(cage.parts.empty());
}

TEST(ObjLoader, readsNumbersInAllSpellings) {
    const Cage cage = parse("v +1.5 -.25 1e-3\nv 2. 1E+2 -0\nv 0.1 1234567 -7e5\nf 1 2 3\n");
    EXPECT_EQ(cage.positions, (std::vector<vec3>{{1.5f, -0.25f, 1e-3f}, {2, 100, 0}, {0.1f, 1234567, -7e5f}}));
}

TEST(ObjLoader, readsTextureCoordinatesAndNormals) {
    const Cage cage = parse(kSquare + "vt 0 0\nvt 1 0.5\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1 4/2/1\n");
    EXPECT_EQ(cage.texCoords, (std::vector<vec2>{{0, 0}, {1, 0.5f}}));
    EXPECT_EQ(cage.texCorners, (Indices{0, 1, 0, 1}));
    EXPECT_EQ(cage.normals, (std::vector<vec3>{{0, 0, 1}}));
    EXPECT_EQ(cage.normalCorners, (Indices{0, 0, 0, 0}));
}

TEST(ObjLoader, readsCornersWithEmptyFields) {
    const Cage normals = parse(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
    EXPECT_FALSE(normals.hasTexCoords());
    EXPECT_EQ(normals.normalCorners, (Indices{0, 0, 0, 0}));
    const Cage nothing = parse(kSquare + "f 1// 2// 3/ 4\n");
    EXPECT_EQ(nothing.corners, (Indices{0, 1, 2, 3}));
    EXPECT_TRUE(nothing.normalCorners.empty());
}

TEST(ObjLoader, dropsTextureCoordinatesThatNoFaceUses) {
    EXPECT_TRUE(parse(kSquare + "vt 0 0\nf 1 2 3 4\n").texCoords.empty());
}

TEST(ObjLoader, resolvesNegativeIndicesAgainstTheCountAtTheirLine) {
    const Cage cage =
        parse(kSquare + "vt 0 0\nvt 1 0\nf -4/-2 -3/-1 -2/-1 -1/-1\n" + kSquare + "f -4/1 -3/2 -2/2 -1/2\n");
    EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(cage.texCorners, (Indices{0, 1, 1, 1, 0, 1, 1, 1}));
}

TEST(ObjLoader, facesMayComeBeforeTheirVertices) {
    EXPECT_EQ(parse("f 1 2 3 4\n" + kSquare).corners, (Indices{0, 1, 2, 3}));
}

TEST(ObjLoader, readsPolygonsOfManyCorners) {
    for (const int sides : {5, 255, 256, 300, 1000}) {
        std::string text, face = "f";
        for (int k = 0; k < sides; ++k) text += fmt::format("v {} 0 0\n", k), face += fmt::format(" {}", k + 1);
        const Cage cage = parse(text + face + "\n");
        EXPECT_EQ(cage.faceSizes, Indices{std::uint32_t(sides)});
        EXPECT_EQ(cage.corners.back(), std::uint32_t(sides - 1));
    }
}

TEST(ObjLoader, neverTriangulates) {
    const Cage cage = parse(kSquare + "v 2 2 0\nf 1 2 3 4\nf 1 2 3\nf 1 2 3 4 5\n");
    EXPECT_EQ(cage.faceSizes, (Indices{4, 3, 5}));
}

TEST(ObjLoader, stripsTheByteOrderMark) {
    const Cage cage = parse("\xef\xbb\xbf" + kSquare + "f 1 2 3 4\n");
    EXPECT_EQ(cage.positions.size(), 4u);
}

TEST(ObjLoader, joinsContinuedLines) {
    const Cage cage = parse("v 0 \\\n0 0\nv 1 0 0\r\nv 1 1 0\nv 0 1 0\nf 1 2\\\n 3 \\\r\n 4\n");
    EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(parse(kSquare + "f 1 2 3 4 \\").corners, (Indices{0, 1, 2, 3}));
}

TEST(ObjLoader, aCommentDoesNotContinue) {
    EXPECT_EQ(parse("# made in C:\\\n" + kSquare + "f 1 2 3 4\n").positions.size(), 4u);
    EXPECT_EQ(parse("v 0 0 0 # C:\\\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").positions.size(), 3u);
}

TEST(ObjLoader, acceptsAllLineEnds) {
    const std::string text = kSquare + "f 1 2 3 4\n";
    for (const std::string end : {"\r\n", "\r", "\n\n"}) {
        std::string changed;
        for (const char letter : text) changed += letter == '\n' ? end : std::string(1, letter);
        expectSame(parse(changed), parse(text));
    }
    expectSame(parse(kSquare + "f 1 2 3 4"), parse(text));
}

TEST(ObjLoader, ignoresCommentsAndSpaces) {
    const Cage cage = parse("# c\n\t v  0\t0 0   # first\nv 1 0 0\nv 1 1 0\n\nv 0 1 0\n  f  1 2 3 4 # 5 6\n");
    EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(cage.positions[0], vec3(0));
}

TEST(ObjLoader, ignoresColoursWeightsAndDepths) {
    const Cage cage = parse("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nvt 0.5\nvt 0 1 0\nf 1/1 2/2 3/1\n");
    EXPECT_EQ(cage.positions[1], vec3(1, 0, 0));
    EXPECT_EQ(cage.texCoords, (std::vector<vec2>{{0.5f, 0}, {0, 1}}));
}

TEST(ObjLoader, coincidentPositionsAreAllowed) { EXPECT_NO_THROW(parse("v 0 0 0\nv 0 0 0\nv 1 1 0\nf 1 2 3\n")); }

TEST(ObjLoader, keepsObjectsGroupsAndMaterialsAsParts) {
    const Cage cage =
        parse(kSquare + "f 1 2 3\no Left hand\nusemtl skin\nf 1 2 3 4\nf 4 3 2 1\ng finger nail\nf 1 2 4\n"
                        "usemtl horn\nf 2 3 4\no\nf 1 3 4\n");
    ASSERT_EQ(cage.parts.size(), 5u);
    const auto expectPart = [&](std::size_t i, const std::string& name, const std::string& material, Indices range) {
        EXPECT_EQ(cage.parts[i].name, name);
        EXPECT_EQ(cage.parts[i].material, material);
        EXPECT_EQ(cage.parts[i].firstFace, range[0]);
        EXPECT_EQ(cage.parts[i].faceCount, range[1]);
    };
    expectPart(0, "", "", {0, 1});
    expectPart(1, "Left hand", "skin", {1, 2});
    expectPart(2, "finger nail", "skin", {3, 1});
    expectPart(3, "finger nail", "horn", {4, 1});
    expectPart(4, "", "horn", {5, 1});
}

TEST(ObjLoader, objectsWithoutFacesAreNoParts) {
    const Cage cage = parse("o empty\n" + kSquare + "o full\nf 1 2 3 4\no last\n");
    ASSERT_EQ(cage.parts.size(), 1u);
    EXPECT_EQ(cage.parts[0].name, "full");
}

TEST(ObjLoader, readsAllTags) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\nf 4 3 2 1\n"
                                      "t crease 2/1/0 0 1 2.5\nt crease 2/1/0 3 2 10\nt corner 1/1/0 3 4\n"
                                      "t hole 1/0/0 1\nt interpolateboundary 1/0/0 1\n"
                                      "t facevaryinginterpolateboundary 1/0/0 5\nt creasemethod 0/0/1 chaikin\n");
    EXPECT_EQ(cage.creaseEdges, (Indices{0, 1, 3, 2}));
    EXPECT_EQ(cage.creaseSharpness, (std::vector<float>{2.5f, 10}));
    EXPECT_EQ(cage.sharpVertices, (Indices{3}));
    EXPECT_EQ(cage.vertexSharpness, (std::vector<float>{4}));
    EXPECT_EQ(cage.holes, Indices{1});
    EXPECT_EQ(cage.boundaryRule, BoundaryRule::edgeAndCorner);
    EXPECT_EQ(cage.texBoundaryRule, TexBoundaryRule::all);
    EXPECT_EQ(cage.creaseMethod, CreaseMethod::chaikin);
}

TEST(ObjLoader, cornersShareOneSharpnessOrHaveOneEach) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\nt corner 2/1/0 0 1 0.5\nt corner 2/2/0 2 3 1 2\n");
    EXPECT_EQ(cage.sharpVertices, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(cage.vertexSharpness, (std::vector<float>{0.5f, 0.5f, 1, 2}));
}

TEST(ObjLoader, withoutTagsTheRulesAreOpenSubdivsDefaults) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\n");
    EXPECT_EQ(cage.boundaryRule, BoundaryRule::edgeOnly);
    EXPECT_EQ(cage.texBoundaryRule, TexBoundaryRule::cornersPlus1);
    EXPECT_EQ(cage.creaseMethod, CreaseMethod::uniform);
}

TEST(ObjLoader, tagsMayComeBeforeTheirFaces) {
    EXPECT_EQ(parse("t crease 2/1/0 0 1 3\n" + kSquare + "f 1 2 3 4\n").creaseSharpness.size(), 1u);
}

TEST(ObjLoader, tagsOfOneObjectDoNotRepeatInTheNext) {
    const Cage cage = parse("o a\n" + kSquare + "f 1 2 3 4\nt crease 2/1/0 0 1 3\nt hole 1/0/0 0\no b\n" + kSquare +
                            "f 5 6 7 8\nt crease 2/1/0 4 5 2\nt corner 1/1/0 7 1\no c\nf 1 2 6 5\n");
    EXPECT_EQ(cage.creaseEdges, (Indices{0, 1, 4, 5}));
    EXPECT_EQ(cage.creaseSharpness, (std::vector<float>{3, 2}));
    EXPECT_EQ(cage.sharpVertices, Indices{7});
    EXPECT_EQ(cage.holes, Indices{0});
    EXPECT_EQ(cage.parts.size(), 3u);
}

TEST(ObjLoader, oneTagMayNameSeveralHoles) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\nf 1 2 3\nf 2 3 4\nt hole 2/0/0 2 0\nt hole 1/0/0 2\n");
    EXPECT_EQ(cage.holes, (Indices{0, 2}));
}

TEST(ObjLoader, theLastSharpnessOfAnEdgeOrVertexHolds) {
    const Cage cage = parse(kSquare + "f 1 2 3 4\nt crease 2/1/0 0 1 3\nt crease 2/1/0 1 0 5\nt corner 1/1/0 2 1\n"
                                      "t corner 1/1/0 2 2\n");
    EXPECT_EQ(cage.creaseEdges, (Indices{0, 1}));
    EXPECT_EQ(cage.creaseSharpness, (std::vector<float>{5}));
    EXPECT_EQ(cage.vertexSharpness, (std::vector<float>{2}));
}

TEST(ObjLoader, warnsOnceOfEachThingItDoesNotRead) {
    Warnings warnings;
    const std::string edit = "t vertexedit 1/3/1 0 1 2 3 add\n", unknown = "t colour 0/1/0 1\n", line = "l 1 2\n";
    parseObj(kSquare + "f 1 2 3 4\n" + edit + edit + unknown + unknown + line + line, "test.obj", warnings.warn());
    ASSERT_EQ(warnings.lines.size(), 3u);
    EXPECT_TRUE(warnings.has("test.obj:10: lines 'l'"));
    EXPECT_TRUE(warnings.has("test.obj:6: hierarchical edit 'vertexedit'"));
    EXPECT_TRUE(warnings.has("test.obj:8: unknown tag 'colour'"));
}

TEST(ObjLoader, warnsOfNormalsOnSomeFacesOnlyAndDropsThem) {
    Warnings warnings;
    const Cage cage = parseObj(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\nf 2 3 4\n", "test.obj", warnings.warn());
    EXPECT_TRUE(cage.normals.empty());
    EXPECT_TRUE(cage.normalCorners.empty());
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("test.obj:7:"));
}

TEST(ObjLoader, warnsOfRulesThatDiffer) {
    Warnings warnings;
    const std::string text = kSquare + "f 1 2 3 4\nt interpolateboundary 1/0/0 1\nt interpolateboundary 1/0/0 0\n";
    EXPECT_EQ(parseObj(text, "test.obj", warnings.warn()).boundaryRule, BoundaryRule::none);
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("test.obj:7:"));
    EXPECT_TRUE(warnings.has("line 6"));
}

TEST(ObjLoader, doesNotWarnOfLinesThatSubdivisionIgnores) {
    EXPECT_NO_THROW(parse("mtllib a.mtl\n" + kSquare + "s off\ns 1\nf 1 2 3 4\n"));
}

TEST(ObjWriter, everyFamilyComesBackAsItWas) {
    const TemporaryFolder folder;
    for (const NamedCage& family : allCages()) {
        SCOPED_TRACE(family.name);
        writeObj(folder / "a.obj", family.cage);
        expectSame(readCage(folder / "a.obj"), family.cage);
    }
}

TEST(ObjWriter, normalsAndAllTagsComeBack) {
    const TemporaryFolder folder;
    Cage cage = torusWithHoles();
    cage.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}};
    for (std::size_t i = 0; i < cage.corners.size(); ++i) cage.normalCorners.push_back(std::uint32_t(i % 2));
    cage.boundaryRule = BoundaryRule::none;
    cage.texBoundaryRule = TexBoundaryRule::boundaries;
    cage.creaseMethod = CreaseMethod::chaikin;
    addSharpVertex(cage, 5, 1.25f);
    addCrease(cage, cage.corners[0], cage.corners[1], 0.3f);
    writeObj(folder / "a.obj", cage);
    expectSame(readCage(folder / "a.obj"), cage);

    cage.texCoords.clear(), cage.texCorners.clear();
    writeObj(folder / "a.obj", cage);
    expectSame(readCage(folder / "a.obj"), cage);
}

TEST(ObjWriter, extremeNumbersComeBack) {
    const TemporaryFolder folder;
    Cage cage = cube();
    constexpr float kLargest = 1e6f, kSmallest = std::numeric_limits<float>::denorm_min();
    cage.positions[0] = {kLargest, -kLargest, kSmallest};
    cage.positions[1] = {1.0f / 3, std::nextafter(1.0f, 2.0f), -0.0f};
    writeObj(folder / "a.obj", cage);
    expectSame(readCage(folder / "a.obj"), cage);

    cage.positions[0].x = 3.4e32f;
    writeObj(folder / "b.obj", cage);
    const Cage again = readCage(folder / "b.obj"); // in a unit of its own
    EXPECT_EQ(vec3(again.coordinates.toWorld(again.positions[0])).x, cage.positions[0].x);
    EXPECT_EQ(vec3(again.coordinates.toWorld(again.positions[1])).y, cage.positions[1].y);
}

TEST(ObjWriter, aNameCannotBreakItsLine) {
    const TemporaryFolder folder;
    Cage cage = cube();
    cage.parts = {{.name = "a\nf 1 2 3", .material = "m\\", .firstFace = 0, .faceCount = 6}};
    writeObj(folder / "a.obj", cage);
    EXPECT_EQ(readCage(folder / "a.obj").faceCount(), 6u);
}

TEST(ProductionCages, loadWithoutWarningsAndWithTheirCounts) {
    const std::string folder = productionFolder();
    if (folder.empty()) GTEST_SKIP() << "no production meshes; set RELIEF_DATA to their folder";
    const auto expectCounts = [&](const std::string& name, std::uint64_t faces, std::uint64_t vertices,
                                  std::uint64_t tex) {
        Warnings warnings;
        const Cage cage = readCage(folder + "/" + name, warnings.warn());
        const CageSummary summary = summarize(cage);
        EXPECT_TRUE(warnings.lines.empty()) << name;
        EXPECT_EQ(summary.quadCount, faces) << name;
        EXPECT_EQ(summary.vertexCount, vertices) << name;
        EXPECT_EQ(summary.texCoordCount, tex) << name;
        EXPECT_EQ(summary.nonManifoldEdgeCount, 0u) << name;
        return summary;
    };
    expectCounts("bigguy.obj", 1450, 1452, 1754);
    expectCounts("monsterfrog.obj", 1292, 1308, 1705);
    const CageSummary car = expectCounts("car.obj", 1575, 1642, 4);
    EXPECT_EQ(car.boundaryEdgeCount, 60u);
    EXPECT_EQ(car.creasedEdgeCount, 314u);
}

} // namespace
} // namespace relief::test
