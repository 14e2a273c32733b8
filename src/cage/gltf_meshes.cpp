#include <algorithm>
#include <numeric>

#include "cage/gltf_model.h"

namespace relief {
namespace {

using Attributes = std::map<std::string, int>;

int attributeOf(const Attributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

class PrimitiveReader {
public:
    PrimitiveReader(const GltfModel& model, const tinygltf::Primitive& from, std::string place,
                    GltfAccessors& accessors)
        : model_(model), from_(from), place_(std::move(place)), accessors_(accessors) {}

    GltfPrimitive read(const Warn& warn) {
        readVertices();
        readTriangles(warn);
        readTargets();
        readInfluences(warn);
        if (from_.material >= 0 && std::size_t(from_.material) < model_.materials.size())
            primitive_.material = model_.materials[std::size_t(from_.material)];
        return std::move(primitive_);
    }

private:
    void readVertices();
    void readTriangles(const Warn& warn);
    void readTargets();
    void readInfluences(const Warn& warn);
    void keepLargest(std::span<const std::uint32_t> joints, std::span<const float> weights);
    [[nodiscard]] std::string placeOf(const std::string& name) const { return place_ + "/" + name; }
    [[nodiscard]] std::size_t vertexCount() const { return primitive_.positions.size(); }

    const GltfModel& model_;
    const tinygltf::Primitive& from_;
    std::string place_;
    GltfAccessors& accessors_;
    GltfPrimitive primitive_;
    std::size_t weightlessCount_ = 0;
};

void PrimitiveReader::readVertices() {
    const int positions = attributeOf(from_.attributes, "POSITION");
    if (positions < 0) failAtElement(model_.path, place_, "has no POSITION; every mesh needs it");
    primitive_.positions = grouped<vec3>(accessors_.floats(
        positions, {.place = placeOf("POSITION"), .type = TINYGLTF_TYPE_VEC3, .takesQuantized = true, .count = {}}));
    if (const int normals = attributeOf(from_.attributes, "NORMAL"); normals >= 0)
        primitive_.normals = grouped<vec3>(accessors_.floats(
            normals,
            {.place = placeOf("NORMAL"), .type = TINYGLTF_TYPE_VEC3, .takesQuantized = true, .count = vertexCount()}));
    if (const int texCoords = attributeOf(from_.attributes, "TEXCOORD_0"); texCoords >= 0)
        primitive_.texCoords = grouped<vec2>(accessors_.floats(texCoords, {.place = placeOf("TEXCOORD_0"),
                                                                           .type = TINYGLTF_TYPE_VEC2,
                                                                           .takesNormalized = true,
                                                                           .takesQuantized = true,
                                                                           .count = vertexCount()}));
    for (vec2& st : primitive_.texCoords) st.y = 1 - st.y; // glTF's run down from the upper edge (section 3.9.2)
}

/// Lists, strips and fans (section 3.7.2.1).
void PrimitiveReader::readTriangles(const Warn& warn) {
    const int mode = from_.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        warn(fmt::format("{}: {}: points or lines; only triangles make a surface", model_.path, place_));
        return;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) failAtElement(model_.path, placeOf("mode"), "{}; it is 0 to 6", mode);
    std::vector<std::uint32_t> corners(vertexCount());
    std::iota(corners.begin(), corners.end(), 0u);
    if (from_.indices >= 0) corners = accessors_.integers(from_.indices, {.place = placeOf("indices"), .count = {}}, 4);
    for (const std::uint32_t corner : corners)
        if (corner >= vertexCount())
            failAtElement(model_.path, placeOf("indices"), "vertex {} does not exist; there are {} (from 0)", corner,
                          vertexCount());
    if (corners.size() < 3 || (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0))
        failAtElement(model_.path, placeOf("indices"), "{} corners do not make triangles", corners.size());
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        primitive_.triangles = std::move(corners);
        return;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const std::size_t odd = i % 2;
        const bool isFan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
        const std::size_t triangle[] = {i + (isFan ? 1 : 0), i + (isFan ? 2 : 1 + odd), isFan ? 0 : i + 2 - odd};
        for (const std::size_t corner : triangle) primitive_.triangles.push_back(corners[corner]);
    }
}

void PrimitiveReader::readTargets() {
    accessors_.checkRoom(3 * vertexCount() * from_.targets.size(), placeOf("targets"));
    for (std::size_t k = 0; k < from_.targets.size(); ++k) {
        const int offsets = attributeOf(from_.targets[k], "POSITION");
        if (offsets < 0) {
            primitive_.offsets.resize((k + 1) * vertexCount(), vec3(0));
            continue;
        }
        const std::vector<vec3> read =
            grouped<vec3>(accessors_.floats(offsets, {.place = placeOf(fmt::format("targets/{}/POSITION", k)),
                                                      .type = TINYGLTF_TYPE_VEC3,
                                                      .takesQuantized = true,
                                                      .count = vertexCount()}));
        primitive_.offsets.insert(primitive_.offsets.end(), read.begin(), read.end());
    }
}

/// Joints and weights come in sets of four (section 3.7.3.3).
void PrimitiveReader::readInfluences(const Warn& warn) {
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (;;) {
        const std::size_t set = joints.size();
        const std::string jointsName = fmt::format("JOINTS_{}", set), weightsName = fmt::format("WEIGHTS_{}", set);
        const int jointsOfSet = attributeOf(from_.attributes, jointsName);
        const int weightsOfSet = attributeOf(from_.attributes, weightsName);
        if (jointsOfSet < 0 && weightsOfSet < 0) break;
        if (jointsOfSet < 0 || weightsOfSet < 0)
            failAtElement(model_.path, place_, "only one of {} and {} is there", jointsName, weightsName);
        const GltfUse use{.place = placeOf(jointsName), .type = TINYGLTF_TYPE_VEC4, .count = vertexCount()};
        joints.push_back(accessors_.integers(jointsOfSet, use, 2));
        weights.push_back(accessors_.floats(weightsOfSet, {.place = placeOf(weightsName),
                                                           .type = TINYGLTF_TYPE_VEC4,
                                                           .takesNormalized = true,
                                                           .count = vertexCount()}));
    }
    if (joints.empty()) return;
    if (4 * joints.size() > kMostGltfInfluences)
        warn(fmt::format("{}: {}: up to {} joints move a vertex; the {} largest weights are kept", model_.path, place_,
                         4 * joints.size(), kMostGltfInfluences));

    primitive_.influenceCount = std::min(std::uint32_t(4 * joints.size()), kMostGltfInfluences);
    std::vector<std::uint32_t> jointsOfVertex(4 * joints.size());
    std::vector<float> weightsOfVertex(4 * joints.size());
    for (std::size_t vertex = 0; vertex < vertexCount(); ++vertex) {
        for (std::size_t i = 0; i < jointsOfVertex.size(); ++i) {
            jointsOfVertex[i] = joints[i / 4][4 * vertex + i % 4];
            weightsOfVertex[i] = weights[i / 4][4 * vertex + i % 4];
            if (weightsOfVertex[i] < 0)
                failAtElement(model_.path, placeOf(fmt::format("WEIGHTS_{}", i / 4)),
                              "vertex {} has weight {}; it must be 0 or more", vertex, weightsOfVertex[i]);
        }
        keepLargest(jointsOfVertex, weightsOfVertex);
    }
    if (weightlessCount_ > 0)
        warn(fmt::format("{}: {}: {} vertices have no weights; the first joint of each moves it", model_.path, place_,
                         weightlessCount_));
}

/// Adds the influences of one vertex, their weights made to add up to 1.
void PrimitiveReader::keepLargest(std::span<const std::uint32_t> joints, std::span<const float> weights) {
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const std::size_t kept = primitive_.influenceCount;
    if (order.size() > kept)
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
    order.resize(kept);
    double sum = 0;
    for (const std::size_t i : order) sum += weights[i];
    if (sum == 0) ++weightlessCount_;
    for (const std::size_t i : order) {
        const double weight = sum > 0 ? weights[i] / sum : i == 0 ? 1 : 0;
        primitive_.joints.push_back(weight > 0 ? joints[i] : 0); // what has no weight may name anything
        primitive_.weights.push_back(float(weight));
    }
}

} // namespace

GltfMesh readGltfMesh(const GltfModel& model, std::size_t index, GltfAccessors& accessors, const Warn& warn) {
    const tinygltf::Mesh& from = model.model.meshes[index];
    const std::string place = fmt::format("meshes/{}", index);
    if (from.primitives.empty()) failAtElement(model.path, place, "has no primitives");
    GltfMesh mesh{.name = from.name,
                  .primitives = {},
                  .targetCount = std::uint32_t(from.primitives[0].targets.size()),
                  .weights = from.weights};
    for (std::size_t i = 0; i < from.primitives.size(); ++i) {
        const std::string primitivePlace = fmt::format("{}/primitives/{}", place, i);
        if (from.primitives[i].targets.size() != mesh.targetCount)
            failAtElement(model.path, primitivePlace, "{} morph targets; the first primitive has {}",
                          from.primitives[i].targets.size(), mesh.targetCount);
        mesh.primitives.push_back(PrimitiveReader(model, from.primitives[i], primitivePlace, accessors).read(warn));
    }
    if (mesh.weights.empty()) mesh.weights.resize(mesh.targetCount, 0);
    if (mesh.weights.size() != mesh.targetCount)
        failAtElement(model.path, place, "{} weights for {} morph targets", mesh.weights.size(), mesh.targetCount);
    return mesh;
}

} // namespace relief
