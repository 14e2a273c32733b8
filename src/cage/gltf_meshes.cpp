#include <algorithm>
#include <numeric>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

/// The attributes of a primitive; an empty object where it has none.
GltfElement attributesOf(const GltfElement& primitive) {
    static const nlohmann::json kNone = nlohmann::json::object();
    if (const std::optional<GltfElement> attributes = primitive.object("attributes")) return *attributes;
    return {kNone, primitive.path(), primitive.place() + "/attributes"};
}

class PrimitiveReader {
public:
    PrimitiveReader(const GltfElement& from, GltfMeshReading& reading)
        : from_(from), attributes_(attributesOf(from)), reading_(reading), accessors_(reading.accessors) {}

    /// Returns a primitive without vertices and triangles where it makes no surface.
    GltfPrimitive read(std::uint32_t targetCount);

private:
    [[nodiscard]] bool isSurface() const;
    void decode();
    std::vector<std::uint32_t> readCorners();
    void takeTriangles(std::vector<std::uint32_t> corners);
    void renumber();
    void readVertices();
    void readTargets();
    void readInfluences();
    void keepLargest(std::span<const std::uint32_t> joints, std::span<const float> weights, std::uint32_t vertex);
    void readMaterial();
    [[nodiscard]] GltfUse use(const std::string& name, int type) const;
    /// Reads an attribute of the vertices in use; empty where the primitive does not have it.
    std::vector<float> attribute(const std::string& name, GltfUse use);
    [[nodiscard]] std::string placeOf(const std::string& name) const { return from_.place() + "/" + name; }

    const GltfElement& from_;
    GltfElement attributes_;
    GltfMeshReading& reading_;
    GltfAccessors& accessors_;
    std::optional<GltfElement> extension_; ///< Draco's
    const draco::Mesh* compressed_ = nullptr;
    std::size_t vertexCount_ = 0;         ///< of the file
    std::vector<std::uint32_t> vertices_; ///< those that triangles use, as the file numbers them; rising
    std::size_t weightlessCount_ = 0;
    GltfPrimitive primitive_;
};

GltfPrimitive PrimitiveReader::read(std::uint32_t targetCount) {
    if (!isSurface()) return {};
    if (from_.count("targets") != targetCount)
        from_.fail("{} morph targets; the first primitive has {}", from_.count("targets"), targetCount);
    vertexCount_ = accessors_.count(*attributes_.integer("POSITION"), placeOf("POSITION"));
    decode();
    takeTriangles(readCorners());
    renumber();
    readVertices();
    readTargets();
    readInfluences();
    readMaterial();
    return std::move(primitive_);
}

bool PrimitiveReader::isSurface() const {
    const std::uint32_t mode = from_.integer("mode").value_or(TINYGLTF_MODE_TRIANGLES);
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) failAtElement(from_.path(), placeOf("mode"), "{}; it is 0 to 6", mode);
    if (mode < TINYGLTF_MODE_TRIANGLES)
        reading_.oddities.add("primitives of points or lines are ignored, only triangles make a surface",
                              from_.place());
    else if (!attributes_.has("POSITION"))
        reading_.oddities.add("primitives without POSITION are skipped", from_.place());
    else
        return true;
    return false;
}

void PrimitiveReader::decode() {
    extension_ = from_.extension("KHR_draco_mesh_compression");
    if (!extension_) return;
    const std::uint32_t indices = *from_.need("indices").integer("indices");
    compressed_ =
        &reading_.dracoMeshes.decode(*extension_, vertexCount_, accessors_.count(indices, placeOf("indices")) / 3);
}

/// Reads the corners of the triangles, as the file numbers vertices; without indices these are 0, 1, 2, ...
std::vector<std::uint32_t> PrimitiveReader::readCorners() {
    const std::optional<std::uint32_t> indices = from_.integer("indices");
    if (compressed_ != nullptr) return dracoCorners(*compressed_);
    if (indices) return accessors_.integers(*indices, {.place = placeOf("indices"), .count = {}}, 4);
    accessors_.checkRoom(4 * vertexCount_, from_.place()); // a corner and a position each
    accessors_.takeRoom(vertexCount_, from_.place());
    std::vector<std::uint32_t> corners(vertexCount_);
    std::iota(corners.begin(), corners.end(), 0u);
    return corners;
}

/// Makes separate triangles of lists, strips and fans (section 3.7.2.1).
void PrimitiveReader::takeTriangles(std::vector<std::uint32_t> corners) {
    for (const std::uint32_t corner : corners)
        if (corner >= vertexCount_)
            failAtElement(from_.path(), placeOf("indices"), "vertex {} does not exist; there are {} (from 0)", corner,
                          vertexCount_);
    // Draco decodes strips to lists.
    const std::uint32_t mode =
        compressed_ != nullptr ? TINYGLTF_MODE_TRIANGLES : from_.integer("mode").value_or(TINYGLTF_MODE_TRIANGLES);
    if (corners.size() < 3 || (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0))
        failAtElement(from_.path(), placeOf("indices"), "{} corners do not make triangles", corners.size());
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

/// Many primitives may share vertices of which each uses a few: it takes those alone. A table of all of the file's
/// vertices is made only where it is not much longer than the triangles.
void PrimitiveReader::renumber() {
    constexpr std::size_t kSparse = 16;
    std::vector<std::uint32_t>& triangles = primitive_.triangles;
    if (vertexCount_ > kSparse * triangles.size()) {
        vertices_ = triangles;
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        for (std::uint32_t& corner : triangles)
            corner = std::uint32_t(std::lower_bound(vertices_.begin(), vertices_.end(), corner) - vertices_.begin());
        return;
    }
    std::vector<std::uint32_t> numbers(vertexCount_, 0);
    for (const std::uint32_t corner : triangles) numbers[corner] = 1;
    for (std::uint32_t vertex = 0; vertex < vertexCount_; ++vertex) {
        if (numbers[vertex] == 0) continue;
        numbers[vertex] = std::uint32_t(vertices_.size());
        vertices_.push_back(vertex);
    }
    for (std::uint32_t& corner : triangles) corner = numbers[corner];
}

GltfUse PrimitiveReader::use(const std::string& name, int type) const {
    return {.place = placeOf(name), .type = type, .count = vertexCount_};
}

std::vector<float> PrimitiveReader::attribute(const std::string& name, GltfUse use) {
    const std::optional<std::uint32_t> accessor = attributes_.integer(name);
    if (!accessor) return {};
    if (compressed_ != nullptr) use.decoded = dracoAttribute(*compressed_, *extension_, name);
    return accessors_.floats(*accessor, use, vertices_);
}

void PrimitiveReader::readVertices() {
    const std::string texCoordName = fmt::format("TEXCOORD_{}", reading_.document.uvSet);
    GltfUse positions = use("POSITION", TINYGLTF_TYPE_VEC3), normals = use("NORMAL", TINYGLTF_TYPE_VEC3),
            texCoords = use(texCoordName, TINYGLTF_TYPE_VEC2);
    positions.takesQuantized = normals.takesQuantized = texCoords.takesQuantized = true;
    positions.count.reset(); // it says how many the others have
    texCoords.takesNormalized = true;
    primitive_.positions = grouped<vec3>(attribute("POSITION", positions));
    primitive_.normals = grouped<vec3>(attribute("NORMAL", normals));
    primitive_.texCoords = grouped<vec2>(attribute(texCoordName, texCoords));
    for (vec2& st : primitive_.texCoords) st.y = 1 - st.y; // glTF's run down from the upper edge (section 3.9.2)
}

/// Targets are never compressed.
void PrimitiveReader::readTargets() {
    const std::size_t count = primitive_.positions.size();
    accessors_.checkRoom(3 * count * from_.count("targets"), placeOf("targets"));
    for (std::size_t k = 0; k < from_.count("targets"); ++k) {
        GltfUse offsets = use(fmt::format("targets/{}/POSITION", k), TINYGLTF_TYPE_VEC3);
        offsets.takesQuantized = true;
        const std::optional<std::uint32_t> accessor = from_.at("targets", k).integer("POSITION");
        if (!accessor) {
            accessors_.takeRoom(3 * count, offsets.place);
            primitive_.offsets.resize((k + 1) * count, vec3(0));
            continue;
        }
        const std::vector<vec3> read = grouped<vec3>(accessors_.floats(*accessor, offsets, vertices_));
        primitive_.offsets.insert(primitive_.offsets.end(), read.begin(), read.end());
    }
}

/// Reads joints and weights, which come in sets of four (section 3.7.3.3).
void PrimitiveReader::readInfluences() {
    // All sets of the file, each with its own accessor.
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (;;) {
        const std::size_t set = joints.size();
        const std::string jointsName = fmt::format("JOINTS_{}", set), weightsName = fmt::format("WEIGHTS_{}", set);
        const std::optional<std::uint32_t> jointsOfSet = attributes_.integer(jointsName);
        if (!jointsOfSet && !attributes_.has(weightsName)) break;
        if (!jointsOfSet || !attributes_.has(weightsName))
            from_.fail("only one of {} and {} is there", jointsName, weightsName);
        GltfUse jointsUse = use(jointsName, TINYGLTF_TYPE_VEC4), weightsUse = use(weightsName, TINYGLTF_TYPE_VEC4);
        if (compressed_ != nullptr) jointsUse.decoded = dracoAttribute(*compressed_, *extension_, jointsName);
        weightsUse.takesNormalized = true;
        joints.push_back(accessors_.integers(*jointsOfSet, jointsUse, 2, vertices_));
        weights.push_back(attribute(weightsName, weightsUse));
    }
    if (joints.empty()) return;
    if (4 * joints.size() > kMostGltfInfluences)
        reading_.oddities.add("of more than 8 joints at a vertex the 8 largest weights are kept, in primitives",
                              from_.place());

    // Each vertex keeps the influences with the largest weights.
    primitive_.influenceCount = std::min(std::uint32_t(4 * joints.size()), kMostGltfInfluences);
    std::vector<std::uint32_t> jointsOfVertex(4 * joints.size());
    std::vector<float> weightsOfVertex(4 * joints.size());
    for (std::size_t vertex = 0; vertex < vertices_.size(); ++vertex) {
        for (std::size_t i = 0; i < jointsOfVertex.size(); ++i) {
            jointsOfVertex[i] = joints[i / 4][4 * vertex + i % 4];
            weightsOfVertex[i] = weights[i / 4][4 * vertex + i % 4];
            if (weightsOfVertex[i] < 0)
                failAtElement(from_.path(), placeOf(fmt::format("WEIGHTS_{}", i / 4)),
                              "vertex {} has weight {}; it must be 0 or more", vertices_[vertex], weightsOfVertex[i]);
        }
        keepLargest(jointsOfVertex, weightsOfVertex, vertices_[vertex]);
    }
    reading_.oddities.add("vertices without weights are moved by their first joint", from_.place(), weightlessCount_);
}

/// Adds the influences of one vertex, their weights made to add up to 1.
void PrimitiveReader::keepLargest(std::span<const std::uint32_t> joints, std::span<const float> weights,
                                  std::uint32_t vertex) {
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
        const std::uint32_t joint = weight > 0 ? joints[i] : 0; // what has no weight may name anything
        primitive_.joints.push_back(joint);
        primitive_.weights.push_back(float(weight));
        if (joint > primitive_.largestJoint) primitive_.largestJoint = joint, primitive_.largestJointVertex = vertex;
    }
}

/// Reads the name of the material, all that is used of it: nothing else about materials can be a fault.
void PrimitiveReader::readMaterial() {
    const auto materials = reading_.document.json.find("materials");
    if (!from_.has("material") || materials == reading_.document.json.end() || !materials->is_array()) return;
    const std::uint32_t index = *from_.integer("material");
    if (index < materials->size() && (*materials)[index].is_object())
        primitive_.material = reading_.document.root().at("materials", index).name();
}

} // namespace

void GltfOddities::add(const char* what, const std::string& place, std::size_t count) {
    if (count == 0) return;
    Oddity& oddity = oddities_[what];
    if (oddity.count == 0) oddity.firstPlace = place;
    oddity.count += count;
}

void GltfOddities::report(const std::string& path, const Warn& warn) const {
    for (const auto& [what, oddity] : oddities_)
        warn(fmt::format("{}: {}: {} (first: {})", path, what, oddity.count, oddity.firstPlace));
}

GltfMesh readGltfMesh(const GltfElement& from, GltfMeshReading& reading) {
    const std::size_t count = from.count("primitives");
    if (count == 0) from.fail("has no primitives");
    GltfMesh mesh{.name = from.name(),
                  .primitives = {},
                  .targetCount = std::uint32_t(from.at("primitives", 0).count("targets")),
                  .weights = from.numbers("weights")};
    for (std::size_t i = 0; i < count; ++i)
        mesh.primitives.push_back(PrimitiveReader(from.at("primitives", i), reading).read(mesh.targetCount));
    if (mesh.weights.empty()) mesh.weights.resize(mesh.targetCount, 0);
    if (mesh.weights.size() != mesh.targetCount)
        from.fail("{} weights for {} morph targets", mesh.weights.size(), mesh.targetCount);
    return mesh;
}

} // namespace relief
