// What the writers of dense meshes share: a file that is filled in chunks, and one function per format.
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>

#include "mesh/mesh.h"

namespace relief {

/// A file filled from front to back through a buffer; throws Failure::file as soon as writing fails.
class MeshFile {
public:
    /// Writes to `temporary`; messages call it `path`.
    MeshFile(std::string path, const std::string& temporary);
    void put(std::string_view bytes); ///< fewer than 1 MiB at a time
    template <typename Value>
    void putValue(const Value& value) {
        put({reinterpret_cast<const char*>(&value), sizeof(Value)});
    }
    void close();
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void flush();
    [[noreturn]] void failToWrite() const;

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<char> buffer_;
    std::size_t used_ = 0;
};

/// Calls `put` with 0 ... count - 1 and moves the bar after every chunk of them.
template <typename Put>
void putEach(std::size_t count, Progress& progress, const Put& put) {
    constexpr std::size_t kChunk = 1 << 15;
    for (std::size_t first = 0; first < count; first += kChunk) {
        const std::size_t end = std::min(count, first + kChunk);
        for (std::size_t i = first; i < end; ++i) put(i);
        progress.advance(end - first);
    }
}

/// True for a triangle that names a vertex twice: readers and validators refuse such faces.
inline bool isDegenerate(const DenseMesh& mesh, std::size_t triangle) {
    const std::uint32_t* i = &mesh.indices[3 * triangle];
    return i[0] == i[1] || i[1] == i[2] || i[2] == i[0];
}

/// Counts the triangles that are not degenerate. Throws Failure::input when there are none.
std::size_t soundTriangleCount(const DenseMesh& mesh, const std::string& path);

/// Write a valid mesh that has triangles. Each writer shows a progress bar of its own, because they differ in how often
/// they walk over the mesh.
void writePly(MeshFile& file, const DenseMesh& mesh, ShowProgress show);
void writeDenseObj(MeshFile& file, const DenseMesh& mesh, ShowProgress show);
void writeGlb(MeshFile& file, const DenseMesh& mesh, ShowProgress show);

} // namespace relief
