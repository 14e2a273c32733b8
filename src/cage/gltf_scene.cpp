#include <algorithm>
#include <cmath>

#include "cage/gltf_model.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostVertices = 1ull << 27; // and corners of all nodes together: many may show one mesh

class SceneReader {
public:
    SceneReader(const GltfModel& model, const Warn& warn) : model_(model), accessors_(model), warn_(warn) {}

    GltfScene read() {
        for (std::size_t i = 0; i < model_.model.meshes.size(); ++i)
            scene_.meshes.push_back(readGltfMesh(model_, i, accessors_, warn_));
        readNodes();
        readSkins();
        findMeshNodes();
        for (const std::uint32_t node : scene_.meshNodes) checkSkin(node);
        scene_.clips = readGltfClips(model_, scene_, accessors_, warn_);
        return std::move(scene_);
    }

private:
    void readNodes();
    GltfNode readNode(const tinygltf::Node& from, const std::string& place) const;
    GltfTransform readTransform(const tinygltf::Node& from, const std::string& place) const;
    void joinNodes();
    void orderNodes();
    void readSkins();
    void findMeshNodes();
    void checkSkin(std::uint32_t node) const;
    void checkIndex(int index, std::size_t count, const char* what, const std::string& place) const;
    void checkSize(const std::vector<double>& numbers, std::size_t size, const char* what,
                   const std::string& place) const;
    [[nodiscard]] glm::dmat4 affine(const double* numbers, const std::string& place) const;

    const GltfModel& model_;
    GltfAccessors accessors_;
    const Warn& warn_;
    GltfScene scene_;
};

void SceneReader::checkIndex(int index, std::size_t count, const char* what, const std::string& place) const {
    if (index < 0 || std::size_t(index) >= count)
        failAtElement(model_.path, place, "{} {} does not exist; there are {} (from 0)", what, index, count);
}

void SceneReader::checkSize(const std::vector<double>& numbers, std::size_t size, const char* what,
                            const std::string& place) const {
    if (!numbers.empty() && numbers.size() != size)
        failAtElement(model_.path, place, "{} of {} numbers; it has {}", what, numbers.size(), size);
}

/// Column after column. The last row may be off by what rounding does.
glm::dmat4 SceneReader::affine(const double* numbers, const std::string& place) const {
    constexpr double kRounding = 1e-3;
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix[column][row] = numbers[4 * column + row];
    for (int column = 0; column < 4; ++column) {
        const double expected = column == 3 ? 1 : 0;
        if (std::abs(matrix[column][3] - expected) > kRounding)
            failAtElement(model_.path, place, "the last row of the matrix is not 0 0 0 1");
        matrix[column][3] = expected;
    }
    return matrix;
}

void SceneReader::readNodes() {
    for (std::size_t i = 0; i < model_.model.nodes.size(); ++i)
        scene_.nodes.push_back(readNode(model_.model.nodes[i], fmt::format("nodes/{}", i)));
    joinNodes();
    orderNodes();
}

GltfNode SceneReader::readNode(const tinygltf::Node& from, const std::string& place) const {
    GltfNode node{.name = from.name};
    checkSize(from.matrix, 16, "matrix", place);
    if (from.matrix.empty())
        node.transform = readTransform(from, place);
    else
        node.matrix = affine(from.matrix.data(), place);
    if (from.mesh < 0) return node;
    checkIndex(from.mesh, scene_.meshes.size(), "mesh", place);
    node.mesh = from.mesh;
    if (from.skin >= 0) checkIndex(from.skin, model_.model.skins.size(), "skin", place);
    node.skin = from.skin;
    const GltfMesh& mesh = scene_.meshes[std::size_t(from.mesh)];
    checkSize(from.weights, mesh.targetCount, "weights", place);
    node.weights = from.weights.empty() ? mesh.weights : from.weights;
    return node;
}

GltfTransform SceneReader::readTransform(const tinygltf::Node& from, const std::string& place) const {
    checkSize(from.translation, 3, "translation", place);
    checkSize(from.rotation, 4, "rotation", place);
    checkSize(from.scale, 3, "scale", place);
    GltfTransform transform;
    const std::vector<double>&t = from.translation, &r = from.rotation, &s = from.scale;
    if (!t.empty()) transform.translation = {t[0], t[1], t[2]};
    if (!s.empty()) transform.scale = {s[0], s[1], s[2]};
    if (r.empty()) return transform;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    if (!(glm::length(rotation) > 0) || !std::isfinite(glm::length(rotation)))
        failAtElement(model_.path, place, "its rotation is no unit quaternion");
    transform.rotation = glm::normalize(rotation);
    return transform;
}

void SceneReader::joinNodes() {
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
        for (const int child : model_.model.nodes[i].children) {
            checkIndex(child, scene_.nodes.size(), "child", fmt::format("nodes/{}", i));
            int& parent = scene_.nodes[std::size_t(child)].parent;
            if (parent >= 0)
                failAtElement(model_.path, fmt::format("nodes/{}", child), "is a child of nodes {} and {}", parent, i);
            parent = int(i);
        }
}

/// Parents first. With one parent each, only nodes of a cycle are never reached.
void SceneReader::orderNodes() {
    std::vector<std::uint32_t>& order = scene_.order;
    for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i)
        if (scene_.nodes[i].parent < 0) order.push_back(i);
    std::vector<bool> isReached(scene_.nodes.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        isReached[order[i]] = true;
        for (const int child : model_.model.nodes[order[i]].children) order.push_back(std::uint32_t(child));
    }
    const auto lost = std::find(isReached.begin(), isReached.end(), false);
    if (lost != isReached.end())
        failAtElement(model_.path, fmt::format("nodes/{}", lost - isReached.begin()), "is below itself");
}

void SceneReader::readSkins() {
    for (std::size_t i = 0; i < model_.model.skins.size(); ++i) {
        const tinygltf::Skin& from = model_.model.skins[i];
        const std::string place = fmt::format("skins/{}", i);
        if (from.joints.empty()) failAtElement(model_.path, place, "has no joints");
        GltfSkin skin{.joints = {}, .inverseBinds = std::vector<glm::dmat4>(from.joints.size(), glm::dmat4(1))};
        for (const int joint : from.joints) {
            checkIndex(joint, scene_.nodes.size(), "node", place + "/joints");
            skin.joints.push_back(std::uint32_t(joint));
        }
        if (from.inverseBindMatrices >= 0) {
            const std::string matrices = place + "/inverseBindMatrices";
            const std::vector<float> read = accessors_.floats(
                from.inverseBindMatrices, {.place = matrices, .type = TINYGLTF_TYPE_MAT4, .count = {}});
            if (read.size() / 16 < from.joints.size())
                failAtElement(model_.path, matrices, "{} matrices for {} joints", read.size() / 16, from.joints.size());
            const std::vector<double> numbers(read.begin(), read.end());
            for (std::size_t joint = 0; joint < from.joints.size(); ++joint)
                skin.inverseBinds[joint] = affine(&numbers[16 * joint], matrices);
        }
        scene_.skins.push_back(std::move(skin));
    }
}

/// Of the scene that is to be shown; of all nodes where the file has no scene.
void SceneReader::findMeshNodes() {
    const tinygltf::Model& model = model_.model;
    std::vector<bool> isInScene(scene_.nodes.size(), model.scenes.empty());
    if (!model.scenes.empty()) {
        const int shown = std::max(model.defaultScene, 0);
        checkIndex(shown, model.scenes.size(), "scene", "scene");
        for (const int root : model.scenes[std::size_t(shown)].nodes) {
            checkIndex(root, scene_.nodes.size(), "node", fmt::format("scenes/{}", shown));
            isInScene[std::size_t(root)] = true;
        }
    }
    std::uint64_t vertexCount = 0;
    for (const std::uint32_t i : scene_.order) {
        const GltfNode& node = scene_.nodes[i];
        if (node.parent >= 0 && isInScene[std::size_t(node.parent)]) isInScene[i] = true;
        if (!isInScene[i] || node.mesh < 0) continue;
        scene_.meshNodes.push_back(i);
        for (const GltfPrimitive& primitive : scene_.meshes[std::size_t(node.mesh)].primitives)
            vertexCount += primitive.positions.size() + primitive.triangles.size();
        if (vertexCount > kMostVertices)
            fail(Failure::input, "{}: the nodes show more than {} vertices and corners, the most that is read",
                 model_.path, kMostVertices);
    }
    if (scene_.meshNodes.empty()) fail(Failure::input, "{}: its scene has no mesh", model_.path);
    std::sort(scene_.meshNodes.begin(), scene_.meshNodes.end());
}

void SceneReader::checkSkin(std::uint32_t index) const {
    const GltfNode& node = scene_.nodes[index];
    if (node.skin < 0) return;
    const std::size_t jointCount = scene_.skins[std::size_t(node.skin)].joints.size();
    const std::vector<GltfPrimitive>& primitives = scene_.meshes[std::size_t(node.mesh)].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const std::string place = fmt::format("meshes/{}/primitives/{}", node.mesh, i);
        if (primitives[i].influenceCount == 0)
            failAtElement(model_.path, place, "has no JOINTS_0 and WEIGHTS_0 for the skin of node {}", index);
        const auto largest = std::max_element(primitives[i].joints.begin(), primitives[i].joints.end());
        if (*largest >= jointCount)
            failAtElement(model_.path, place, "vertex {} names joint {}; skin {} has {} (from 0)",
                          (largest - primitives[i].joints.begin()) / primitives[i].influenceCount, *largest, node.skin,
                          jointCount);
    }
}

} // namespace

GltfScene readGltf(const std::string& path, const Warn& warn) {
    const GltfModel model = loadGltfModel(path);
    return SceneReader(model, warn).read();
}

} // namespace relief
