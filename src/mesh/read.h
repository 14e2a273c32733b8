// Internal: what the readers of dense meshes share: a file that is read from front to back through a buffer.
#pragma once

#include <optional>

#include "mesh/mesh.h"

namespace relief {

/// A file read in pieces of at most 1 MiB. Everything throws Failure::file when reading fails and Failure::input where
/// the file ends too early.
class MeshSource {
public:
    explicit MeshSource(const std::string& path) : file_(path) {}

    [[nodiscard]] const std::string& path() const { return file_.path(); }
    [[nodiscard]] std::uint64_t size() const { return file_.size(); }
    [[nodiscard]] std::uint64_t bytesLeft() const { return file_.size() - offset_ + (filled_ - used_); }
    /// The next `count` bytes, 1 MiB at most; valid until the next call.
    const char* take(std::size_t count);
    /// The next line without its end; valid until the next call.
    std::string_view takeLine();
    /// The next word between white space; valid until the next call. Empty at the end of the file.
    std::string_view takeWord();
    [[noreturn]] void failCut() const;

private:
    bool refill(); ///< keeps what is not used yet; false at the end of the file

    InputFile file_;
    std::vector<char> buffer_;
    std::uint64_t offset_ = 0; ///< of what is read next
    std::size_t used_ = 0, filled_ = 0;
};

/// Reads one number of a text, whole; empty where the word is none.
std::optional<double> numberOf(std::string_view word);

/// Triangles in world coordinates, as files hold them.
struct ReadTriangles {
    std::vector<dvec3> positions;
    std::vector<std::uint32_t> indices;
};
ReadTriangles readPly(const std::string& path);
ReadTriangles readStl(const std::string& path); ///< three vertices per triangle

} // namespace relief
