#include "cage/gltf.h"

namespace relief {
namespace {

/// The matrix T * R * S of a node (section 3.5.2).
glm::dmat4 matrixOf(const GltfTransform& transform) {
    glm::dmat4 matrix = glm::mat4_cast(transform.rotation);
    for (int k = 0; k < 3; ++k) matrix[k] *= transform.scale[k];
    matrix[3] = glm::dvec4(transform.translation, 1);
    return matrix;
}

} // namespace

std::vector<GltfTransform> restTransforms(const GltfScene& scene) {
    std::vector<GltfTransform> transforms;
    transforms.reserve(scene.nodes.size());
    for (const GltfNode& node : scene.nodes) transforms.push_back(node.transform);
    return transforms;
}

std::vector<glm::dmat4> worldMatrices(const GltfScene& scene, std::span<const GltfTransform> transforms) {
    std::vector<glm::dmat4> worlds(scene.nodes.size());
    for (const std::uint32_t i : scene.order) {
        const GltfNode& node = scene.nodes[i];
        const glm::dmat4 local = node.matrix ? *node.matrix : matrixOf(transforms[i]);
        worlds[i] = node.parent < 0 ? local : worlds[std::size_t(node.parent)] * local;
    }
    return worlds;
}

glm::dmat4 leadingTo(const Coordinates& coordinates, const glm::dmat4& matrix) {
    if (coordinates.isIdentity()) return matrix;
    glm::dmat4 local(glm::dmat3(matrix) / coordinates.unit);
    local[3] = glm::dvec4(coordinates.toLocal(dvec3(matrix[3])), 1);
    return local;
}

std::vector<glm::dmat4> jointMatrices(const GltfScene& scene, std::uint32_t node, std::span<const glm::dmat4> worlds,
                                      const Coordinates& coordinates) {
    if (scene.nodes[node].skin < 0) return {leadingTo(coordinates, worlds[node])};
    const GltfSkin& skin = scene.skins[std::size_t(scene.nodes[node].skin)];
    std::vector<glm::dmat4> joints;
    for (std::size_t i = 0; i < skin.joints.size(); ++i)
        joints.push_back(leadingTo(coordinates, worlds[skin.joints[i]] * skin.inverseBinds[i]));
    return joints;
}

glm::dmat4 blendedMatrix(const GltfPrimitive& primitive, std::size_t vertex, bool isSkinned,
                         std::span<const glm::dmat4> joints) {
    if (!isSkinned) return joints[0];
    glm::dmat4 sum(0);
    for (std::size_t i = vertex * primitive.influenceCount; i < (vertex + 1) * primitive.influenceCount; ++i)
        if (primitive.weights[i] != 0) sum += double(primitive.weights[i]) * joints[primitive.joints[i]];
    return sum;
}

dvec3 morphedPosition(const GltfPrimitive& primitive, std::size_t vertex, std::span<const double> weights) {
    const std::size_t count = primitive.positions.size();
    dvec3 p(primitive.positions[vertex]);
    for (std::size_t k = 0; k < weights.size(); ++k) p += weights[k] * dvec3(primitive.offsets[k * count + vertex]);
    return p;
}

} // namespace relief
