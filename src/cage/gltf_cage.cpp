#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "cage/gltf.h"

namespace relief {
namespace {

/// Numbers by their bits: the three of a position, or the number of a position with its texture coordinates or normal.
using Key = std::array<std::uint32_t, 4>;

struct KeyHash {
    std::size_t operator()(const Key& key) const {
        std::size_t hash = 0;
        for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9e3779b97f4a7c15u;
        return hash ^ (hash >> 32);
    }
};

std::uint32_t bitsOf(float number) { return std::bit_cast<std::uint32_t>(number); }

/// Replaces -0 by +0: equal coordinates then have equal bits.
vec3 withoutNegativeZeros(const vec3& p) { return p + vec3(0); }

/// The matrix that turns normals as `matrix` turns surfaces, up to a positive factor: never a division by zero.
glm::dmat3 normalMatrix(const glm::dmat4& matrix, double determinant) {
    const dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
    return (determinant < 0 ? -1.0 : 1.0) * glm::dmat3(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
}

vec3 unitOrUp(const dvec3& n) { return glm::dot(n, n) > 0 ? vec3(glm::normalize(n)) : vec3(0, 1, 0); }

class CageBuilder {
public:
    CageBuilder(const GltfScene& scene, bool takesTexCoords)
        : scene_(scene), takesTexCoords_(takesTexCoords), worlds_(worldMatrices(scene, restTransforms(scene))) {}

    /// Computes the box around the vertices that triangles use, in the coordinates of the cage.
    Bounds bounds();

    void addNode(std::uint32_t node) {
        enterNode(node);
        positions_.clear(), texCoords_.clear(), normals_.clear(); // vertices of different nodes are never merged
        for (const GltfPrimitive& primitive : scene_.meshes[std::size_t(scene_.nodes[node].mesh)].primitives)
            addPrimitive(primitive);
    }

    std::size_t degenerateCount = 0;
    double coarsestSpacing = 0; ///< of the floats of positions, in the world
    Cage cage;

private:
    struct Corner {
        std::uint32_t position = 0, texCoord = 0;
        std::optional<std::uint32_t> normal; ///< none: that of the triangle (section 3.7.2.1)
        bool isMirrored = false;
    };

    void enterNode(std::uint32_t node) {
        node_ = node;
        joints_ = jointMatrices(scene_, node, worlds_, cage.coordinates);
    }
    [[nodiscard]] dvec3 positionOf(const GltfPrimitive& primitive, std::size_t vertex, const glm::dmat4& matrix) const;
    void addPrimitive(const GltfPrimitive& primitive);
    std::vector<Corner> addVertices(const GltfPrimitive& primitive);
    Corner addVertex(const GltfPrimitive& primitive, std::size_t vertex, const glm::dmat4& matrix);
    void addTriangle(std::array<Corner, 3> corners);

    const GltfScene& scene_;
    bool takesTexCoords_;
    std::vector<glm::dmat4> worlds_, joints_;
    std::uint32_t node_ = 0;
    std::unordered_map<Key, std::uint32_t, KeyHash> positions_, texCoords_, normals_; ///< of this node
};

std::vector<bool> usedVertices(const GltfPrimitive& primitive) {
    std::vector<bool> isUsed(primitive.positions.size(), false);
    for (const std::uint32_t vertex : primitive.triangles) isUsed[vertex] = true;
    return isUsed;
}

dvec3 CageBuilder::positionOf(const GltfPrimitive& primitive, std::size_t vertex, const glm::dmat4& matrix) const {
    const dvec3 morphed = morphedPosition(primitive, vertex, scene_.nodes[node_].weights);
    return dvec3(matrix * glm::dvec4(morphed, 1));
}

Bounds CageBuilder::bounds() {
    Bounds bounds;
    for (const std::uint32_t node : scene_.meshNodes) {
        enterNode(node);
        const bool isSkinned = scene_.nodes[node].skin >= 0;
        for (const GltfPrimitive& primitive : scene_.meshes[std::size_t(scene_.nodes[node].mesh)].primitives) {
            const std::vector<bool> isUsed = usedVertices(primitive);
            dvec3 farthest(0); // in the space of the mesh
            for (std::size_t i = 0; i < isUsed.size(); ++i) {
                if (!isUsed[i]) continue;
                bounds.add(positionOf(primitive, i, blendedMatrix(primitive, i, isSkinned, joints_)));
                farthest = glm::max(farthest, glm::abs(dvec3(primitive.positions[i])));
            }
            const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(joints_[0]))));
            coarsestSpacing = std::max(coarsestSpacing, scale * floatSpacing(farthest));
        }
    }
    return bounds;
}

void CageBuilder::addPrimitive(const GltfPrimitive& primitive) {
    const std::size_t firstFace = cage.faceCount();
    const std::vector<Corner> vertices = addVertices(primitive);
    for (std::size_t i = 0; i + 2 < primitive.triangles.size(); i += 3) {
        const std::uint32_t* triangle = &primitive.triangles[i];
        addTriangle({vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]});
    }
    if (cage.faceCount() == firstFace) return;
    const GltfNode& node = scene_.nodes[node_];
    cage.parts.push_back({.name = node.name.empty() ? scene_.meshes[std::size_t(node.mesh)].name : node.name,
                          .material = primitive.material,
                          .firstFace = std::uint32_t(firstFace),
                          .faceCount = std::uint32_t(cage.faceCount() - firstFace)});
}

/// Adds the vertices that triangles use, in the order of the file; the others keep an empty Corner.
std::vector<CageBuilder::Corner> CageBuilder::addVertices(const GltfPrimitive& primitive) {
    const bool isSkinned = scene_.nodes[node_].skin >= 0;
    const std::vector<bool> isUsed = usedVertices(primitive);
    std::vector<Corner> corners(isUsed.size());
    for (std::size_t vertex = 0; vertex < isUsed.size(); ++vertex)
        if (isUsed[vertex])
            corners[vertex] = addVertex(primitive, vertex, blendedMatrix(primitive, vertex, isSkinned, joints_));
    return corners;
}

/// Vertices that differ only in what a seam or a hard edge splits become one position again.
CageBuilder::Corner CageBuilder::addVertex(const GltfPrimitive& primitive, std::size_t vertex,
                                           const glm::dmat4& matrix) {
    const double determinant = glm::determinant(glm::dmat3(matrix));
    const vec3 p = withoutNegativeZeros(vec3(positionOf(primitive, vertex, matrix)));
    const auto [position, isNewPosition] =
        positions_.try_emplace({bitsOf(p.x), bitsOf(p.y), bitsOf(p.z), 0}, std::uint32_t(cage.positions.size()));
    if (isNewPosition) cage.positions.push_back(p);
    Corner corner{.position = position->second, .isMirrored = determinant < 0};
    if (takesTexCoords_) {
        const vec2& st = primitive.texCoords[vertex];
        const auto [texCoord, isNewTexCoord] = texCoords_.try_emplace({corner.position, bitsOf(st.x), bitsOf(st.y), 0},
                                                                      std::uint32_t(cage.texCoords.size()));
        if (isNewTexCoord) cage.texCoords.push_back(st);
        corner.texCoord = texCoord->second;
    }
    if (!primitive.normals.empty()) {
        const vec3 n = unitOrUp(normalMatrix(matrix, determinant) * dvec3(primitive.normals[vertex]));
        const auto [normal, isNewNormal] = normals_.try_emplace(
            {corner.position, bitsOf(n.x), bitsOf(n.y), bitsOf(n.z)}, std::uint32_t(cage.normals.size()));
        if (isNewNormal) cage.normals.push_back(n);
        corner.normal = normal->second;
    }
    return corner;
}

void CageBuilder::addTriangle(std::array<Corner, 3> corners) {
    const auto& [a, b, c] = corners;
    if (a.position == b.position || b.position == c.position || c.position == a.position) {
        ++degenerateCount;
        return;
    }
    if (a.isMirrored) std::swap(corners[1], corners[2]); // mirrored, triangles run the other way (section 3.7.4)
    cage.faceSizes.push_back(3);
    for (const Corner& corner : corners) {
        cage.corners.push_back(corner.position);
        if (takesTexCoords_) cage.texCorners.push_back(corner.texCoord);
        if (corner.normal) cage.normalCorners.push_back(*corner.normal);
    }
    if (a.normal) return;
    const auto at = [&](std::size_t k) { return dvec3(cage.positions[corners[k].position]); };
    cage.normalCorners.insert(cage.normalCorners.end(), 3, std::uint32_t(cage.normals.size()));
    cage.normals.push_back(unitOrUp(glm::cross(at(1) - at(0), at(2) - at(0))));
}

/// How many of the scene's primitives with triangles have something.
template <typename Has>
std::size_t countPrimitives(const GltfScene& scene, const Has& has) {
    std::size_t count = 0;
    for (const std::uint32_t node : scene.meshNodes)
        for (const GltfPrimitive& primitive : scene.meshes[std::size_t(scene.nodes[node].mesh)].primitives)
            if (!primitive.triangles.empty() && has(primitive)) ++count;
    return count;
}

void warnOfCoarseFloats(double spacing, double size, const std::string& path, const Warn& warn) {
    constexpr double kCoarse = 1e-5; // of the size: from there on it can be seen
    if (size > 0 && spacing > kCoarse * size)
        warn(fmt::format("{}: its positions are 32-bit floats, {:.2g} units apart so far from the origin of the mesh, "
                         "and it is {:.2g} units large; move the mesh to its origin and its node away instead",
                         path, spacing, size));
}

} // namespace

Cage readGltfCage(const std::string& path, const Warn& warn, std::uint32_t uvSet) {
    const GltfScene scene = readGltf(path, {}, warn, uvSet);
    const std::size_t all = countPrimitives(scene, [](const GltfPrimitive&) { return true; });
    const std::size_t textured = countPrimitives(scene, [](const GltfPrimitive& p) { return !p.texCoords.empty(); });
    if (uvSet > 0 && textured == 0)
        fail(Failure::input, "{}: none of its meshes has the texture coordinates TEXCOORD_{}", path, uvSet);
    if (textured > 0 && textured < all)
        warn(fmt::format("{}: only some of its meshes have texture coordinates; they are ignored", path));

    CageBuilder builder(scene, all > 0 && textured == all);
    Cage& cage = builder.cage;
    const Bounds bounds = builder.bounds();
    cage.coordinates = coordinatesFor(bounds); // before floats can make one vertex of two
    warnOfCoarseFloats(builder.coarsestSpacing, bounds.diagonal(), path, warn);
    for (const std::uint32_t node : scene.meshNodes) builder.addNode(node);
    if (builder.degenerateCount > 0)
        warn(fmt::format("{}: {} triangles with two corners that coincide are skipped", path, builder.degenerateCount));
    const bool isOneNamelessPart =
        cage.parts.size() == 1 && cage.parts[0].name.empty() && cage.parts[0].material.empty();
    if (isOneNamelessPart) cage.parts.clear();
    validateCage(cage, path);
    return std::move(cage);
}

} // namespace relief
