#include <algorithm>
#include <cmath>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostVertices = 1ull << 27; // and corners of all nodes together: many may show one mesh

/// Reads what the scene shows: its nodes, their meshes and skins, the joints of those and what stands above them.
class SceneReader {
public:
    SceneReader(const GltfDocument& document, const std::optional<std::string>& clip)
        : document_(document), root_(document.root()), accessors_(document), dracoMeshes_(document, accessors_),
          clip_(clip) {}

    GltfScene read(const Warn& warn);

private:
    void joinNodes();
    void useScene();
    void useNode(std::uint32_t node);
    void useJoints();
    void orderNodes();
    void readNode(std::uint32_t index, GltfNode& node);
    GltfTransform readTransform(const GltfElement& from) const;
    void readMeshOf(std::uint32_t node, const GltfElement& from);
    void readSkin(std::uint32_t skin, std::uint32_t node);
    void countVertices();
    void checkJoints(std::uint32_t node) const;
    [[nodiscard]] std::vector<double> numbers(const GltfElement& from, const char* name, std::size_t size) const;
    [[nodiscard]] glm::dmat4 affine(const double* numbers, const std::string& place) const;
    [[nodiscard]] GltfElement nodeAt(std::uint32_t node) const { return root_.at("nodes", node); }
    void checkNode(std::uint32_t node, const char* what, const std::string& place) const;

    const GltfDocument& document_;
    GltfElement root_;
    GltfAccessors accessors_;
    GltfDracoMeshes dracoMeshes_;
    GltfOddities oddities_;
    const std::optional<std::string>& clip_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<int> secondParents_;     ///< -1 where there is none, as there should be
    std::vector<bool> isUsed_, isShown_; ///< of nodes
    GltfScene scene_;
};

GltfScene SceneReader::read(const Warn& warn) {
    scene_.nodes.resize(root_.count("nodes"));
    scene_.meshes.resize(root_.count("meshes"));
    scene_.skins.resize(root_.count("skins"));
    joinNodes();
    useScene();
    useJoints();
    orderNodes();
    for (const std::uint32_t node : scene_.order) readNode(node, scene_.nodes[node]);
    if (scene_.meshNodes.empty()) fail(Failure::input, "{}: its scene has no mesh", document_.path);
    std::sort(scene_.meshNodes.begin(), scene_.meshNodes.end());
    countVertices();
    for (const std::uint32_t node : scene_.meshNodes) checkJoints(node);
    if (clip_) scene_.clip = readGltfClip(document_, *clip_, scene_, accessors_, oddities_);
    oddities_.report(document_.path, warn);
    return std::move(scene_);
}

std::vector<double> SceneReader::numbers(const GltfElement& from, const char* name, std::size_t size) const {
    std::vector<double> numbers = from.numbers(name);
    if (!numbers.empty() && numbers.size() != size)
        from.fail("{} of {} numbers; it has {}", name, numbers.size(), size);
    return numbers;
}

void SceneReader::checkNode(std::uint32_t node, const char* what, const std::string& place) const {
    if (node >= scene_.nodes.size())
        failAtElement(document_.path, place, "{} {} does not exist; there are {} (from 0)", what, node,
                      scene_.nodes.size());
}

/// Makes a matrix of 16 numbers, column by column. The last row may differ from 0 0 0 1 by rounding.
glm::dmat4 SceneReader::affine(const double* numbers, const std::string& place) const {
    constexpr double kRounding = 1e-3;
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix[column][row] = numbers[4 * column + row];
    for (int column = 0; column < 4; ++column) {
        const double expected = column == 3 ? 1 : 0;
        if (std::abs(matrix[column][3] - expected) > kRounding)
            failAtElement(document_.path, place, "the last row of the matrix is not 0 0 0 1");
        matrix[column][3] = expected;
    }
    return matrix;
}

// --- which nodes are needed --------------------------------------------------------------------------------------

/// Finds children and parents of all nodes. Lists that are faulty are skipped here and refused where nodes are used.
void SceneReader::joinNodes() {
    children_.resize(scene_.nodes.size());
    secondParents_.resize(scene_.nodes.size(), -1);
    const auto& all = document_.json;
    for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i) {
        const auto& node = all["nodes"][i];
        if (!node.is_object() || !node.contains("children") || !node["children"].is_array()) continue;
        for (const auto& child : node["children"]) {
            const bool isNode = child.is_number_unsigned() && child.get<std::uint64_t>() < scene_.nodes.size();
            if (!isNode) continue;
            children_[i].push_back(child.get<std::uint32_t>());
            const std::uint32_t number = children_[i].back();
            int& parent = scene_.nodes[number].parent;
            (parent < 0 ? parent : secondParents_[number]) = int(i);
        }
    }
}

/// Marks the nodes of the scene that is to be shown; all nodes where the file has no scene.
void SceneReader::useScene() {
    isUsed_.resize(scene_.nodes.size(), false);
    std::vector<std::uint32_t> shown;
    const std::size_t sceneCount = root_.count("scenes");
    if (sceneCount == 0) {
        // Without scenes all nodes are shown; else the roots that the scene lists.
        for (std::uint32_t node = 0; node < scene_.nodes.size(); ++node) shown.push_back(node);
    } else {
        const std::uint32_t number = root_.integer("scene").value_or(0);
        const GltfElement scene = document_.entry("scenes", "scene", number, "scene");
        shown = scene.integers("nodes");
        for (const std::uint32_t node : shown) checkNode(node, "node", scene.place());
    }
    // The nodes below those, which must form a tree.
    isShown_.resize(scene_.nodes.size(), false);
    while (!shown.empty()) {
        const std::uint32_t node = shown.back();
        shown.pop_back();
        if (isShown_[node]) continue;
        isShown_[node] = true;
        for (const std::uint32_t child : nodeAt(node).integers("children")) {
            checkNode(child, "child", nodeAt(node).place());
            if (secondParents_[child] >= 0)
                nodeAt(child).fail("is a child of nodes {} and {}", scene_.nodes[child].parent, secondParents_[child]);
            shown.push_back(child);
        }
    }
    for (std::uint32_t node = 0; node < scene_.nodes.size(); ++node)
        if (isShown_[node]) useNode(node);
}

/// Marks a node and all its ancestors as used.
void SceneReader::useNode(std::uint32_t node) {
    for (int i = int(node); i >= 0 && !isUsed_[std::size_t(i)]; i = scene_.nodes[std::size_t(i)].parent)
        isUsed_[std::size_t(i)] = true;
}

/// Marks the joints of the skins of shown meshes, which may be nodes of another part of the file.
void SceneReader::useJoints() {
    std::vector<bool> isRead(scene_.skins.size(), false);
    for (std::uint32_t node = 0; node < scene_.nodes.size(); ++node) {
        const std::optional<std::uint32_t> skin =
            isShown_[node] && nodeAt(node).has("mesh") ? nodeAt(node).integer("skin") : std::nullopt;
        if (!skin) continue;
        const GltfElement from = document_.entry("skins", "skin", *skin, nodeAt(node).place());
        if (isRead[*skin]) continue;
        isRead[*skin] = true;
        for (const std::uint32_t joint : from.need("joints").integers("joints")) {
            checkNode(joint, "node", from.place() + "/joints");
            useNode(joint);
        }
    }
}

/// Orders nodes so that parents come first. As each has one parent, only nodes of a cycle are never reached.
void SceneReader::orderNodes() {
    std::vector<std::uint32_t>& order = scene_.order;
    for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i)
        if (isUsed_[i] && scene_.nodes[i].parent < 0) order.push_back(i);
    std::vector<bool> isReached(scene_.nodes.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        isReached[order[i]] = true;
        for (const std::uint32_t child : children_[order[i]])
            if (isUsed_[child] && scene_.nodes[child].parent == int(order[i]) && !isReached[child])
                order.push_back(child);
    }
    for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i)
        if (isUsed_[i] && !isReached[i]) nodeAt(i).fail("is below itself");
}

// --- one node ----------------------------------------------------------------------------------------------------

void SceneReader::readNode(std::uint32_t index, GltfNode& node) {
    const GltfElement from = nodeAt(index);
    node.name = from.name();
    const std::vector<double> matrix = numbers(from, "matrix", 16);
    if (matrix.empty())
        node.transform = readTransform(from);
    else
        node.matrix = affine(matrix.data(), from.place());
    if (isShown_[index] && from.has("mesh")) readMeshOf(index, from);
}

GltfTransform SceneReader::readTransform(const GltfElement& from) const {
    const std::vector<double> t = numbers(from, "translation", 3), r = numbers(from, "rotation", 4),
                              s = numbers(from, "scale", 3);
    GltfTransform transform;
    if (!t.empty()) transform.translation = {t[0], t[1], t[2]};
    if (!s.empty()) transform.scale = {s[0], s[1], s[2]};
    if (r.empty()) return transform;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    if (!(glm::length(rotation) > 0) || !std::isfinite(glm::length(rotation)))
        from.fail("its rotation is no unit quaternion");
    transform.rotation = glm::normalize(rotation);
    return transform;
}

/// The mesh and the skin of a shown node, which are read when they are used first.
void SceneReader::readMeshOf(std::uint32_t index, const GltfElement& from) {
    GltfNode& node = scene_.nodes[index];
    const std::uint32_t number = *from.integer("mesh");
    const GltfElement meshFrom = document_.entry("meshes", "mesh", number, from.place());
    GltfMesh& mesh = scene_.meshes[number];
    GltfMeshReading reading{document_, accessors_, dracoMeshes_, oddities_};
    if (mesh.primitives.empty()) mesh = readGltfMesh(meshFrom, reading);
    node.mesh = int(number);
    node.weights = numbers(from, "weights", mesh.targetCount);
    if (node.weights.empty()) node.weights = mesh.weights;
    scene_.meshNodes.push_back(index);
    if (const std::optional<std::uint32_t> skin = from.integer("skin")) readSkin(*skin, index);
}

void SceneReader::readSkin(std::uint32_t number, std::uint32_t node) {
    scene_.nodes[node].skin = int(number);
    GltfSkin& skin = scene_.skins[number];
    if (!skin.joints.empty()) return;
    const GltfElement from = root_.at("skins", number);
    skin.joints = from.integers("joints");
    if (skin.joints.empty()) from.fail("has no joints");
    skin.inverseBinds.resize(skin.joints.size(), glm::dmat4(1));
    const std::optional<std::uint32_t> accessor = from.integer("inverseBindMatrices");
    if (!accessor) return;
    const std::string place = from.place() + "/inverseBindMatrices";
    const std::vector<float> read =
        accessors_.floats(*accessor, {.place = place, .type = TINYGLTF_TYPE_MAT4, .count = {}});
    if (read.size() / 16 < skin.joints.size())
        failAtElement(document_.path, place, "{} matrices for {} joints", read.size() / 16, skin.joints.size());
    const std::vector<double> matrices(read.begin(), read.end());
    for (std::size_t joint = 0; joint < skin.joints.size(); ++joint)
        skin.inverseBinds[joint] = affine(&matrices[16 * joint], place);
}

// --- all together ------------------------------------------------------------------------------------------------

void SceneReader::countVertices() {
    std::uint64_t count = 0;
    for (const std::uint32_t node : scene_.meshNodes) {
        for (const GltfPrimitive& primitive : scene_.meshes[std::size_t(scene_.nodes[node].mesh)].primitives)
            count += primitive.positions.size() + primitive.triangles.size();
        if (count > kMostVertices)
            fail(Failure::input, "{}: the nodes show more than {} vertices and corners, the most that is read",
                 document_.path, kMostVertices);
    }
    if (count == 0)
        fail(Failure::input, "{}: its scene has no triangles; a primitive of triangles with POSITION is needed",
             document_.path);
}

void SceneReader::checkJoints(std::uint32_t index) const {
    const GltfNode& node = scene_.nodes[index];
    if (node.skin < 0) return;
    const std::size_t jointCount = scene_.skins[std::size_t(node.skin)].joints.size();
    const std::vector<GltfPrimitive>& primitives = scene_.meshes[std::size_t(node.mesh)].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (primitives[i].triangles.empty()) continue;
        const std::string place = fmt::format("meshes/{}/primitives/{}", node.mesh, i);
        if (primitives[i].influenceCount == 0)
            failAtElement(document_.path, place, "has no JOINTS_0 and WEIGHTS_0 for the skin of node {}", index);
        if (primitives[i].largestJoint >= jointCount)
            failAtElement(document_.path, place, "vertex {} names joint {}; skin {} has {} (from 0)",
                          primitives[i].largestJointVertex, primitives[i].largestJoint, node.skin, jointCount);
    }
}

} // namespace

GltfScene readGltf(const std::string& path, const std::optional<std::string>& clip, const Warn& warn,
                   std::uint32_t uvSet) {
    GltfDocument document = loadGltfDocument(path, warn);
    document.uvSet = uvSet;
    return SceneReader(document, clip).read(warn);
}

} // namespace relief
