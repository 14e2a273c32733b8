#include "mesh/read.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "base/unique_points.h"

namespace relief {
namespace {

constexpr std::size_t kReadBytes = 1 << 20;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

void checkPositions(const ReadTriangles& read, const std::string& path) {
    for (std::size_t i = 0; i < read.positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(read.positions[i][k]) <= kFarthestCoordinate))
                fail(Failure::input, "{}: vertex {} is not finite ({}); give it numbers", path, i,
                     read.positions[i][k]);
    if (read.indices.empty()) fail(Failure::input, "{}: there are no triangles", path);
}

/// One vertex per position: STL repeats them in each triangle.
void mergeEqualPositions(TriangleMesh& mesh) {
    const UniquePoints unique = findUniquePoints(mesh.positions);
    for (std::uint32_t& index : mesh.indices) index = unique.indices[index];
    std::vector<vec3> merged;
    merged.reserve(unique.count());
    for (const std::uint32_t first : unique.firsts) merged.push_back(mesh.positions[first]);
    mesh.positions = std::move(merged);
}

} // namespace

bool MeshSource::refill() {
    buffer_.resize(kReadBytes);
    std::memmove(buffer_.data(), buffer_.data() + used_, filled_ - used_);
    filled_ -= used_, used_ = 0;
    const std::size_t count = file_.read(offset_, buffer_.data() + filled_, buffer_.size() - filled_);
    offset_ += count, filled_ += count;
    return count > 0;
}

void MeshSource::failCut() const {
    fail(Failure::input, "{}: the file ends too early, after {} bytes; it is cut off", path(), size());
}

const char* MeshSource::take(std::size_t count) {
    RELIEF_CHECK(count <= kReadBytes);
    while (filled_ - used_ < count)
        if (!refill()) failCut();
    used_ += count;
    return buffer_.data() + used_ - count;
}

std::string_view MeshSource::takeLine() {
    std::size_t length = 0;
    for (;; ++length) {
        if (used_ + length == filled_ && (length == kReadBytes || !refill())) failCut();
        if (buffer_[used_ + length] == '\n') break;
    }
    std::string_view line(buffer_.data() + used_, length);
    used_ += length + 1;
    while (!line.empty() && isSpace(line.back())) line.remove_suffix(1);
    return line;
}

std::string_view MeshSource::takeWord() {
    while (used_ < filled_ || refill()) {
        if (!isSpace(buffer_[used_])) break;
        ++used_;
    }
    std::size_t length = 0;
    while ((used_ + length < filled_ || (length < kReadBytes && refill())) && !isSpace(buffer_[used_ + length]))
        ++length;
    used_ += length;
    return {buffer_.data() + used_ - length, length};
}

std::optional<double> numberOf(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (end != word.data() + word.size() || error != std::errc()) return {};
    return number;
}

bool isTriangleFile(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".ply" || extension == ".stl";
}

TriangleMesh readTriangles(const std::string& path, const std::optional<Coordinates>& coordinates) {
    const std::string extension = lowerExtension(path);
    if (!isTriangleFile(path)) fail(Failure::usage, "{}: unknown kind of mesh '{}'; use .ply or .stl", path, extension);
    ReadTriangles read = extension == ".ply" ? readPly(path) : readStl(path);
    checkPositions(read, path);
    TriangleMesh mesh;
    mesh.coordinates = coordinates ? *coordinates : coordinatesFor(computeBounds(read.positions));
    mesh.positions.reserve(read.positions.size());
    for (const dvec3& p : read.positions) mesh.positions.emplace_back(mesh.coordinates.toLocal(p));
    mesh.indices = std::move(read.indices);
    if (extension == ".stl") mergeEqualPositions(mesh);
    return mesh;
}

} // namespace relief
