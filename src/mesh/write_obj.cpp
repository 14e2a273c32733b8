// OBJ: numbers in the fewest digits that read back to the same bits. A corner names position, texture coordinates and
// normal each by its own number, so that vertices which differ in the latter share their position.
#include <array>
#include <charconv>

#include "base/unique_points.h"
#include "mesh/write.h"

namespace relief {

namespace {

/// Builds one line of the file at a time; fmt would take twice as long to write the numbers.
class ObjLines {
public:
    explicit ObjLines(MeshFile& file) : file_(file) {}

    void word(std::string_view letters) { end_ = std::copy(letters.begin(), letters.end(), end_); }
    template <typename Number>
    void number(Number value) {
        end_ = std::to_chars(end_, line_.data() + line_.size(), value).ptr;
    }
    void endLine() {
        word("\n");
        file_.put({line_.data(), std::size_t(end_ - line_.data())});
        end_ = line_.data();
    }

private:
    MeshFile& file_;
    std::array<char, 128> line_; ///< longest: three corners of three 10-digit indices each
    char* end_ = line_.data();
};

template <typename ValueOf>
void putValues(ObjLines& lines, std::string_view keyword, std::size_t count, const ValueOf& valueOf,
               Progress& progress) {
    putEach(count, progress, [&](std::size_t i) {
        const auto value = valueOf(i);
        lines.word(keyword);
        for (int k = 0; k < value.length(); ++k) {
            lines.word(" ");
            lines.number(value[k]);
        }
        lines.endLine();
    });
}

/// True for a triangle with two corners at the same position.
bool isDegenerate(const DenseMesh& mesh, const UniquePoints& positions, std::size_t triangle) {
    const auto positionOf = [&](std::size_t k) { return positions.indices[mesh.indices[3 * triangle + k]]; };
    return positionOf(0) == positionOf(1) || positionOf(1) == positionOf(2) || positionOf(2) == positionOf(0);
}

/// Writes positions in the world: as doubles where floats could not separate vertices.
void putPositions(ObjLines& lines, const DenseMesh& mesh, const UniquePoints& positions, Progress& progress) {
    const auto position = [&](std::size_t i) { return mesh.positions[positions.firsts[i]]; };
    const auto inWorld = [&](std::size_t i) { return mesh.coordinates.toWorld(position(i)); };
    if (mesh.coordinates.isIdentity())
        putValues(lines, "v", positions.count(), position, progress);
    else
        putValues(lines, "v", positions.count(), inWorld, progress);
}

} // namespace

void writeDenseObj(MeshFile& file, const DenseMesh& mesh, ShowProgress show) {
    const std::size_t triangleCount = mesh.indices.size() / 3;
    const UniquePoints positions = findUniquePoints(mesh.positions);
    // Readers refuse degenerate faces: they are omitted, but a file without any face is no mesh.
    std::size_t soundCount = 0;
    for (std::size_t i = 0; i < triangleCount; ++i) soundCount += isDegenerate(mesh, positions, i) ? 0 : 1;
    if (soundCount == 0)
        fail(Failure::input, "{}: not written: every triangle of the mesh names a position twice", file.path());

    // Positions once each; texture coordinates and normals as vertices have them.
    Progress progress("writing", positions.count() + mesh.texCoords.size() + mesh.normals.size() + triangleCount, show);
    ObjLines lines(file);
    putPositions(lines, mesh, positions, progress);
    putValues(
        lines, "vt", mesh.texCoords.size(), [&](std::size_t i) { return mesh.texCoords[i]; }, progress);
    putValues(
        lines, "vn", mesh.normals.size(), [&](std::size_t i) { return mesh.normals[i]; }, progress);

    // Corners name all three by numbers from 1.
    putEach(triangleCount, progress, [&](std::size_t triangle) {
        if (isDegenerate(mesh, positions, triangle)) return;
        lines.word("f");
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t index = mesh.indices[3 * triangle + k] + 1;
            lines.word(" ");
            lines.number(positions.indices[index - 1] + 1);
            lines.word("/");
            if (!mesh.texCoords.empty()) lines.number(index);
            lines.word("/");
            lines.number(index);
        }
        lines.endLine();
    });
}

} // namespace relief
