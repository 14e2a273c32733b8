#include <algorithm>
#include <cmath>
#include <limits>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include "measure/measure.h"

namespace relief {
namespace {

const float* floatsOf(const std::vector<vec3>& values) { return values.empty() ? nullptr : &values.front().x; }

/// The mesh with its vertices in another order, those that no triangle names left out.
DenseMesh reordered(const DenseMesh& mesh, std::vector<std::uint32_t> indices) {
    std::vector<std::uint32_t> places(mesh.positions.size());
    const std::size_t count =
        meshopt_optimizeVertexFetchRemap(places.data(), indices.data(), indices.size(), mesh.positions.size());
    DenseMesh result;
    result.positions.resize(count);
    result.normals.resize(mesh.normals.empty() ? 0 : count);
    result.texCoords.resize(mesh.texCoords.empty() ? 0 : count);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] == ~0u) continue;
        result.positions[places[i]] = mesh.positions[i];
        if (!mesh.normals.empty()) result.normals[places[i]] = mesh.normals[i];
        if (!mesh.texCoords.empty()) result.texCoords[places[i]] = mesh.texCoords[i];
    }
    for (std::uint32_t& index : indices) index = places[index];
    result.indices = std::move(indices);
    return result;
}

/// One vertex in kQuantisedLayout.
struct QuantisedVertex {
    std::uint16_t position[3];
    std::int8_t normal[2];
    std::uint16_t texCoord[2];
};
static_assert(sizeof(QuantisedVertex) == 12);

/// Meyer et al., "On floating-point normal vectors", 2010: the octahedron unfolded into a square.
vec2 octahedral(const vec3& n) {
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

/// 16 bits a number over the range of all of them.
template <typename Vector>
class Grid {
public:
    explicit Grid(const std::vector<Vector>& values) : lower_(0), step_(1) {
        if (values.empty()) return;
        Vector upper = lower_ = values.front();
        for (const Vector& v : values) lower_ = glm::min(lower_, v), upper = glm::max(upper, v);
        step_ = glm::max((upper - lower_) / 65535.0f, Vector(std::numeric_limits<float>::min()));
    }
    [[nodiscard]] std::uint16_t at(const Vector& value, int axis) const {
        return std::uint16_t(std::lround(std::clamp((value[axis] - lower_[axis]) / step_[axis], 0.0f, 65535.0f)));
    }
    [[nodiscard]] float value(std::uint16_t at, int axis) const { return lower_[axis] + float(at) * step_[axis]; }

private:
    Vector lower_, step_;
};

std::uint64_t meshoptBytes(std::span<const QuantisedVertex> vertices, std::span<const std::uint32_t> indices) {
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

/// Vertices along seams become one position with several texture coordinates, as Draco wants them.
void fill(draco::Mesh& result, const DenseMesh& mesh) {
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

std::vector<vec3> vectorsOf(const draco::Mesh& mesh, draco::GeometryAttribute::Type type) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(type);
    std::vector<vec3> values(attribute != nullptr ? mesh.num_points() : 0);
    for (std::uint32_t i = 0; i < values.size(); ++i) attribute->GetMappedValue(draco::PointIndex(i), &values[i].x);
    return values;
}

} // namespace

EncodedMesh quantised(const DenseMesh& mesh) {
    std::vector<std::uint32_t> indices(mesh.indices.size());
    meshopt_optimizeVertexCache(indices.data(), mesh.indices.data(), indices.size(), mesh.positions.size());
    EncodedMesh result{.decoded = reordered(mesh, std::move(indices))};
    DenseMesh& decoded = result.decoded;
    const Grid<vec3> positions(decoded.positions);
    const Grid<vec2> texCoords(decoded.texCoords);
    std::vector<QuantisedVertex> vertices(decoded.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        QuantisedVertex& v = vertices[i];
        for (int axis = 0; axis < 3; ++axis) {
            v.position[axis] = positions.at(decoded.positions[i], axis);
            decoded.positions[i][axis] = positions.value(v.position[axis], axis);
        }
        const vec2 normal = decoded.normals.empty() ? vec2(0) : octahedral(decoded.normals[i]);
        for (int axis = 0; axis < 2; ++axis) v.normal[axis] = std::int8_t(std::lround(127 * normal[axis]));
        if (!decoded.normals.empty()) decoded.normals[i] = fromOctahedral(vec2(v.normal[0], v.normal[1]) / 127.0f);
        for (int axis = 0; axis < 2 && !decoded.texCoords.empty(); ++axis) {
            v.texCoord[axis] = texCoords.at(decoded.texCoords[i], axis);
            decoded.texCoords[i][axis] = texCoords.value(v.texCoord[axis], axis);
        }
    }
    result.residentBytes = residentBytes(kQuantisedLayout, {vertices.size(), decoded.indices.size() / 3});
    result.diskBytes = meshoptBytes(vertices, decoded.indices);
    return result;
}

DenseMesh simplified(const DenseMesh& mesh, std::size_t triangles) {
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(), floatsOf(mesh.positions),
                                    mesh.positions.size(), sizeof(vec3), 3 * triangles, 1.0f, 0, nullptr));
    return reordered(mesh, std::move(indices));
}

EncodedMesh dracoEncoded(const DenseMesh& mesh, int positionBits) {
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, positionBits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 8);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    encoder.SetSpeedOptions(3, 3); // what its own encoder program does
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    draco::Mesh whole;
    fill(whole, mesh);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeMeshToBuffer(whole, &buffer); !status.ok())
        fail(Failure::internal, "Draco does not encode {} triangles: {}", mesh.indices.size() / 3,
             status.error_msg_string());
    draco::DecoderBuffer coded;
    coded.Init(buffer.data(), buffer.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&coded);
    if (!decoded.ok())
        fail(Failure::internal, "Draco does not decode what it encoded: {}", decoded.status().error_msg_string());
    const draco::Mesh& from = *decoded.value();
    EncodedMesh result{.diskBytes = buffer.size()};
    result.decoded.positions = vectorsOf(from, draco::GeometryAttribute::POSITION);
    result.decoded.normals = vectorsOf(from, draco::GeometryAttribute::NORMAL);
    for (draco::FaceIndex face(0); face < from.num_faces(); ++face)
        for (const draco::PointIndex& point : from.face(face)) result.decoded.indices.push_back(point.value());
    return result;
}

} // namespace relief
