// OBJ files that are not quite right, and what is still read of them.
#include "cage/square.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// Parses a text that must load with exactly one warning, which holds the words.
Cage parseWarned(const std::string& text, const std::vector<std::string>& words) {
    Warnings warnings;
    Cage cage = parseObj(text, "test.obj", warnings.warn());
    EXPECT_EQ(warnings.lines.size(), 1u);
    for (const std::string& word : words)
        EXPECT_TRUE(warnings.has(word)) << word << " in " << (warnings.lines.empty() ? "" : warnings.lines[0]);
    return cage;
}

Cage parseSilently(const std::string& text) {
    Warnings warnings;
    Cage cage = parseObj(text, "test.obj", warnings.warn());
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
    return cage;
}

// --- normals -------------------------------------------------------------------------------------------------------

TEST(ObjNormals, thatDoNotExistAreDroppedWithAWarning) {
    for (const std::string face : {"f 1//1 2//2 3//3", "f 1//-1 2//-2 3//-3", "f 1//1 2//1 3//2147483647"}) {
        const Cage cage = parseWarned(kSquare + face + "\n", {"test.obj:5: normal index", "dropped"});
        EXPECT_EQ(cage.corners, (Indices{0, 1, 2}));
        EXPECT_TRUE(cage.normals.empty() && cage.normalCorners.empty());
    }
    const Cage some = parseWarned(kSquare + "vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\nf 2/1/1 3/1/9 4/1/1\n",
                                  {"test.obj:8: normal index 9", "there are 1"});
    EXPECT_TRUE(some.normalCorners.empty());
    EXPECT_EQ(some.texCorners, (Indices{0, 0, 0, 0, 0, 0}));
}

TEST(ObjNormals, atSomeCornersOnlyAreDropped) {
    const Cage cage = parseWarned(kSquare + "vn 0 0 1\nf 1//1 2 3\n", {"test.obj:6:", "normals are dropped"});
    EXPECT_TRUE(cage.normalCorners.empty());
}

// --- texture coordinates -------------------------------------------------------------------------------------------

TEST(ObjTexCoords, thatSomeFacesLackAreRememberedAsMissing) {
    const std::string square = kSquare + "vt 0 0\n";
    const auto expectMissing = [](const std::string& text, const std::string& line) {
        const Cage cage = parseSilently(text);
        EXPECT_FALSE(cage.hasTexCoords());
        EXPECT_TRUE(cage.texCoords.empty());
        EXPECT_TRUE(cage.missingTexCoords.starts_with(line)) << cage.missingTexCoords;
    };
    expectMissing(square + "f 1/1 2/1 3/1\nf 2 3 4\n", "test.obj:7: ");
    expectMissing(square + "f 2 3 4\nf 1 2 3\nf 1/1 2/1 3/1\n", "test.obj:6: ");
    expectMissing(square + "f 1/1 2 3/1\n", "test.obj:6: ");
    expectMissing(square + "vn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 2//1 3//1 4//1\n", "test.obj:8: ");
}

TEST(ObjTexCoords, onAllFacesOrNoneAreNotMissing) {
    EXPECT_EQ(parseSilently(kSquare + "vt 0 0\nf 1/1 2/1 3/1\n").missingTexCoords, "");
    EXPECT_EQ(parseSilently(kSquare + "vt 0 0\nf 1 2 3\n").missingTexCoords, "");
}

TEST(ObjTexCoords, areNotMissingWhereOnlyADegenerateFaceLacksThem) {
    const Cage cage = parseWarned(kSquare + "vt 0 0\nf 1/1 2/1 3/1\nf 2 2 3\nf 2\n", {"2 in all"});
    EXPECT_EQ(cage.texCorners, (Indices{0, 0, 0}));
    EXPECT_EQ(cage.missingTexCoords, "");
}

// --- degenerate faces ----------------------------------------------------------------------------------------------

TEST(ObjFaces, withoutThreeVerticesAreDroppedAndCounted) {
    for (const std::string face :
         {"f 4 4 5", "f 1 2", "f 3", "f 1 2 1", "f 2 2 2 2", "f 1 2 1 2", "f 1 2 3 2 4", "f -1 -1 -2", "f 1 1 -5"}) {
        const std::string text = kSquare + "v 2 2 0\n";
        const Cage cage = parseWarned(text + "f 1 2 3 4\n" + face + "\nf 2 3 5\n",
                                      {"test.obj:7: face 1 (from 0)", "1 in all", "dropped"});
        EXPECT_EQ(cage.faceSizes, (Indices{4, 3})) << face;
        EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 3, 1, 2, 4})) << face;
    }
    const Cage many = parseWarned(kSquare + "f 1 2 2\nf 1 2 3 4\nf 1\nf 4 3 3 4\n", {"test.obj:5: face 0", "3 in all"});
    EXPECT_EQ(many.faceCount(), 1u);
}

TEST(ObjFaces, thatRepeatACornerKeepTheOthers) {
    for (const std::string face :
         {"f 1/1 2/2 2/3 3/4", "f 1/1 1/3 2/2 3/4", "f 1/1 2/2 3/4 1/3", "f 1/1 2/2 2/3 2/1 3/4"}) {
        const Cage cage = parseWarned(kSquare + "vt 0 0\nvt 1 0\nvt 5 5\nvt 1 1\n" + face + "\nf 1/1 3/4 4/3\n",
                                      {"test.obj:9: face 0 (from 0)", "twice in a row", "of 1 faces"});
        EXPECT_EQ(cage.faceSizes, (Indices{3, 3})) << face;
        EXPECT_EQ(cage.corners, (Indices{0, 1, 2, 0, 2, 3})) << face;
        EXPECT_EQ(cage.texCorners, (Indices{0, 1, 3, 0, 3, 2})) << face;
    }
}

TEST(ObjFaces, ofTagsAreCountedAsTheFileCountsThem) {
    const Cage cage = parseWarned("o a\n" + kSquare +
                                      "f 1 2 2\no b\nf 1 2 3\nf 4 4\no c\nf 2 3 4\nf 1 3 4\n"
                                      "t hole 4/0/0 0 1 2 4\nt crease 2/1/0 1 2 3\n",
                                  {"test.obj:6: face 0", "2 in all"});
    EXPECT_EQ(cage.faceCount(), 3u);
    EXPECT_EQ(cage.holes, (Indices{0, 2}));
    EXPECT_EQ(cage.creaseEdges, (Indices{1, 2}));
    ASSERT_EQ(cage.parts.size(), 2u);
    EXPECT_EQ(cage.parts[0].name + cage.parts[1].name, "bc");
    EXPECT_EQ(cage.parts[1].firstFace, 1u);
    EXPECT_EQ(cage.parts[1].faceCount, 2u);
}

TEST(ObjFaces, thatAreDroppedTakeTheirCreasesWithThem) {
    const Cage cage = parseWarned(kSquare + "v 2 2 0\nf 1 2 3 4\nf 4 4 5\nt crease 2/1/0 3 4 9\nt crease 2/1/0 0 1 2\n",
                                  {"test.obj:7: face 1"});
    EXPECT_EQ(cage.creaseEdges, (Indices{0, 1}));
    EXPECT_EQ(cage.creaseSharpness, (std::vector<float>{2}));
}

TEST(ObjFaces, ofNoAreaAndNonManifoldOnesAreKept) {
    const Cage flat = parseSilently("v 0 0 0\nv 0 0 0\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 4 5\n");
    EXPECT_EQ(flat.faceCount(), 2u);
    const Cage fan = parseSilently(kSquare + "v 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 3\nf 3 2 1\n");
    EXPECT_EQ(fan.faceCount(), 5u);
}

// --- creases -------------------------------------------------------------------------------------------------------

// Two squares that share an edge but no vertex: 1-2 of the first is at the positions of 4-7 of the second.
TEST(ObjCreases, mayNameAnEdgeByVerticesAtTheSamePosition) {
    const std::string apart = kSquare + "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n";
    EXPECT_EQ(parseSilently(apart + "t crease 2/1/0 1 2 3\n").creaseEdges, (Indices{1, 2}));
    const Cage cage = parseSilently(apart + "t crease 2/1/0 1 7 3\n");
    EXPECT_EQ(cage.creaseEdges, (Indices{1, 2, 4, 7}));
    EXPECT_EQ(cage.creaseSharpness, (std::vector<float>{3, 3}));
    expectFailure(Failure::input, {"test.obj:11:", "vertices 0 and 7"},
                  [&] { parseObj(apart + "t crease 2/1/0 0 7 3\n", "test.obj"); });
}

// --- names ---------------------------------------------------------------------------------------------------------

TEST(ObjNames, needNotBeUtf8) {
    const Cage cage = parseSilently("o caf\xe9\nusemtl \xff\xfe\n" + kSquare + "f 1 2 3 4\n");
    ASSERT_EQ(cage.parts.size(), 1u);
    EXPECT_EQ(cage.parts[0].name, "caf\xe9");
    EXPECT_EQ(cage.parts[0].material, "\xff\xfe");
}

} // namespace
} // namespace relief::test
