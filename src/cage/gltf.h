// What relief takes from a glTF 2.0 file: triangles, skins, morph targets, the tree of nodes, its animations and the
// textures of its materials, as plain arrays that have been checked: indices exist, counts agree, numbers are finite,
// the tree has no cycle. Numbers of sections are the specification's.
#pragma once

#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "cage/cage.h"

namespace relief {

constexpr std::uint32_t kMostGltfInfluences = 8; ///< joints that are kept of a vertex: those with the largest weights

/// The triangles of one primitive, and the vertices that they use, each with its attributes.
struct GltfPrimitive {
    std::vector<vec3> positions;          ///< in the space of the mesh
    std::vector<vec3> normals;            ///< one per vertex, or empty
    std::vector<vec2> texCoords;          ///< TEXCOORD_n with t turned to run up; one per vertex, or empty
    std::vector<std::uint32_t> triangles; ///< three vertices each; empty where the primitive makes no surface
    std::vector<vec3> offsets;            ///< of morph targets, target after target: one per vertex
    std::uint32_t influenceCount = 0;     ///< joints per vertex; 0: the primitive has none
    std::vector<std::uint32_t> joints;    ///< influenceCount per vertex, into the joints of a skin
    std::vector<float> weights;           ///< per entry of `joints`; those of a vertex add up to 1
    std::uint32_t largestJoint = 0, largestJointVertex = 0; ///< the vertex that it moves, as the file numbers it
    std::string material;
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
    std::uint32_t targetCount = 0; ///< morph targets
    std::vector<double> weights;   ///< targetCount
};

struct GltfTransform {
    dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    dvec3 scale{1};
};

struct GltfNode {
    std::string name;
    int parent = -1, mesh = -1, skin = -1; ///< -1: none; only nodes with a mesh have a skin
    GltfTransform transform;
    std::optional<glm::dmat4> matrix; ///< instead of the transform
    std::vector<double> weights;      ///< of the mesh's morph targets
};

struct GltfSkin {
    std::vector<std::uint32_t> joints;    ///< nodes
    std::vector<glm::dmat4> inverseBinds; ///< one per joint
};

enum class GltfPath { translation, rotation, scale, weights };
enum class GltfInterpolation { linear, step, cubicSpline };

/// One property of a node over time.
struct GltfChannel {
    std::uint32_t node = 0;
    GltfPath path = GltfPath::translation;
    GltfInterpolation interpolation = GltfInterpolation::linear;
    std::uint32_t width = 0;   ///< numbers per value of the property
    std::vector<float> times;  ///< seconds, rising; at least one
    std::vector<float> values; ///< width per time; cubicSpline: 3 * width per time, in-tangent, value and out-tangent
};

struct GltfClip {
    std::string name;
    std::vector<GltfChannel> channels; ///< at most one per property of a node
};

struct GltfScene {
    std::vector<GltfNode> nodes;
    std::vector<std::uint32_t> order;     ///< the nodes in use, parents before their children
    std::vector<std::uint32_t> meshNodes; ///< those of the file's scene that have a mesh, at least one; rising
    std::vector<GltfMesh> meshes;
    std::vector<GltfSkin> skins;
    std::optional<GltfClip> clip; ///< the one that was asked for
};

/// A picture that a material names, as it is stored.
struct GltfTexture {
    std::string name;       ///< for messages: the file and its element, "FILE: images/0"
    std::string bytes;      ///< of a PNG or JPEG file; row 0 is at t = 1 of GltfPrimitive::texCoords
    bool isClamped = false; ///< beyond 0..1 along s and t; else it repeats
    double scale = 1;       ///< of a normal map: factor of x and y
};

/// The looks of primitives as far as relief draws them. Normal maps are of tangent space, with y up.
struct GltfMaterial {
    std::string name;
    dvec3 baseColorFactor{1}; ///< linear; multiplies the texture
    std::optional<GltfTexture> baseColor, normal;
};

/// Reads the materials of the triangles that the file's scene shows, each once, in the order of the file; those of
/// primitives without one are not in the list. They change no shape, so that nothing in them is a fault of the file:
/// `warn` gets what is wrong with a texture, and the material is without it. Textures by other coordinates than
/// TEXCOORD_n with n = `uvSet`, transformed ones and those that are neither PNG nor JPEG are not read. Neither is the
/// attribute TANGENT: tangents are those of the surface that is drawn. Throws as readGltf does for the file itself and
/// for its nodes.
std::vector<GltfMaterial> readGltfMaterials(const std::string& path, const Warn& warn, std::uint32_t uvSet = 0);

/// Reads a .gltf with the buffers beside it, or a .glb: by its first bytes, whatever its name. Of the animations it
/// reads `clip`, a name or a number ("": the first, if there is one), or none. What the file's scene does not need is
/// never looked at (images, materials, other animations, meshes that are not shown), so that nothing in it is a fault;
/// its nodes, meshes and skins stay empty. Of texture coordinates it reads TEXCOORD_n with n = `uvSet`.
/// Throws Failure::file when the file or a buffer cannot be read; Failure::input, naming the element, for anything that
/// is not glTF 2.0, a scene without a mesh, buffers outside the file's folder, and extensions without which the file
/// cannot be understood.
GltfScene readGltf(const std::string& path, const std::optional<std::string>& clip, const Warn& warn,
                   std::uint32_t uvSet = 0);

/// Returns the transforms of all nodes when no animation moves them, per node.
std::vector<GltfTransform> restTransforms(const GltfScene& scene);

/// Computes the matrix from each node to the world (section 3.5). `transforms`: one per node.
std::vector<glm::dmat4> worldMatrices(const GltfScene& scene, std::span<const GltfTransform> transforms);

/// Computes the matrices that move the vertices of a node's mesh into `coordinates`: one per joint of its skin, world *
/// inverse bind (3.7.3.2: the transform of the node itself is ignored then), or the node's own matrix where it has no
/// skin.
std::vector<glm::dmat4> jointMatrices(const GltfScene& scene, std::uint32_t node, std::span<const glm::dmat4> worlds,
                                      const Coordinates& coordinates = {});

/// Makes a matrix that leads to the world lead to `coordinates` instead. Call it before joints are blended: weights add
/// up to 1 only with the precision of floats, which is not enough far from the origin.
glm::dmat4 leadingTo(const Coordinates& coordinates, const glm::dmat4& matrix);

/// Blends the matrices of a vertex's joints by their weights. `joints`: from jointMatrices.
glm::dmat4 blendedMatrix(const GltfPrimitive& primitive, std::size_t vertex, bool isSkinned,
                         std::span<const glm::dmat4> joints);

/// Computes the position of a vertex with its morph targets applied, before its joints (3.7.2.2).
dvec3 morphedPosition(const GltfPrimitive& primitive, std::size_t vertex, std::span<const double> weights);

/// Returns the first line of a file's text in a form that messages may contain: not too long, no control characters.
std::string printable(std::string_view text);

/// Reads the triangles of the file's scene as a cage: see readCage. Texture coordinates are TEXCOORD_n with n =
/// `uvSet`; throws Failure::input where none of the triangles has that set, other than 0.
Cage readGltfCage(const std::string& path, const Warn& warn, std::uint32_t uvSet = 0);

} // namespace relief
