// STL (3D Systems, "Stereolithography interface specification", 1989): binary and text.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "mesh/read.h"

namespace relief {
namespace {

constexpr std::uint64_t kHeaderBytes = 84, kTriangleBytes = 50;

static_assert(std::endian::native == std::endian::little, "binary STL is read as its bytes lie in the file");

ReadTriangles readBinary(MeshSource& source) {
    std::uint32_t count = 0;
    std::memcpy(&count, source.take(kHeaderBytes) + 80, sizeof count);
    if (source.bytesLeft() / kTriangleBytes < count)
        fail(Failure::input, "{}: the header claims {} triangles of {} bytes each, and {} bytes are left",
             source.path(), count, kTriangleBytes, source.bytesLeft());
    if (count > std::numeric_limits<std::uint32_t>::max() / 3)
        fail(Failure::input, "{}: {} triangles; at most {} can be read", source.path(), count,
             std::numeric_limits<std::uint32_t>::max() / 3);
    ReadTriangles triangles;
    triangles.positions.reserve(3 * std::size_t(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        float numbers[9];
        std::memcpy(numbers, source.take(kTriangleBytes) + 12, sizeof numbers);
        for (int k = 0; k < 9; k += 3) triangles.positions.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
    }
    return triangles;
}

/// Only the words `vertex x y z` matter, three per facet.
ReadTriangles readText(MeshSource& source) {
    ReadTriangles triangles;
    source.takeLine(); // the solid's name may be any word
    for (std::string_view word = source.takeWord(); !word.empty(); word = source.takeWord()) {
        if (word == "solid") source.takeLine();
        if (word != "vertex") continue;
        dvec3 p;
        for (int k = 0; k < 3; ++k) {
            const std::string_view number = source.takeWord();
            const std::optional<double> value = numberOf(number);
            if (!value)
                fail(Failure::input, "{}: vertex {} has no number '{}'", source.path(), triangles.positions.size(),
                     onOneLine(std::string(number.substr(0, 40))));
            p[k] = *value;
        }
        triangles.positions.push_back(p);
    }
    if (triangles.positions.size() % 3 != 0) source.failCut();
    return triangles;
}

} // namespace

ReadTriangles readStl(const std::string& path) {
    // Some binary files begin with "solid" as well: the length decides, and a byte that no text has.
    const InputFile file(path);
    char head[kHeaderBytes] = {};
    const std::size_t length = file.read(0, head, kHeaderBytes);
    std::uint32_t count = 0;
    std::memcpy(&count, head + 80, sizeof count);
    const bool fits = length == kHeaderBytes && file.size() == kHeaderBytes + kTriangleBytes * std::uint64_t(count);
    const std::string_view start(head, length);
    const bool isText = !fits && start.starts_with("solid") && start.find('\0') == std::string_view::npos;
    if (!isText && length < kHeaderBytes) fail(Failure::input, "{}: {} bytes are no STL file", path, length);
    MeshSource source(path);
    ReadTriangles triangles = isText ? readText(source) : readBinary(source);
    triangles.indices.resize(triangles.positions.size());
    for (std::size_t i = 0; i < triangles.indices.size(); ++i) triangles.indices[i] = std::uint32_t(i);
    return triangles;
}

} // namespace relief
