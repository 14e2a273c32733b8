// Reading sculpts: every layout gives the same triangles, and files that lie are refused in one line.
#include <algorithm>
#include <cstring>

#include "mesh/mesh.h"
#include "support.h"

namespace relief::test {
namespace {

const std::vector<vec3> kPoints = {{0, 0, 0}, {1, 0, 0.5f}, {1, 1, 0}, {-0.25f, 1, 3}};
const std::vector<std::uint32_t> kIndices = {0, 1, 2, 0, 2, 3};

class ReadTriangles : public testing::Test {
protected:
    std::string write(const std::string& name, const std::string& bytes) {
        writeFile(folder_ / name, bytes);
        return folder_ / name;
    }
    void expectTriangles(const std::string& name, const std::string& bytes) {
        const TriangleMesh mesh = readTriangles(write(name, bytes));
        EXPECT_EQ(mesh.positions, kPoints) << name;
        EXPECT_EQ(mesh.indices, kIndices) << name;
    }
    void expectRefused(const std::string& name, const std::string& bytes, const std::string& part) {
        const std::string path = write(name, bytes);
        try {
            readTriangles(path);
            ADD_FAILURE() << part << " is not refused";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::input);
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }

    TemporaryFolder folder_;
};

template <typename Value>
std::string bytesOf(Value value, bool isBig = false) {
    std::string bytes(sizeof value, 0);
    std::memcpy(bytes.data(), &value, sizeof value);
    if (isBig) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string plyHeader(const std::string& format, const std::string& vertexCount = "4",
                      const std::string& faceCount = "1") {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertexCount +
           "\nproperty uchar red\nproperty float x\nproperty double y\nproperty float z\nelement face " + faceCount +
           "\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n";
}

/// One quad, with a color and a quality that nobody asks for.
std::string plyBytes(bool isBig) {
    std::string bytes = plyHeader(isBig ? "binary_big_endian" : "binary_little_endian");
    for (const vec3& p : kPoints)
        bytes += "c" + bytesOf(p.x, isBig) + bytesOf(double(p.y), isBig) + bytesOf(p.z, isBig);
    bytes += "\4";
    for (const int corner : {0, 1, 2, 3}) bytes += bytesOf(corner, isBig);
    return bytes + bytesOf(1.0f, isBig);
}

const std::string kPlyText = "7 0 0 0\n7 1 0 0.5\n7 1 1 0\n7 -0.25 1 3\n";

std::string stlBytes() {
    std::string bytes = "solid, and binary all the same";
    bytes.resize(80, ' ');
    bytes += bytesOf(std::uint32_t(2));
    for (std::size_t i = 0; i < 6; ++i) {
        if (i % 3 == 0) bytes += std::string(12, 0);
        for (int k = 0; k < 3; ++k) bytes += bytesOf(kPoints[kIndices[i]][k]);
        if (i % 3 == 2) bytes += std::string(2, 0);
    }
    return bytes;
}

TEST_F(ReadTriangles, ofAllLayoutsAreTheSame) {
    expectTriangles("text.ply", plyHeader("ascii") + kPlyText + "4 0 1 2 3 0.5\n");
    expectTriangles("windows.ply", [] {
        std::string text = plyHeader("ascii") + kPlyText + "4 0 1 2 3 0.5", out;
        for (const char c : text) out += c == '\n' ? "\r\n" : std::string(1, c);
        return out;
    }());
    expectTriangles("little.ply", plyBytes(false));
    expectTriangles("big.ply", plyBytes(true));
    expectTriangles("binary.stl", stlBytes());
    std::string text = "solid a b\n";
    for (std::size_t i = 0; i < 6; ++i) {
        if (i % 3 == 0) text += "facet normal 0 0 1\nouter loop\n";
        const vec3& p = kPoints[kIndices[i]];
        text += fmt::format("vertex {} {} {:e}\n", p.x, p.y, p.z);
        if (i % 3 == 2) text += "endloop\nendfacet\n";
    }
    expectTriangles("text.stl", text + "endsolid a b\n");
}

TEST_F(ReadTriangles, comesBackFromWhatIsWritten) {
    DenseMesh mesh;
    mesh.positions = kPoints, mesh.indices = kIndices, mesh.normals.assign(4, {0, 0, 1});
    mesh.coordinates.origin = {1e6, 0, 0};
    writeMesh(folder_ / "far.ply", mesh);
    const TriangleMesh read = readTriangles(folder_ / "far.ply", mesh.coordinates);
    EXPECT_EQ(read.positions, kPoints);
    EXPECT_EQ(read.indices, kIndices);
}

TEST_F(ReadTriangles, refusesFilesThatLie) {
    const std::string text = "ascii", little = "binary_little_endian";
    expectRefused("many.ply", plyHeader(little, "2147483648"), "claims 2147483648 elements 'vertex'");
    expectRefused("more.ply", plyHeader(text, "4", "99999999999") + kPlyText, "claims 99999999999 elements 'face'");
    expectRefused("minus.ply", plyHeader(text, "-4"), "-4 is no number of elements");
    expectRefused("list.ply", plyHeader(text) + kPlyText + "-1 0 1 2 3 0.5\n", "face 0 has a list of -1 numbers");
    expectRefused("longlist.ply", plyHeader(text) + kPlyText + "200 0 1 2 3 0.5\n", "face 0 has a list of 200 numbers");
    expectRefused("index.ply", plyHeader(text) + kPlyText + "4 0 1 2 4 0.5\n",
                  "face 0 names vertex 4; vertices 0 to 3");
    expectRefused("nan.ply", plyHeader(text) + "7 0 0 0\n7 1 nan 0.5\n7 1 1 0\n7 -0.25 1 3\n4 0 1 2 3 0.5\n",
                  "vertex 1 is not finite");
    expectRefused("word.ply", plyHeader(text) + "7 0 0 x7\n" + kPlyText + "4 0 1 2 3\n", "'x7' is no number");
    expectRefused("cut.ply", plyBytes(false).substr(0, plyBytes(false).size() - 6), "list of 4 numbers");
    expectRefused("vertices.ply", plyHeader(text, "5", "0") + kPlyText, "cut off");
    expectRefused("empty.ply", plyHeader(text, "4", "0") + kPlyText, "there are no triangles");
    expectRefused("zero.ply", "", "cut off");
    expectRefused("other.ply", "obj\n", "begins with a line 'ply'");
    expectRefused("type.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n", "no type quad");
    std::string stl = stlBytes();
    stl[83] = 1; // 16 million triangles more
    expectRefused("many.stl", stl, "claims 16777218 triangles");
    expectRefused("short.stl", "solid\nvertex 0 0 0\nvertex 1 0", "no number ''");
    expectRefused("tiny.stl", "abc", "3 bytes are no STL file");
}

} // namespace
} // namespace relief::test
