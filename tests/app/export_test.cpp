// relief export: meshes read back by hand, counts known by hand, and what is refused.
#include <bit>
#include <map>
#include <set>

#include "cage/cage.h"
#include "program.h"

namespace relief::test {
namespace {

constexpr const char* kPlainCube =
    "v -1 -1 1\nv 1 -1 1\nv 1 -1 -1\nv -1 -1 -1\nv -1 1 1\nv 1 1 1\nv 1 1 -1\nv -1 1 -1\n"
    "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\nf 4 3 2 1\n";

struct Ply {
    bool hasTexCoords = false;
    std::vector<vec3> positions, normals;
    std::vector<vec2> texCoords;
    std::vector<std::uint32_t> indices;
};

template <typename Value>
Value take(std::string_view& bytes) {
    Value value{};
    EXPECT_GE(bytes.size(), sizeof(Value));
    std::memcpy(&value, bytes.data(), std::min(sizeof(Value), bytes.size()));
    bytes.remove_prefix(std::min(sizeof(Value), bytes.size()));
    return value;
}

std::size_t countAfter(const std::string& header, const std::string& words) {
    const std::size_t at = header.find(words);
    EXPECT_NE(at, std::string::npos) << header;
    return at == std::string::npos ? 0 : std::stoul(header.substr(at + words.size()));
}

Ply readPly(const std::string& path) {
    const std::string file = readFile(path), mark = "end_header\n";
    const std::size_t end = file.find(mark) + mark.size();
    const std::string header = file.substr(0, end);
    std::string_view body = std::string_view(file).substr(end);
    Ply ply{.hasTexCoords = contains(header, "property float t\n")};
    const std::size_t vertexCount = countAfter(header, "element vertex "),
                      faceCount = countAfter(header, "element face ");
    for (std::size_t i = 0; i < vertexCount; ++i) {
        ply.positions.push_back(take<vec3>(body));
        ply.normals.push_back(take<vec3>(body));
        if (ply.hasTexCoords) ply.texCoords.push_back(take<vec2>(body));
    }
    for (std::size_t i = 0; i < faceCount; ++i) {
        EXPECT_EQ(take<std::uint8_t>(body), 3);
        for (int k = 0; k < 3; ++k) ply.indices.push_back(take<std::uint32_t>(body));
    }
    EXPECT_EQ(body, "");
    return ply;
}

/// One number for each distinct position; two positions are one when all their bits are.
struct Welded {
    std::vector<std::uint32_t> names; ///< one per vertex
    std::size_t count = 0;
};

Welded weld(const Ply& ply) {
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
    Welded welded;
    for (const vec3& p : ply.positions) {
        const std::array bits{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                              std::bit_cast<std::uint32_t>(p.z)};
        welded.names.push_back(known.emplace(bits, std::uint32_t(known.size())).first->second);
    }
    welded.count = known.size();
    return welded;
}

/// Every edge of the welded triangles has two of them, which run it in opposite directions.
void expectClosed(const Ply& ply) {
    const Welded welded = weld(ply);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (std::size_t i = 0; i < ply.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++uses[{welded.names[ply.indices[i + k]], welded.names[ply.indices[i + (k + 1) % 3]]}];
    std::size_t wrongCount = 0;
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        wrongCount += count != 1 || back == uses.end() || back->second != 1;
    }
    EXPECT_EQ(wrongCount, 0u) << "of " << uses.size() << " directed edges";
}

class Exported : public ::testing::Test {
protected:
    TemporaryFolder folder_;
    std::string map_ = "--scale 0.1 --height " + folder_ / "h.exr";

    void SetUp() override {
        writeImage(folder_ / "h.exr", sineImage(64, 3), SampleType::real);
        putFile(folder_ / "plain.obj", kPlainCube);
    }

    Outcome exportAs(const std::string& name, const std::string& cage, const std::string& more) {
        return relief({"export", cage, "-o", folder_ / name}, more);
    }
    nlohmann::json exported(const std::string& name, const std::string& cage, const std::string& more) {
        return jsonOf(exportAs(name, cage, more + " --json"));
    }
    /// Nothing is left beside the map and the cage that were there before.
    void refuse(const std::string& name, const std::string& cage, const std::string& more, Failure failure,
                const Words& parts) {
        expectRefused(exportAs(name, cage, more), failure, parts);
        EXPECT_EQ(folder_.fileCount(), 2u);
    }
};

// A closed cube of rate r: 6 (r-1)^2 samples inside faces, 12 (r-1) on edges, 8 corners.
TEST_F(Exported, aCubeWithoutTextureCoordinatesHasEverySampleOnce) {
    for (const int rate : {1, 2, 7}) {
        const auto json = exported("a.ply", folder_ / "plain.obj", fmt::format("--rate {} {}", rate, map_));
        EXPECT_EQ(json.at("samples"), 6 * rate * rate + 2);
        EXPECT_EQ(json.at("vertices"), 6 * rate * rate + 2);
        EXPECT_EQ(json.at("triangles"), 12 * rate * rate);
        EXPECT_EQ(json.at("bytes"), std::filesystem::file_size(folder_ / "a.ply"));
        const Ply ply = readPly(folder_ / "a.ply");
        EXPECT_FALSE(ply.hasTexCoords);
        EXPECT_EQ(ply.positions.size(), json.at("vertices"));
        EXPECT_EQ(ply.indices.size(), 3 * json.at("triangles").get<std::size_t>());
        EXPECT_EQ(weld(ply).count, ply.positions.size());
        expectClosed(ply);
    }
}

// The torus is 16 by 8 faces of one chart: at rate r it has 128 r^2 samples, and its two seams repeat 16 r and 8 r of
// them, with one more where they cross.
TEST_F(Exported, verticesRepeatAlongSeamsWithTheSameBits) {
    const auto json = exported("a.ply", cagePath("torus"), "--rate 5 " + map_);
    EXPECT_EQ(json.at("samples"), 128 * 25);
    EXPECT_EQ(json.at("vertices"), 128 * 25 + 24 * 5 + 1);
    EXPECT_EQ(json.at("triangles"), 2 * 128 * 25);
    const Ply ply = readPly(folder_ / "a.ply");
    EXPECT_EQ(weld(ply).count, 128u * 25u);
    expectClosed(ply);
    ASSERT_EQ(ply.texCoords.size(), ply.positions.size());
    for (const vec2& st : ply.texCoords) {
        ASSERT_TRUE(st.x >= -1e-5f && st.x <= 1 + 1e-5f) << st.x;
        ASSERT_TRUE(st.y >= -1e-5f && st.y <= 1 + 1e-5f) << st.y;
    }
    for (const vec3& n : ply.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5);
}

TEST_F(Exported, theThreeFormatsHoldTheSameMesh) {
    const std::string more = "--rate 4 " + map_;
    const auto ply = exported("a.ply", cagePath("cube"), more), obj = exported("a.obj", cagePath("cube"), more),
               glb = exported("a.glb", cagePath("cube"), more);
    for (const auto& json : {obj, glb})
        for (const char* key : {"vertices", "triangles", "samples"}) EXPECT_EQ(json.at(key), ply.at(key)) << key;
    const Ply mesh = readPly(folder_ / "a.ply");
    const Cage cage = readCage(folder_ / "a.obj");
    EXPECT_EQ(cage.normals, mesh.normals);
    EXPECT_EQ(cage.texCoords, mesh.texCoords);
    EXPECT_EQ(cage.normalCorners, mesh.indices);
    EXPECT_EQ(cage.texCorners, mesh.indices);
    EXPECT_EQ(cage.positions.size(), ply.at("samples")); // each once, and vertices share them
    ASSERT_EQ(cage.corners.size(), mesh.indices.size());
    for (std::size_t i = 0; i < cage.corners.size(); ++i)
        ASSERT_EQ(cage.positions[cage.corners[i]], mesh.positions[mesh.indices[i]]);
    const std::string file = readFile(folder_ / "a.glb");
    EXPECT_TRUE(file.starts_with("glTF"));
    EXPECT_TRUE(contains(file, fmt::format("\"count\":{}", mesh.positions.size())));
    EXPECT_TRUE(contains(file, "TEXCOORD_0"));
}

TEST_F(Exported, spacingAndAdaptiveRatesStayClosed) {
    for (const char* more : {"--rate 6 --spacing fractional", "--edge-pixels 30 --spacing fractional",
                             "--edge-pixels 30", "--edge-pixels 30 --distance 2 --azimuth 70 --look-at 1,0,0"}) {
        const auto json = exported("a.ply", cagePath("torus"), std::string(more) + " " + map_);
        const Ply ply = readPly(folder_ / "a.ply");
        SCOPED_TRACE(more);
        EXPECT_EQ(weld(ply).count, json.at("samples"));
        expectClosed(ply);
    }
}

TEST_F(Exported, edgePixelsAreSeenByTheCamera) {
    const auto triangles = [&](const std::string& more) {
        return exported("a.ply", cagePath("torus"), more).at("triangles").get<int>();
    };
    const int near = triangles("--edge-pixels 20");
    EXPECT_GT(near, 2 * 128);
    EXPECT_LT(triangles("--edge-pixels 20 --size 256,256"), near / 4);
    EXPECT_LT(triangles("--edge-pixels 20 --distance 40"), near / 4);
}

TEST_F(Exported, ratesGoBeyondTheTessellators) {
    EXPECT_EQ(exported("a.ply", folder_ / "plain.obj", "--rate 100").at("triangles"), 120'000);
    expectClosed(readPly(folder_ / "a.ply"));
}

TEST_F(Exported, trianglesAreDicedWithAScheme) {
    putFile(folder_ / "tetrahedron.obj",
            "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const auto json = exported("a.ply", folder_ / "tetrahedron.obj", "--scheme loop --rate 5");
    EXPECT_EQ(json.at("triangles"), 4 * 25);
    EXPECT_EQ(json.at("samples"), 2 * 25 + 2); // Euler: half as many vertices as triangles, and two
    expectClosed(readPly(folder_ / "a.ply"));
}

TEST_F(Exported, saysWhatWasWritten) {
    const Outcome outcome = exportAs("a.glb", cagePath("cube"), "--rate 4");
    expectDone(outcome);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, folder_ / "a.glb") && contains(outcome.err, "192 triangles")) << outcome.err;
    EXPECT_EQ(exportAs("a.glb", cagePath("cube"), "--rate 4 -q").err, "");
    const Outcome bars = exportAs("a.glb", cagePath("cube"), "--rate 4 --progress always");
    EXPECT_TRUE(contains(bars.err, "dicing") && contains(bars.err, "writing")) << bars.err;
    const auto json = exported("a.glb", cagePath("cube"), "--rate 4");
    EXPECT_EQ(json.at("mesh"), folder_ / "a.glb");
    EXPECT_TRUE(json.at("device").is_string());
    for (const char* key : {"load_ms", "surface_ms", "rate_ms", "dice_ms", "write_ms"})
        EXPECT_TRUE(json.at(key).is_number()) << key;
}

TEST_F(Exported, ratesOutOfRangeAreUsage) {
    for (const char* rate : {"0", "-3", "1025"})
        refuse("a.ply", cagePath("cube"), std::string("--rate ") + rate, Failure::usage, {"1..1024"});
}

TEST_F(Exported, moreThanTheMemoryAllowedIsRefused) {
    refuse("a.ply", cagePath("cube"), "--rate 200 --memory 1M", Failure::device,
           {"480000 triangles", "1.0 MB are allowed", "--memory"});
    EXPECT_EQ(exported("a.ply", cagePath("cube"), "--rate 50 --memory 2M").at("triangles"), 30'000);
}

TEST_F(Exported, trianglesWithoutASchemeAreUsage) {
    putFile(folder_ / "plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    refuse("a.ply", folder_ / "plain.obj", "--rate 4", Failure::usage, {"plain.obj", "--scheme"});
}

TEST_F(Exported, meshesOfUnknownKindsAreUsage) {
    for (const char* name : {"a.stl", "a", "a.ply.gz"})
        refuse(name, "no-such.obj", "--rate 4", Failure::usage, {".ply, .obj or .glb"});
}

} // namespace
} // namespace relief::test
