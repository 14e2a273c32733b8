// Closed cages are exported closed in every format, by a count of edges over the numbers that the file has.
#include <map>
#include <set>

#include "meshes.h"
#include "program.h"

namespace relief::test {
namespace {

/// Edges that have not exactly one triangle each way.
std::size_t wrongEdges(const std::vector<std::uint32_t>& indices) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) ++uses[{indices[i + k], indices[i + (k + 1) % 3]}];
    return std::size_t(std::ranges::count_if(uses, [&](const auto& use) {
        const auto back = uses.find({use.first.second, use.first.first});
        return use.second != 1 || back == uses.end();
    }));
}

/// What follows the header or the first chunk, as numbers.
template <typename Number>
Number numberAt(const std::string& bytes, std::size_t at) {
    Number number{};
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

std::vector<std::uint32_t> plyIndices(const std::string& path, std::size_t vertexBytes) {
    const std::string file = readFile(path), mark = "end_header\n";
    const auto countAfter = [&](const std::string& words) {
        return std::stoul(file.substr(file.find(words) + words.size()));
    };
    std::size_t at = file.find(mark) + mark.size() + vertexBytes * countAfter("element vertex ");
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < countAfter("element face "); ++i, at += 13)
        for (std::size_t k = 0; k < 3; ++k) indices.push_back(numberAt<std::uint32_t>(file, at + 1 + 4 * k));
    EXPECT_EQ(at, file.size());
    return indices;
}

std::vector<std::uint32_t> glbIndices(const std::string& path) {
    const std::string file = readFile(path);
    const std::size_t jsonBytes = numberAt<std::uint32_t>(file, 12), body = 28 + jsonBytes;
    const nlohmann::json json = nlohmann::json::parse(file.substr(20, jsonBytes));
    const auto& accessor = json["accessors"][json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()];
    const std::size_t first = json["bufferViews"][accessor["bufferView"].get<std::size_t>()].value("byteOffset", 0u);
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < accessor["count"]; ++i)
        indices.push_back(numberAt<std::uint32_t>(file, body + first + 4 * i));
    return indices;
}

struct ClosedCage {
    std::string name;
    Cage cage;
    std::string scheme = "catmark";
};

/// The cube of Embree's issue 286: every edge creased, every edge a seam, corners cut by texture.
Cage creasedSeamedCube() {
    Cage cage = cubeOfIslands();
    for (const auto& [a, b] : std::vector<std::pair<int, int>>{
             {0, 1}, {1, 3}, {3, 2}, {2, 0}, {4, 5}, {5, 7}, {7, 6}, {6, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}})
        addCrease(cage, std::uint32_t(a), std::uint32_t(b), 10);
    return cage;
}

std::vector<ClosedCage> closedCages() {
    return {{"plain", cube()},
            {"seamed", torusWithSeams()},
            {"islands", cubeOfIslands()},
            {"creased and seamed", creasedSeamedCube()},
            {"semi-sharp", withIslands(creasedCube(2.5f))},
            {"n-gons", nGonPrism(7)},
            {"creased n-gons",
             [] {
                 Cage cage = nGonPrism(5);
                 for (std::uint32_t k = 0; k < 5; ++k) addCrease(cage, 5 + k, 5 + (k + 1) % 5, 10);
                 return cage;
             }()},
            {"mixed", withIslands(mixedFaces())},
            {"loop", withIslands(icosahedron()), "loop"}};
}

class ClosedCages : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    void SetUp() override { writeImage(folder_ / "h.exr", sineImage(32, 3), SampleType::real); }

    std::string exported(const ClosedCage& closed, const std::string& name, const std::string& more) {
        writeObj(folder_ / "cage.obj", closed.cage);
        expectDone(relief({"export", folder_ / "cage.obj", "--height", folder_ / "h.exr", "--scale", "0.03", "-q",
                           "--scheme", closed.scheme, "-o", folder_ / name},
                          more));
        return folder_ / name;
    }
};

TEST_F(ClosedCages, areClosedInObjWithEachPositionOnce) {
    // Rates take turns.
    constexpr const char* kRates[] = {"--rate 1", "--rate 5", "--edge-pixels 40 --size 256,256 --spacing fractional"};
    std::size_t turn = 0;
    for (const ClosedCage& closed : closedCages()) {
        const char* rates = kRates[turn++ % std::size(kRates)];
        SCOPED_TRACE(closed.name + " " + rates);
        const Cage obj = readCage(exported(closed, "a.obj", rates));
        EXPECT_EQ(wrongEdges(obj.corners), 0u);
        std::set<std::tuple<float, float, float>> positions;
        for (const vec3& p : obj.positions) positions.insert({p.x, p.y, p.z});
        EXPECT_EQ(positions.size(), obj.positions.size());
        EXPECT_EQ(obj.hasTexCoords(), closed.cage.hasTexCoords());
    }
}

TEST_F(ClosedCages, areClosedInPlyAndGltfWithWeldedPositions) {
    for (const ClosedCage& closed : closedCages()) {
        SCOPED_TRACE(closed.name);
        const std::string more = "--rate 5 --spacing fractional --weld-positions";
        EXPECT_EQ(wrongEdges(plyIndices(exported(closed, "a.ply", more), 24)), 0u);
        EXPECT_EQ(wrongEdges(glbIndices(exported(closed, "a.glb", more))), 0u);
    }
}

// What the option is for: without it a seam is open by the file's own numbers.
TEST_F(ClosedCages, areOpenAtSeamsWithoutWeldedPositions) {
    const ClosedCage seamed{"creased and seamed", creasedSeamedCube()};
    EXPECT_GT(wrongEdges(plyIndices(exported(seamed, "a.ply", "--rate 3"), 32)), 0u);
}

} // namespace
} // namespace relief::test
