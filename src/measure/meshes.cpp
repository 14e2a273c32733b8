#include <algorithm>
#include <cmath>
#include <limits>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include "measure/measure.h"

namespace relief {
namespace {

const float* toFloats(const std::vector<vec3>& values) { return values.empty() ? nullptr : &values.front().x; }

/// Orders the vertices as `indices` first name them, and drops those that no triangle has.
DenseMesh reorderVertices(const DenseMesh& mesh, std::vector<std::uint32_t> indices) {
    std::vector<std::uint32_t> newIndices(mesh.positions.size());
    const std::size_t count =
        meshopt_optimizeVertexFetchRemap(newIndices.data(), indices.data(), indices.size(), mesh.positions.size());
    DenseMesh result;
    result.positions.resize(count);
    result.normals.resize(mesh.normals.empty() ? 0 : count);
    result.texCoords.resize(mesh.texCoords.empty() ? 0 : count);
    for (std::size_t i = 0; i < newIndices.size(); ++i) {
        if (newIndices[i] == ~0u) continue;
        result.positions[newIndices[i]] = mesh.positions[i];
        if (!mesh.normals.empty()) result.normals[newIndices[i]] = mesh.normals[i];
        if (!mesh.texCoords.empty()) result.texCoords[newIndices[i]] = mesh.texCoords[i];
    }
    for (std::uint32_t& index : indices) index = newIndices[index];
    result.indices = std::move(indices);
    return result;
}

/// One vertex in kQuantisedLayout.
struct QuantisedVertex {
    std::uint16_t position[3];
    std::int8_t normal[2];
    std::uint16_t texCoord[2];
};
static_assert(sizeof(QuantisedVertex) == kQuantisedLayout.vertexBytes());

/// Meyer et al., "On floating-point normal vectors", 2010: the octahedron unfolded into a square.
vec2 toOctahedral(const vec3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (!(sum > 0)) return vec2(0);
    const vec2 p(n.x / sum, n.y / sum);
    if (n.z >= 0) return p;
    return {(1 - std::abs(p.y)) * (p.x < 0 ? -1.0f : 1.0f), (1 - std::abs(p.x)) * (p.y < 0 ? -1.0f : 1.0f)};
}
vec3 fromOctahedral(const vec2& p) {
    vec3 n(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0) {
        const vec2 q(n.x, n.y);
        n.x = (1 - std::abs(q.y)) * (q.x < 0 ? -1.0f : 1.0f);
        n.y = (1 - std::abs(q.x)) * (q.y < 0 ? -1.0f : 1.0f);
    }
    return glm::normalize(n);
}

/// Numbers of 16 bits, evenly over the range of all values along each axis.
template <typename Vector>
class QuantisationGrid {
public:
    explicit QuantisationGrid(const std::vector<Vector>& values) : lower_(0), step_(1) {
        if (values.empty()) return;
        Vector upper = lower_ = values.front();
        for (const Vector& v : values) lower_ = glm::min(lower_, v), upper = glm::max(upper, v);
        step_ = glm::max((upper - lower_) / 65535.0f, Vector(std::numeric_limits<float>::min()));
    }
    [[nodiscard]] std::uint16_t encode(const Vector& value, int axis) const {
        return std::uint16_t(std::lround(std::clamp((value[axis] - lower_[axis]) / step_[axis], 0.0f, 65535.0f)));
    }
    [[nodiscard]] float decode(std::uint16_t code, int axis) const { return lower_[axis] + float(code) * step_[axis]; }

private:
    Vector lower_, step_;
};

/// Bytes of vertices and indices in meshoptimizer's coding.
std::uint64_t measureMeshoptBytes(std::span<const QuantisedVertex> vertices, std::span<const std::uint32_t> indices) {
    std::vector<unsigned char> buffer(
        std::max(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(QuantisedVertex)),
                 meshopt_encodeIndexBufferBound(indices.size(), vertices.size())));
    return meshopt_encodeVertexBuffer(buffer.data(), buffer.size(), vertices.data(), vertices.size(),
                                      sizeof(QuantisedVertex)) +
           meshopt_encodeIndexBuffer(buffer.data(), buffer.size(), indices.data(), indices.size());
}

template <typename Vector>
void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, const std::vector<Vector>& values) {
    if (values.empty()) return;
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, Vector::length(), draco::DT_FLOAT32, false, sizeof(Vector), 0);
    const int id = mesh.AddAttribute(attribute, true, std::uint32_t(values.size()));
    for (std::uint32_t i = 0; i < values.size(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i][0]);
}

/// Vertices at seams become one position with several texture coordinates, as Draco expects.
void fillDracoMesh(draco::Mesh& result, const DenseMesh& mesh) {
    result.set_num_points(std::uint32_t(mesh.positions.size()));
    addAttribute(result, draco::GeometryAttribute::POSITION, mesh.positions);
    addAttribute(result, draco::GeometryAttribute::NORMAL, mesh.normals);
    addAttribute(result, draco::GeometryAttribute::TEX_COORD, mesh.texCoords);
    result.SetNumFaces(mesh.indices.size() / 3);
    for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
        draco::Mesh::Face face;
        for (std::size_t i = 0; i < 3; ++i) face[i] = draco::PointIndex(mesh.indices[3 * t + i]);
        result.SetFace(draco::FaceIndex(t), face);
    }
    result.DeduplicateAttributeValues();
    result.DeduplicatePointIds();
}

std::vector<vec3> readAttribute(const draco::Mesh& mesh, draco::GeometryAttribute::Type type) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(type);
    if (attribute == nullptr) return {};
    std::vector<vec3> values(mesh.num_points());
    for (std::uint32_t i = 0; i < values.size(); ++i) attribute->GetMappedValue(draco::PointIndex(i), &values[i].x);
    return values;
}

} // namespace

EncodedMesh quantiseMesh(const DenseMesh& mesh) {
    // Triangles in the order that the vertex cache likes, then vertices in the order of the triangles.
    std::vector<std::uint32_t> indices(mesh.indices.size());
    meshopt_optimizeVertexCache(indices.data(), mesh.indices.data(), indices.size(), mesh.positions.size());
    EncodedMesh result{.decoded = reorderVertices(mesh, std::move(indices))};
    DenseMesh& decoded = result.decoded;
    // Each vertex is encoded, and decoded again to what a shader would read.
    const QuantisationGrid<vec3> positions(decoded.positions);
    const QuantisationGrid<vec2> texCoords(decoded.texCoords);
    std::vector<QuantisedVertex> vertices(decoded.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        QuantisedVertex& v = vertices[i];
        for (int axis = 0; axis < 3; ++axis) {
            v.position[axis] = positions.encode(decoded.positions[i], axis);
            decoded.positions[i][axis] = positions.decode(v.position[axis], axis);
        }
        const vec2 normal = decoded.normals.empty() ? vec2(0) : toOctahedral(decoded.normals[i]);
        for (int axis = 0; axis < 2; ++axis) v.normal[axis] = std::int8_t(std::lround(127 * normal[axis]));
        if (!decoded.normals.empty()) decoded.normals[i] = fromOctahedral(vec2(v.normal[0], v.normal[1]) / 127.0f);
        for (int axis = 0; axis < 2 && !decoded.texCoords.empty(); ++axis) {
            v.texCoord[axis] = texCoords.encode(decoded.texCoords[i], axis);
            decoded.texCoords[i][axis] = texCoords.decode(v.texCoord[axis], axis);
        }
    }
    result.residentBytes = denseBytes(vertices.size(), decoded.indices.size() / 3, kQuantisedLayout);
    result.diskBytes = measureMeshoptBytes(vertices, decoded.indices);
    return result;
}

DenseMesh simplifyMesh(const DenseMesh& mesh, std::size_t triangleCount) {
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(), toFloats(mesh.positions),
                                    mesh.positions.size(), sizeof(vec3), 3 * triangleCount, 1.0f, 0, nullptr));
    return reorderVertices(mesh, std::move(indices));
}

EncodedMesh encodeWithDraco(const DenseMesh& mesh, int positionBits) {
    // Encoding.
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, positionBits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 8);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    encoder.SetSpeedOptions(3, 3); // the default of Draco's own encoder program
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    draco::Mesh whole;
    fillDracoMesh(whole, mesh);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeMeshToBuffer(whole, &buffer); !status.ok())
        fail(Failure::internal, "Draco does not encode {} triangles: {}", mesh.indices.size() / 3,
             status.error_msg_string());
    // Decoding: the error is that of the decoded mesh.
    draco::DecoderBuffer coded;
    coded.Init(buffer.data(), buffer.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&coded);
    if (!decoded.ok())
        fail(Failure::internal, "Draco does not decode what it encoded: {}", decoded.status().error_msg_string());
    const draco::Mesh& from = *decoded.value();
    RELIEF_CHECK(from.num_faces() <= mesh.indices.size() / 3);
    EncodedMesh result{.diskBytes = buffer.size()};
    result.decoded.positions = readAttribute(from, draco::GeometryAttribute::POSITION);
    result.decoded.normals = readAttribute(from, draco::GeometryAttribute::NORMAL);
    for (draco::FaceIndex face(0); face < from.num_faces(); ++face)
        for (const draco::PointIndex& point : from.face(face)) result.decoded.indices.push_back(point.value());
    return result;
}

} // namespace relief
