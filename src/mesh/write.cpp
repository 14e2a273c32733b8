#include "mesh/write.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>

namespace relief {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

/// The headers and the JSON of a .glb, generously.
constexpr std::uint64_t kGlbOverhead = 4096;

struct Format {
    const char* extension;
    void (*write)(MeshFile& file, const DenseMesh& mesh, ShowProgress show);
    std::uint64_t maxVertexCount, maxBytes;
};

constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMax32 = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kMax31 = std::numeric_limits<std::int32_t>::max(); // readers of OBJ count with int

constexpr std::array kFormats = {
    Format{".ply", writePly, kMax32, kAny}, Format{".obj", writeDenseObj, kMax31, kAny},
    Format{".glb", writeGlb, kMax32, kMax32 - kGlbOverhead}, // its length is a 32-bit number
};

const Format& formatOf(const std::string& path) {
    const std::string extension = lowerExtension(path);
    for (const Format& format : kFormats)
        if (extension == format.extension) return format;
    fail(Failure::usage, "{}: unknown kind of mesh '{}'; use .ply, .obj or .glb", path, extension);
}

template <typename Vector>
void checkNumbers(const std::vector<Vector>& values, const char* what, const std::string& path) {
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int k = 0; k < Vector::length(); ++k)
            if (!std::isfinite(values[i][k]))
                fail(Failure::input, "{}: not written: the {} of vertex {} of the mesh is not finite ({})", path, what,
                     i, values[i][k]);
}

void checkMesh(const DenseMesh& mesh, const std::string& path) {
    const std::size_t count = mesh.positions.size();
    if (mesh.indices.empty()) fail(Failure::input, "{}: not written: the mesh has no triangles", path);
    if (mesh.normals.size() != count || (!mesh.texCoords.empty() && mesh.texCoords.size() != count) ||
        mesh.indices.size() % 3 != 0)
        fail(Failure::input,
             "{}: not written: {} positions, {} normals, {} texture coordinates, {} indices; expected one of each per "
             "vertex and three indices per triangle",
             path, count, mesh.normals.size(), mesh.texCoords.size(), mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= count)
            fail(Failure::input, "{}: not written: triangle {} of the mesh names vertex {}; there are {} (from 0)",
                 path, i / 3, mesh.indices[i], count);
    checkNumbers(mesh.positions, "position", path);
    checkNumbers(mesh.normals, "normal", path);
    checkNumbers(mesh.texCoords, "texture coordinate", path);
}

} // namespace

MeshFile::MeshFile(std::string path, const std::string& temporary)
    : path_(std::move(path)), file_(std::fopen(temporary.c_str(), "wb")), buffer_(kBufferBytes) {
    if (!file_) failToWrite();
}

void MeshFile::failToWrite() const {
    fail(Failure::file, "{}: cannot be written: {}", path_, std::generic_category().message(errno));
}

void MeshFile::put(std::string_view bytes) {
    if (used_ + bytes.size() > buffer_.size()) flush();
    std::memcpy(buffer_.data() + used_, bytes.data(), bytes.size());
    used_ += bytes.size();
}

void MeshFile::flush() {
    if (std::fwrite(buffer_.data(), 1, used_, file_.get()) != used_) failToWrite();
    used_ = 0;
}

void MeshFile::close() {
    flush();
    if (std::fclose(file_.release()) != 0) failToWrite(); // a full disk may show only here
}

std::size_t soundTriangleCount(const DenseMesh& mesh, const std::string& path) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i) count += isDegenerate(mesh, i) ? 0 : 1;
    if (count == 0) fail(Failure::input, "{}: not written: every triangle of the mesh names a vertex twice", path);
    return count;
}

void checkMeshPath(const std::string& path) { formatOf(path); }

void checkMeshSize(const std::string& path, std::uint64_t vertexCount, std::uint64_t triangleCount, bool hasTexCoords) {
    const Format& format = formatOf(path);
    if (vertexCount > format.maxVertexCount)
        fail(Failure::input, "{}: {} vertices, {} holds at most {}; use a lower rate", path, vertexCount,
             format.extension, format.maxVertexCount);
    const std::uint64_t bytes = denseBytes(vertexCount, triangleCount) - (hasTexCoords ? 0 : 8 * vertexCount);
    if (bytes > format.maxBytes)
        fail(Failure::input, "{}: {} vertices and {} triangles take {}, {} holds at most 4 GiB; use .ply", path,
             vertexCount, triangleCount, humanBytes(bytes), format.extension);
}

void writeMesh(const std::string& path, const DenseMesh& mesh, ShowProgress show) {
    const Format& format = formatOf(path);
    checkMesh(mesh, path);
    checkMeshSize(path, mesh.positions.size(), mesh.indices.size() / 3, !mesh.texCoords.empty());
    writeWhole(path, [&](const std::string& temporary) {
        MeshFile file(path, temporary);
        format.write(file, mesh, show);
        file.close();
    });
}

} // namespace relief
