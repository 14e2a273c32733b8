#include <algorithm>

#include "model/pictures.h"
#include "model/stages.h"

namespace relief {
namespace {

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& array) {
    return std::as_bytes(std::span(array));
}

/// A map whose words are more than the device reads from one table is refused before anything is allocated.
void checkMapSize(const Device& device, const HeightMap& map, MapFormat format) {
    const std::uint64_t bytes = mapBytes(format, map.width, map.height), most = largestTable(device, 8);
    if (bytes > most)
        fail(Failure::device, "a height map of {} x {} takes {} with its mips; {} reads {}", map.width, map.height,
             humanBytes(bytes), device.traits().name, humanBytes(most));
}

MapRecord makeRecord(const HeightMap& map, const MapWords& words) {
    MapRecord record{};
    record.size = {map.width, map.height};
    record.mid = float(words.mid);
    record.scale = float(words.scale);
    record.repeats = map.wrap == Wrap::repeat ? 1 : 0;
    record.levelCount = std::uint32_t(words.firsts.size());
    RELIEF_CHECK(words.firsts.size() <= kMostMapLevels);
    std::ranges::copy(words.firsts, record.firstWords);
    return record;
}

/// Halves of split edges around n-gons are half as long as cage edges, and so are the sides of an n-gon's corner quads
/// that meet at its centre.
std::vector<bool> findHalfEdges(const Surface& surface) {
    const auto isHalf = [&](std::uint32_t edge) { return surface.edges[edge].partner != edge; };
    std::vector<bool> halves(surface.edges.size(), false);
    for (std::uint32_t e = 0; e < surface.edges.size(); ++e) halves[e] = isHalf(e);
    for (const Face& face : surface.faces) {
        const std::uint32_t first = face.sides[0];
        if (surface.sideCount == 4 && (first & kSideSplit) == 0 && isHalf(first & kSideEdgeMask))
            halves[face.sides[1] & kSideEdgeMask] = halves[face.sides[2] & kSideEdgeMask] = true;
    }
    return halves;
}

void copyTopology(const Surface& surface, SurfaceModel& model) {
    model.faces = surface.faces;
    model.edges = surface.edges;
    model.tree = surface.tree;
    for (const Corner& corner : surface.corners) model.cornerFlags.push_back(corner.flags);
    for (const Patch& patch : surface.patches)
        model.patchIsRegular.push_back(patch.type == kPatchRegular &&
                                       (!surface.hasTexCoords() || patch.texType == kPatchRegular));
    model.sideCount = surface.sideCount;
    model.hasTexCoords = surface.hasTexCoords();
    model.edgeIsHalf = findHalfEdges(surface);
}

void uploadTables(Device& device, const Surface& surface, SurfaceModel& model) {
    const SurfaceRecords records = recordsOf(surface);
    model.tables.firstFace = records.firstFace;
    model.tables.firstPatch = records.firstPatch;
    model.tables.firstEdge = records.firstEdge;
    model.tables.firstCorner = records.firstCorner;
    model.tables.firstIncidence = records.firstIncidence;
    model.tables.edgeCount = std::uint32_t(surface.edges.size());
    model.hasWideIndices = records.hasWideIndices;
    model.hasStraightCorners = records.hasStraightCorners;
    model.recordTable = uploadTexels(device, {.name = "records"}, VK_FORMAT_R32G32B32A32_UINT, bytesOf(records.words));
    model.treeTable = uploadWords(device, "tree", surface.tree);
    model.texPointTable =
        uploadTexels(device, {.name = "texture points"}, VK_FORMAT_R32G32_SFLOAT, bytesOf(surface.texPoints));
}

} // namespace

SurfaceModel::SurfaceModel(Device& device, const SurfaceModelDesc& desc) {
    const std::uint64_t before = device.allocatedBytes();
    const Surface& surface = *desc.surface;
    RELIEF_CHECK(desc.cagePositions.size() == surface.controlPointCount);

    // Heights first: the bounds of faces need their range.
    if (desc.function != nullptr) {
        setFunction(*desc.function);
    } else if (desc.height != nullptr) {
        const MapEncoding asFloats;
        const MapEncoding& encoding = desc.encoding != nullptr ? *desc.encoding : asFloats;
        checkMapSize(device, *desc.height, encoding.format);
        const MapWords words = toWords(*desc.height, encoding);
        height = GpuHeightMap{uploadHeights(device, words, encoding.format, {desc.height->width, desc.height->height}),
                              makeRecord(*desc.height, words), encoding.format, float(desc.height->heightBound())};
        heightPyramid = HeightPyramid(*desc.height, words.roundOff);
    }
    if (desc.albedo != nullptr) pictures.albedo = AlbedoMap{uploadAlbedo(device, *desc.albedo), desc.albedoWrap};
    if (desc.bump != nullptr) pictures.slopes = uploadSlopes(device, *desc.bump);
    if (desc.normalMap != nullptr) pictures.normalMap = uploadNormals(device, *desc.normalMap);

    uploadTables(device, surface, *this);
    copyTopology(surface, *this);

    // Points of the pose that the cage is in, and the bounds of its faces.
    const std::vector<vec3> refined = refinePoints(surface, desc.cagePositions);
    faceTexBoxes = relief::faceTexBoxes(surface);
    faceHeightBounds = function && !functionBendsNormals ? std::vector<float>(surface.faces.size(), height->heightBound)
                                                         : relief::faceHeightBounds(heightPyramid, faceTexBoxes);
    faceBounds = relief::faceBounds(surface, refined, faceHeightBounds);
    const bool movesByFunction = function && !functionBendsNormals;
    if (enclosesVolume(surface) && !movesByFunction) { // nothing bounds the slopes of a function
        faceNormals = relief::faceNormals(surface, refined);
        normalBounds = relief::normalBounds(faceNormals, faceTexBoxes, heightPyramid);
    }
    std::vector<vec4> texels;
    texels.reserve(refined.size());
    for (const vec3& p : refined) texels.emplace_back(p, 1.0f);
    points.table = uploadTexels(device, {.name = "points"}, VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels));
    byteCount = device.allocatedBytes() - before;
}

void SurfaceModel::setFunction(const FunctionHeights& heights) {
    function = heights.function;
    height.emplace();
    height->record.scale = float(heights.scale);
    height->record.mid = float(heights.mid);
    height->heightBound = heights.bound;
    tables.heightUnit = float(heights.unit);
    tables.heightStep = heights.step;
    faceHeightRanges = heights.faceRanges;
    functionBendsNormals = heights.bendsNormals;
}

void SurfaceModel::setPoints(PointSets other) {
    byteCount += other.table.buffer.bytes - points.table.buffer.bytes;
    points = std::move(other);
    normalBounds.clear();
}

std::vector<vec4> toTexGradients(const DenseMesh& mesh, const Tangents& tangents) {
    RELIEF_CHECK(tangents.ps.size() == mesh.positions.size());
    std::vector<vec4> texels;
    texels.reserve(2 * tangents.ps.size());
    for (std::size_t i = 0; i < tangents.ps.size(); ++i) {
        // grad s = (p_t x n) / (n . (p_s x p_t)), grad t = (n x p_s) / (n . (p_s x p_t))
        const float length = glm::length(mesh.normals[i]);
        const vec3 n = length > 0 ? mesh.normals[i] / length : vec3(0); // without a direction there are no gradients
        const vec3 &ps = tangents.ps[i], &pt = tangents.pt[i];
        const float area = glm::dot(n, glm::cross(ps, pt)), factor = area != 0 ? 1 / area : 0;
        texels.emplace_back(factor * glm::cross(pt, n), 0.0f);
        texels.emplace_back(factor * glm::cross(n, ps), 0.0f);
    }
    return texels;
}

namespace {

/// What bends the normals of a mesh, and the tangents that it needs for that.
void uploadDetail(Device& device, const MeshModelDesc& desc, MeshModel& model) {
    if (desc.bump != nullptr) model.pictures.slopes = uploadSlopes(device, *desc.bump);
    if (desc.normalMap != nullptr) model.pictures.normalMap = uploadNormals(device, *desc.normalMap);
    std::vector<vec4> texels;
    if (model.pictures.needTexGradients()) {
        RELIEF_CHECK(desc.tangents != nullptr);
        texels = toTexGradients(*desc.mesh, *desc.tangents);
    }
    model.texGradients =
        uploadTexels(device, {.name = "mesh texture gradients"}, VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels));
}

} // namespace

MeshModel::MeshModel(Device& device, const MeshModelDesc& desc) {
    const std::uint64_t before = device.allocatedBytes();
    const DenseMesh& mesh = *desc.mesh;
    RELIEF_CHECK(mesh.normals.size() == mesh.positions.size());
    std::vector<vec4> texels;
    texels.reserve(2 * mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        texels.emplace_back(mesh.positions[i], mesh.heights.empty() ? 0.0f : mesh.heights[i]);
        texels.emplace_back(mesh.normals[i], 0.0f);
    }
    vertices = uploadTexels(device, {.name = "mesh"}, VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels));
    texCoords =
        uploadTexels(device, {.name = "mesh texture coordinates"}, VK_FORMAT_R32G32_SFLOAT, bytesOf(mesh.texCoords));
    indices = uploadArray<std::uint32_t>(device, "mesh indices", mesh.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    if (desc.albedo != nullptr) pictures.albedo = AlbedoMap{uploadAlbedo(device, *desc.albedo), desc.albedoWrap};
    uploadDetail(device, desc, *this);
    vertexCount = std::uint32_t(mesh.positions.size());
    triangleCount = std::uint32_t(mesh.indices.size() / 3);
    hasTexCoords = !mesh.texCoords.empty();
    byteCount = device.allocatedBytes() - before;
}

} // namespace relief
