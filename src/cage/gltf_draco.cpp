// KHR_draco_mesh_compression: a primitive's triangles and attributes as one stream of Draco's, version 2.2.
#include <algorithm>
#include <exception>

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

/// What the decoder takes while it works, in numbers of 32 bits per face.
constexpr std::uint64_t kNumbersPerFace = 16;
/// A plane of equal steps, the best case of the encoder, has about 90 faces per byte.
constexpr std::uint64_t kMostFacesPerByte = 1024;

struct DracoCounts {
    std::uint32_t points = 0, faces = 0; ///< Edgebreaker: the points may still be split along seams
    bool isEdgebreaker = false;
};

/// The counts that a stream begins with; empty where the stream is not a mesh (draft bitstream specification 2.2,
/// sections 3 and 4).
std::optional<DracoCounts> countsOf(std::span<const unsigned char> bytes) {
    constexpr std::string_view kMagic = "DRACO";
    constexpr std::uint16_t kVersion = 2 << 8 | 2, kHasMetadata = 0x8000;
    constexpr std::uint8_t kMesh = 1, kSequential = 0, kEdgebreaker = 1;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size(), kVersion);
    char magic[kMagic.size()];
    std::uint8_t major = 0, minor = 0, type = 0, method = 0, traversal = 0;
    std::uint16_t flags = 0;
    // The header: kind of data and version.
    if (!buffer.Decode(magic, sizeof(magic)) || std::string_view(magic, sizeof(magic)) != kMagic) return std::nullopt;
    if (!buffer.Decode(&major) || !buffer.Decode(&minor) || major != 2 || minor != 2) return std::nullopt;
    if (!buffer.Decode(&type) || !buffer.Decode(&method) || !buffer.Decode(&flags)) return std::nullopt;
    if (type != kMesh || method > kEdgebreaker) return std::nullopt;
    draco::GeometryMetadata metadata;
    if ((flags & kHasMetadata) != 0 && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
        return std::nullopt;
    // The beginning of the connectivity.
    DracoCounts counts{.isEdgebreaker = method == kEdgebreaker};
    if (method == kSequential) {
        if (!draco::DecodeVarint(&counts.faces, &buffer) || !draco::DecodeVarint(&counts.points, &buffer))
            return std::nullopt;
    } else if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&counts.points, &buffer) ||
               !draco::DecodeVarint(&counts.faces, &buffer)) {
        return std::nullopt;
    }
    return counts;
}

/// Decodes the stream. Throws where the decoder fails.
std::unique_ptr<draco::Mesh> decoded(std::span<const unsigned char> bytes, const GltfElement& extension) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (!mesh.ok()) extension.fail("Draco cannot decode it: {}", printable(mesh.status().error_msg_string()));
        return std::move(mesh).value();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) { // of containers that damaged data make too large
        extension.fail("Draco cannot decode it: {}", printable(error.what()));
    }
}

void checkCounts(const GltfElement& extension, std::uint64_t points, std::uint64_t faces, std::uint64_t expectedPoints,
                 std::uint64_t expectedFaces) {
    if (points != expectedPoints || faces != expectedFaces)
        extension.fail("{} vertices and {} triangles are compressed, {} and {} expected", points, faces, expectedPoints,
                       expectedFaces);
}

} // namespace

GltfDracoMeshes::GltfDracoMeshes(const GltfDocument& document, GltfAccessors& accessors)
    : document_(document), accessors_(accessors) {}
GltfDracoMeshes::~GltfDracoMeshes() = default;

const draco::Mesh& GltfDracoMeshes::decode(const GltfElement& extension, std::uint64_t pointCount,
                                           std::uint64_t faceCount) {
    const std::uint32_t view = *extension.need("bufferView").integer("bufferView");
    std::unique_ptr<draco::Mesh>& mesh = meshes_[view];
    if (mesh == nullptr) {
        const std::span<const unsigned char> bytes = accessors_.buffers().view(view, extension.place());
        const std::optional<DracoCounts> counts = countsOf(bytes);
        if (!counts) extension.fail("buffer view {} holds no mesh of Draco 2.2; is the file whole?", view);
        checkCounts(extension, counts->isEdgebreaker ? pointCount : counts->points, counts->faces, pointCount,
                    faceCount);
        if (counts->faces > kMostFacesPerByte * bytes.size())
            extension.fail("{} triangles cannot be in {} bytes", counts->faces, bytes.size());
        accessors_.takeRoom(kNumbersPerFace * counts->faces, extension.place());
        mesh = decoded(bytes, extension);
    }
    checkCounts(extension, mesh->num_points(), mesh->num_faces(), pointCount, faceCount);
    return *mesh;
}

const draco::PointAttribute* dracoAttribute(const draco::Mesh& mesh, const GltfElement& extension,
                                            const std::string& name) {
    const std::optional<GltfElement> ids = extension.need("attributes").object("attributes");
    const std::optional<std::uint32_t> id = ids->integer(name);
    if (!id) return nullptr;
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(*id);
    if (attribute == nullptr) ids->fail("{} is attribute {}, which is not in the compressed data", name, *id);
    // All values must be inside its bytes, and every point must have one.
    const std::int64_t end = attribute->byte_offset() + attribute->byte_stride() * std::int64_t(attribute->size());
    bool isWhole = attribute->buffer() != nullptr && attribute->byte_offset() >= 0 && attribute->byte_stride() >= 0 &&
                   end <= std::int64_t(attribute->buffer()->data_size()) &&
                   attribute->byte_stride() >=
                       std::int64_t(attribute->num_components()) * draco::DataTypeLength(attribute->data_type());
    for (std::uint32_t point = 0; isWhole && point < mesh.num_points(); ++point)
        isWhole = attribute->mapped_index(draco::PointIndex(point)).value() < attribute->size();
    if (!isWhole) ids->fail("{} does not have all of its values", name);
    return attribute;
}

std::vector<std::uint32_t> dracoCorners(const draco::Mesh& mesh) {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * std::size_t(mesh.num_faces()));
    for (std::uint32_t face = 0; face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(face))) corners.push_back(point.value());
    return corners;
}

} // namespace relief
