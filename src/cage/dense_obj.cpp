// OBJ: numbers in the fewest digits that read back to the same bits.
#include <array>
#include <charconv>

#include "cage/dense_write.h"

namespace relief {

namespace {

/// One line of the file at a time; fmt would take twice as long over the numbers.
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

template <typename Vector>
void putValues(ObjLines& lines, std::string_view keyword, const std::vector<Vector>& values, Progress& progress) {
    putEach(values.size(), progress, [&](std::size_t i) {
        lines.word(keyword);
        for (int k = 0; k < Vector::length(); ++k) {
            lines.word(" ");
            lines.number(values[i][k]);
        }
        lines.endLine();
    });
}

/// In the world: doubles, where floats could not tell vertices apart.
void putPositions(ObjLines& lines, const DenseMesh& mesh, Progress& progress) {
    if (mesh.coordinates.isIdentity()) return putValues(lines, "v", mesh.positions, progress);
    putEach(mesh.positions.size(), progress, [&](std::size_t i) {
        const dvec3 p = mesh.coordinates.toWorld(mesh.positions[i]);
        lines.word("v");
        for (int k = 0; k < 3; ++k) {
            lines.word(" ");
            lines.number(p[k]);
        }
        lines.endLine();
    });
}

} // namespace

void writeDenseObj(MeshFile& file, const DenseMesh& mesh, ShowProgress show) {
    soundTriangleCount(mesh, file.path()); // throws where nothing would be left
    const std::size_t triangleCount = mesh.indices.size() / 3;
    Progress progress("writing", mesh.positions.size() + mesh.texCoords.size() + mesh.normals.size() + triangleCount,
                      show);
    ObjLines lines(file);
    putPositions(lines, mesh, progress);
    putValues(lines, "vt", mesh.texCoords, progress);
    putValues(lines, "vn", mesh.normals, progress);
    putEach(triangleCount, progress, [&](std::size_t triangle) {
        if (isDegenerate(mesh, triangle)) return;
        lines.word("f");
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t index = mesh.indices[3 * triangle + k] + 1;
            lines.word(" ");
            lines.number(index);
            lines.word("/");
            if (!mesh.texCoords.empty()) lines.number(index);
            lines.word("/");
            lines.number(index);
        }
        lines.endLine();
    });
}

} // namespace relief
