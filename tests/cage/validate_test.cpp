#include <cmath>
#include <functional>

#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// A cube that has one of everything, spoiled by `spoil`, must be refused with these words.
void expectRefused(const std::function<void(Cage&)>& spoil, std::vector<std::string> words) {
    Cage cage = withIslands(creasedCube());
    addSharpVertex(cage, 1, 2);
    cage.holes = {5};
    cage.normals = {{0, 0, 1}};
    cage.normalCorners.assign(24, 0);
    cage.parts = {{.name = "a", .material = "", .firstFace = 0, .faceCount = 6}};
    ASSERT_NO_THROW(validateCage(cage, "spoiled"));
    spoil(cage);
    words.emplace_back("spoiled: ");
    expectFailure(Failure::input, words, [&] { validateCage(cage, "spoiled"); });
}

TEST(ValidateCage, refusesACageWithoutFaces) {
    expectFailure(Failure::input, {"empty", "no faces"}, [] { validateCage({}, "empty"); });
}

TEST(ValidateCage, refusesIndicesOutOfRange) {
    expectRefused([](Cage& cage) { cage.corners[3] = 8; }, {"vertex 8", "there are 8"});
    expectRefused([](Cage& cage) { cage.texCorners[3] = 24; }, {"texture coordinate 24", "24"});
    expectRefused([](Cage& cage) { cage.normalCorners[3] = 1; }, {"normal 1"});
    expectRefused([](Cage& cage) { cage.creaseEdges[3] = 8; }, {"crease vertex 8"});
    expectRefused([](Cage& cage) { cage.sharpVertices[0] = ~0u; }, {"sharp vertex 4294967295"});
    expectRefused([](Cage& cage) { cage.holes[0] = 6; }, {"hole face 6", "there are 6"});
}

TEST(ValidateCage, refusesFacesOfFewerThanThreeCorners) {
    expectRefused([](Cage& cage) { cage.faceSizes[2] = 2; }, {"face 2 has 2 corners"});
}

TEST(ValidateCage, refusesFacesThatUseAVertexTwice) {
    expectRefused([](Cage& cage) { cage.corners[9] = cage.corners[8]; }, {"face 2", "twice"});
}

TEST(ValidateCage, refusesNumbersThatAreNotFinite) {
    expectRefused([](Cage& cage) { cage.positions[3].y = NAN; }, {"vertex 3", "nan"});
    expectRefused([](Cage& cage) { cage.texCoords[3].y = INFINITY; }, {"texture coordinate 3", "inf"});
    expectRefused([](Cage& cage) { cage.normals[0].z = -INFINITY; }, {"normal 0", "-inf"});
    expectRefused([](Cage& cage) { cage.creaseSharpness[1] = NAN; }, {"crease 1", "nan"});
}

TEST(ValidateCage, refusesNegativeSharpness) {
    expectRefused([](Cage& cage) { cage.creaseSharpness[1] = -1; }, {"crease 1", "-1"});
    expectRefused([](Cage& cage) { cage.vertexSharpness[0] = -1; }, {"sharp vertex 0", "-1"});
}

TEST(ValidateCage, refusesCreasesOnNoEdge) {
    expectRefused([](Cage& cage) { cage.creaseEdges[0] = 5; }, {"crease 0", "vertices 5 and 6"});
}

TEST(ValidateCage, refusesArraysThatDisagree) {
    expectRefused([](Cage& cage) { cage.faceSizes[5] = 5; }, {"face 5", "24"});
    expectRefused([](Cage& cage) { cage.faceSizes[5] = 3; }, {"24 corners", "23"});
    expectRefused([](Cage& cage) { cage.faceSizes[5] = ~0u; }, {"face 5"});
    expectRefused([](Cage& cage) { cage.texCorners.pop_back(); }, {"23 texture corners", "24"});
    expectRefused([](Cage& cage) { cage.normalCorners.pop_back(); }, {"23 normal corners", "24"});
    expectRefused([](Cage& cage) { cage.creaseEdges.pop_back(); }, {"7 crease vertices", "8"});
    expectRefused([](Cage& cage) { cage.vertexSharpness.clear(); }, {"0 vertex sharpnesses", "1"});
    expectRefused([](Cage& cage) { cage.parts[0].faceCount = 5; }, {"5 faces in parts", "6"});
    expectRefused([](Cage& cage) { cage.parts[0].firstFace = 1; }, {"part 'a'", "face 1"});
}

} // namespace
} // namespace relief::test
