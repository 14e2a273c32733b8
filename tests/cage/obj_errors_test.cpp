// Every OBJ text that must be refused, with the words that its message owes to the reader.
#include "cage/square.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

const std::string kFace = "f 1 2 3 4\n";

/// Expects bad input whose message starts with file and line and holds the words.
void expectRefused(const std::string& text, int line, std::vector<std::string> words) {
    words.push_back(fmt::format("test.obj:{}: ", line));
    expectFailure(Failure::input, words, [&] { parseObj(text, "test.obj", [](const std::string&) {}); });
}

TEST(ObjLoader, refusesFaceIndexPastTheLastVertex) {
    expectRefused(kSquare + "f 1 2 3\nf 1 2 9\n", 6, {"vertex index 9", "there are 4"});
}

TEST(ObjLoader, refusesFaceIndexPastTheLastTextureCoordinate) {
    expectRefused(kSquare + "vt 0 0\nf 1/1 2/1 3/2\n", 6, {"texture coordinate index 2", "there are 1"});
}

TEST(ObjLoader, hintsAtTwoSlashesWhereNormalsStandAsTextureCoordinates) {
    const std::string hint = "write v//vn", square = kSquare + "vn 0 0 1\n";
    expectRefused(square + "f 1/1 2/1 3/1\n", 6, {"texture coordinate index 1", "there are 0", hint});
    expectRefused(square + "f 1/-1 2/-1 3/-1\n", 6, {"texture coordinate index -1", hint});
    for (const std::string& text : {square + "f 1/1/1 2/1/1 3/1/1\n", kSquare + "f 1/1 2/1 3/1\n"}) try {
            parseObj(text, "test.obj");
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find(hint), std::string::npos) << error.what();
        }
}

TEST(ObjLoader, refusesFaceIndexThatReachesBeforeTheFirstVertex) {
    expectRefused(kSquare + "f -9 -3 -2 -1\n", 5, {"-9", "4 are defined above"});
    expectRefused("v 0 0 0\nv 1 0 0\nf -3 -2 -1\nv 1 1 0\n", 3, {"-3", "2 are defined above"});
    expectRefused(kSquare + "f -2147483648 2 3\n", 5, {"-2147483648"});
}

TEST(ObjLoader, refusesFaceIndexZero) {
    expectRefused(kSquare + "f 0 1 2\n", 5, {"vertex index 0", "count from 1"});
    expectRefused(kSquare + "vt 0 0\nf 1/0 2/1 3/1\n", 6, {"texture coordinate index 0"});
}

TEST(ObjLoader, refusesFaceIndexThatIsNoWholeNumber) {
    for (const std::string word : {"x", "1.5", "4294967297", "1e2", "1/a", "1//-"})
        expectRefused(fmt::format("{}vt 0 0\nf 2 3 {}\n", kSquare, word), 6, {"whole number"});
    expectRefused(kSquare + "vt 0 0\nf 1/1/1/1 2 3\n", 6, {"1/1/1/1", "vertex/texture/normal"});
    expectRefused(kSquare + "vt 0 0\nf /1 2 3\n", 6, {"whole number"});
}

TEST(ObjLoader, refusesFilesOfDegenerateFacesAlone) {
    expectRefused(kSquare + "f 1 2\n", 5, {"fewer than 3 corners", "all 1 faces"});
    expectRefused(kSquare + "f 1 2 3 2\nf 4\n", 5, {"vertex 2 twice", "all 2 faces"});
    expectRefused(kSquare + "f\n" + kFace, 5, {"no corners"});
}

TEST(ObjLoader, refusesLinesWithoutEnd) {
    const std::string digits(20'000'000, '1'), spaces(20'000'000, ' ');
    expectRefused(kSquare + "v 0 0 " + digits + "\n", 5, {"16.0 MB"});
    expectRefused(kSquare + "o " + digits + "\n", 5, {"16.0 MB"});
    expectRefused(kSquare + "f 1" + spaces + "2 3\n", 5, {"16.0 MB"});
    std::string joined = kSquare + "f";
    for (int k = 0; k < 40; ++k) joined += std::string(500'000, ' ') + "\\\n";
    expectRefused(joined + "1 2 3\n", 5, {"16.0 MB"});
    EXPECT_NO_THROW(parseObj(kSquare + "# " + digits + "\n" + kFace, "test.obj"));
}

TEST(ObjLoader, refusesNumbersThatAreNotFinite) {
    for (const std::string word : {"nan", "inf", "-inf", "NaN", "infinity", "-1e400"})
        expectRefused(fmt::format("v 0 0 0\nv 0 {} 0\n", word), 2, {word, "finite"});
    for (const std::string word : {"nan", "inf", "-inf", "NaN", "infinity", "1e39", "-1e400"}) {
        expectRefused(fmt::format("{}vt 0 {}\n{}", kSquare, word, kFace), 5, {word, "finite"});
        expectRefused(fmt::format("{}vn 0 0 {}\n{}", kSquare, word, kFace), 5, {word, "finite"});
    }
}

TEST(ObjLoader, refusesWordsThatAreNoNumbers) {
    for (const std::string word : {"0,5", "x", "1.2.3", "0x10", "--1", "+-1", "1e", ".", "1f"})
        expectRefused(fmt::format("v 0 0 0\nv 0 {} 0\n", word), 2, {fmt::format("'{}'", word), "decimal point"});
}

TEST(ObjLoader, refusesTooFewOrTooManyNumbers) {
    expectRefused("v 0 0\n", 1, {"vertex", "3 to 8", "has 2"});
    expectRefused("v 1 2 3 4 5 6 7 8 9\n", 1, {"has 9"});
    expectRefused("vt\n", 1, {"texture coordinate", "1 to 3", "has 0"});
    expectRefused("vt 1 2 3 4\n", 1, {"has 4"});
    expectRefused("vn 1 2\n", 1, {"normal", "has 2"});
}

TEST(ObjLoader, countsLinesAsEditorsDo) {
    expectRefused("v 0 0 0\r\n\r\n# c\r\nv 0 x 0\r\n", 4, {"'x'"});
    expectRefused("v 0 0 \\\n0\nv 0 \\\n x 0\nv 1 1 1\n", 3, {"'x'"}); // the line where the statement begins
    expectRefused("v 0 0 \\\n0\nv 0 0 0\nv 0 x 0\n", 4, {"'x'"});
    expectRefused("v 0 0 0\rv 0 x 0\r", 2, {"'x'"});
}

TEST(ObjLoader, refusesZeroBytes) { expectRefused(kSquare + std::string("v 0\0 0 0\n", 9), 5, {"zero byte", "UTF-8"}); }

TEST(ObjLoader, messagesStayShortAndPrintable) {
    expectRefused("v 0 0 " + std::string(1000, 'x') + "\n", 1, {"'" + std::string(40, 'x') + "...'"});
    expectRefused("v 0 0 \x1b[31m\x07\n", 1, {"'?[31m?'"});
}

TEST(ObjLoader, refusesFilesWithoutFaces) {
    for (const std::string text : {"", "\n", "# nothing\n", "v 0 0 0\n", "\xef\xbb\xbf"})
        expectFailure(Failure::input, {"test.obj", "no faces"}, [&] { parseObj(text, "test.obj"); });
}

TEST(ObjLoader, refusesCreasesOnEdgesThatDoNotExist) {
    expectRefused(kSquare + kFace + "t crease 2/1/0 0 1 3\nt crease 2/1/0 0 2 3\n", 7, {"vertices 0 and 2", "from 0"});
    expectRefused(kSquare + kFace + "t crease 2/1/0 1 1 3\n", 6, {"vertices 1 and 1"});
}

TEST(ObjLoader, refusesTagIndicesOutOfRange) {
    expectRefused(kSquare + kFace + "t crease 2/1/0 3 4 3\n", 6, {"vertex 4", "0 to 3"});
    expectRefused(kSquare + kFace + "t crease 2/1/0 -1 0 3\n", 6, {"vertex -1", "0 to 3"});
    expectRefused(kSquare + kFace + "t corner 1/1/0 4 3\n", 6, {"vertex 4", "0 to 3"});
    expectRefused(kSquare + kFace + "t hole 1/0/0 1\n", 6, {"face 1", "0 to 0"});
    expectRefused(kSquare + kFace + "t hole 2/0/0 0 -1\n", 6, {"face -1"});
}

TEST(ObjLoader, refusesNegativeSharpness) {
    expectRefused(kSquare + kFace + "t crease 2/1/0 0 1 -3\n", 6, {"-3", "0 (smooth)"});
    expectRefused(kSquare + kFace + "t corner 1/1/0 0 -0.5\n", 6, {"-0.5"});
    expectRefused(kSquare + kFace + "t crease 2/1/0 0 1 inf\n", 6, {"inf", "finite"});
}

TEST(ObjLoader, refusesRulesThatDoNotExist) {
    expectRefused(kSquare + kFace + "t interpolateboundary 1/0/0 3\n", 6, {"interpolateboundary 3", "0 to 2"});
    expectRefused(kSquare + kFace + "t interpolateboundary 1/0/0 -1\n", 6, {"-1", "0 to 2"});
    expectRefused(kSquare + kFace + "t facevaryinginterpolateboundary 1/0/0 6\n", 6, {"6", "0 to 5"});
    expectRefused(kSquare + kFace + "t creasemethod 0/0/1 sharp\n", 6, {"'sharp'", "normal or chaikin"});
}

TEST(ObjLoader, refusesTagsOfTheWrongShape) {
    const std::string cage = kSquare + kFace;
    expectRefused(cage + "t\n", 6, {"name ints/floats/strings"});
    expectRefused(cage + "t crease\n", 6, {"name ints/floats/strings"});
    for (const std::string sizes : {"2/1", "2", "2/1/0/0", "a/1/0", "2//0", "-2/1/0", "2/1/"})
        expectRefused(fmt::format("{}t crease {} 0 1 3\n", cage, sizes), 6, {fmt::format("'{}'", sizes), "2/1/0"});
    expectRefused(cage + "t crease 2/1/0 0 1\n", 6, {"announces 3", "2 follow"});
    expectRefused(cage + "t crease 2/1/0 0 1 3 4\n", 6, {"announces 3", "4 follow"});
    expectRefused(cage + "t crease 4294967295/4294967295/0 0 1\n", 6, {"2 follow"});
    expectRefused(cage + "t crease 2/1/0 0 1.5 3\n", 6, {"'1.5'", "whole number"});
    expectRefused(cage + "t crease 2/1/0 0 1 0,5\n", 6, {"'0,5'", "decimal point"});
}

TEST(ObjLoader, refusesTagsOfTheWrongSizes) {
    const std::string cage = kSquare + kFace;
    expectRefused(cage + "t crease 3/1/0 0 1 2 3\n", 6, {"3/1/0", "2/1/0"});
    expectRefused(cage + "t crease 2/2/0 0 1 2 3\n", 6, {"2/2/0", "2/1/0"});
    expectRefused(cage + "t corner 3/2/0 0 1 2 1 1\n", 6, {"3/2/0", "1/1/0"});
    expectRefused(cage + "t hole 0/0/0\n", 6, {"0/0/0", "1/0/0"});
    expectRefused(cage + "t hole 1/1/0 0 0\n", 6, {"1/1/0"});
    expectRefused(cage + "t interpolateboundary 2/0/0 1 1\n", 6, {"2/0/0", "1/0/0"});
    expectRefused(cage + "t creasemethod 1/0/0 1\n", 6, {"1/0/0", "0/0/1"});
}

TEST(ReadCage, namesTheFileItCannotRead) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder / "none.obj", "No such file"}, [&] { readCage(folder / "none.obj"); });
    putFile(folder / "a.blend", "");
    expectFailure(Failure::input, {folder / "a.blend", "use .obj"}, [&] { readCage(folder / "a.blend"); });
}

TEST(ReadCage, namesTheFileInFrontOfTheLine) {
    const TemporaryFolder folder;
    putFile(folder / "BAD.OBJ", "v 0 0 x\n");
    expectFailure(Failure::input, {(folder / "BAD.OBJ") + ":1: "}, [&] { readCage(folder / "BAD.OBJ"); });
}

TEST(WriteObj, refusesFoldersThatCannotBeWritten) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder / "none/a.obj"}, [&] { writeObj(folder / "none/a.obj", cube()); });
}

} // namespace
} // namespace relief::test
