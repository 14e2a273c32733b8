#include <algorithm>
#include <cmath>

#include "displacement/tile_levels.h"
#include "model/pictures.h"
#include "model/records.h"
#include "model/stages.h"

namespace relief {
namespace {

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& array) {
    return std::as_bytes(std::span(array));
}

/// A map whose words are more than the device reads from one table is refused before anything is allocated.
void checkMapSize(const Device& device, const HeightMap& map, MapFormat format) {
    const std::uint64_t maps = map.vectors ? 3 : 1;
    const std::uint64_t bytes = maps * mapBytes(format, map), most = largestTable(device, 8);
    if (bytes <= most) return;
    const std::string size =
        map.tiles.empty() ? fmt::format("{} x {}", map.width, map.height) : fmt::format("{} tiles", map.tiles.size());
    fail(Failure::device, "a height map of {} takes {} with its mips; {} reads {}", size, humanBytes(bytes),
         device.traits().name, humanBytes(most));
}

MapRecord makeRecord(const HeightMap& map, const MapWords& words) {
    MapRecord record{};
    record.size = {map.width, map.height};
    record.mid = float(words.mid);
    record.scale = float(words.scale);
    record.repeats = map.wrap == Wrap::repeat ? 1 : 0;
    if (map.addressing == Addressing::tiles) {
        const TileGrid grid = gridOf(map);
        record.firstTile = grid.first, record.tileCount = grid.count;
    }
    if (map.addressing != Addressing::texture) return record; // its words say where levels begin
    record.levelCount = std::uint32_t(words.firsts.size());
    RELIEF_CHECK(words.firsts.size() <= kMostMapLevels);
    std::ranges::copy(words.firsts, record.firstWords);
    return record;
}

/// Appends the words of a map to those of others. Blocks of texels begin at an even word.
void appendWords(MapWords& to, const MapWords& words, MapRecord& record) {
    to.words.resize((to.words.size() + 1) / 2 * 2, 0);
    const auto first = std::uint32_t(to.words.size());
    for (std::uint32_t level = 0; level < std::max(record.levelCount, 1u); ++level) record.firstWords[level] += first;
    for (const std::uint32_t word : words.firsts) to.firsts.push_back(first + word);
    to.sizes.insert(to.sizes.end(), words.sizes.begin(), words.sizes.end());
    to.words.insert(to.words.end(), words.words.begin(), words.words.end());
}

/// The three components of a vector map, one after the other in one table.
void uploadVectors(Device& device, const HeightMap& map, SurfaceModel& model) {
    const VectorMap& vectors = *map.vectors;
    const MapFormat format = vectors.encodings.front().format;
    checkMapSize(device, map, format);
    MapWords all;
    std::array<MapRecord, 3> records;
    double roundOff = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        RELIEF_CHECK(vectors.encodings[k].format == format);
        const MapWords words = toWords(vectors.channels[k], vectors.encodings[k]);
        records[k] = makeRecord(vectors.channels[k], words);
        appendWords(all, words, records[k]);
        roundOff += double(words.roundOff) * std::abs(vectors.channels[k].scale);
        model.componentPyramids.emplace_back(vectors.channels[k], words.roundOff);
    }
    model.height = GpuHeightMap{uploadHeights(device, std::move(all), format),
                                records[0],
                                format,
                                float(map.heightBound()),
                                map.addressing,
                                std::uint32_t(vectors.space),
                                {records[1], records[2]}};
    model.heightPyramid = HeightPyramid(map, float(roundOff / std::abs(map.scale)));
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
    model.patchTypes = records.patchTypes;
    model.recordTable = uploadTexels(device, {.name = "records"}, VK_FORMAT_R32G32B32A32_UINT, bytesOf(records.words));
    model.treeTable = uploadWords(device, "tree", surface.tree);
    model.texPointTable =
        uploadTexels(device, {.name = "texture points"}, VK_FORMAT_R32G32_SFLOAT, bytesOf(surface.texPoints));
}

/// What rates and the choice of lookups need of a map per face.
void addFaceHeights(const HeightMap& map, const Surface& surface, SurfaceModel& model) {
    for (const MapTile& tile : map.tiles) model.mapSegments.push_back(tile.segments);
    for (const Edge& edge : surface.edges) {
        // All nodes along the edge, at its owner.
        const Incidence& owner = edge.owner;
        const ivec2 segments = map.tiles[owner.face].size - 1;
        const int count = owner.side % 2 == 0 ? segments.x : segments.y;
        double lowest = INFINITY, highest = -INFINITY;
        for (int k = 0; k <= count; ++k) {
            const double x = std::clamp(double(k) / count, double(owner.start), double(owner.end));
            const dvec2 uv = sidePoint(4, int(owner.side), x);
            const double h = sampleHeight(map, {.face = int(owner.face), .uv = uv}).h;
            lowest = std::min(lowest, h), highest = std::max(highest, h);
        }
        model.edgeHeights.push_back({float(count) * (owner.end - owner.start), float(highest - lowest)});
    }
}

} // namespace

SurfaceModel::SurfaceModel(Device& device, const SurfaceModelDesc& desc) {
    const std::uint64_t before = device.allocatedBytes();
    const Surface& surface = *desc.surface;
    RELIEF_CHECK(desc.cagePositions.size() == surface.controlPointCount);

    // Heights first: the bounds of faces need their range.
    if (desc.function != nullptr) {
        setFunction(*desc.function);
    } else if (desc.height != nullptr && desc.height->vectors) {
        uploadVectors(device, *desc.height, *this);
    } else if (desc.height != nullptr) {
        const MapEncoding asFloats;
        const MapEncoding& encoding = desc.encoding != nullptr ? *desc.encoding : asFloats;
        checkMapSize(device, *desc.height, encoding.format);
        MapWords words = toWords(*desc.height, encoding);
        const MapRecord record = makeRecord(*desc.height, words);
        heightPyramid = HeightPyramid(*desc.height, words.roundOff);
        height = GpuHeightMap{uploadHeights(device, std::move(words), encoding.format), record, encoding.format,
                              float(desc.height->heightBound()), desc.height->addressing};
        if (height->addressing == Addressing::faces) addFaceHeights(*desc.height, surface, *this);
    }
    if (desc.albedo != nullptr)
        pictures.albedo = AlbedoMap{uploadAlbedo(device, *desc.albedo), desc.albedoWrap, desc.albedoTiles};
    if (desc.bump != nullptr) pictures.slopes = uploadSlopes(device, *desc.bump);
    if (desc.normalMap != nullptr) pictures.normalMap = uploadNormals(device, *desc.normalMap);

    uploadTables(device, surface, *this);
    copyTopology(surface, *this);

    // Points of the pose that the cage is in, and the bounds of its faces.
    const std::vector<dvec3> finePoints = refinePoints(surface, desc.cagePositions);
    const std::vector<vec3> refined(finePoints.begin(), finePoints.end());
    faceTexBoxes = relief::faceTexBoxes(surface);
    const bool movesByFunction = function && functionMovesSurface;
    faceHeightBounds = movesByFunction ? std::vector<float>(surface.faces.size(), height->heightBound)
                                       : relief::faceHeightBounds(heightPyramid, faceTexBoxes);
    faceBounds = relief::faceBounds(surface, refined, faceHeightBounds);
    const bool movesByVectors = height && height->vectorSpace != kVectorNone;
    if (enclosesVolume(surface) && !movesByFunction && !movesByVectors) { // nothing bounds the slopes of those
        faceNormals = relief::faceNormals(surface, refined);
        if (addressing() == Addressing::faces)
            for (FaceNormals& face : faceNormals) goByFace(face);
        normalBounds = relief::normalBounds(faceNormals, faceTexBoxes, heightPyramid);
    }
    std::vector<vec4> texels(finePoints.size());
    std::ranges::transform(finePoints, texels.begin(), packPoint);
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
    functionMovesSurface = heights.movesSurface;
    functionBendsNormals = heights.bendsNormals;
}

void SurfaceModel::setPoints(PointSets other) {
    byteCount += other.table.buffer.bytes - points.table.buffer.bytes;
    points = std::move(other);
    normalBounds.clear();
}

namespace {

/// What bends the normals of a mesh, and the tangents that it needs for that.
void uploadDetail(Device& device, const MeshModelDesc& desc, MeshModel& model) {
    if (desc.bump != nullptr) model.pictures.slopes = uploadSlopes(device, *desc.bump);
    if (desc.normalMap != nullptr) model.pictures.normalMap = uploadNormals(device, *desc.normalMap);
    const bool needsTangents =
        model.pictures.needTexGradients() || (desc.function != nullptr && !desc.mesh->texCoords.empty());
    if (needsTangents) RELIEF_CHECK(desc.tangents != nullptr);
    std::vector<vec4> texels;
    if (needsTangents || desc.function != nullptr)
        texels = toTexGradients(*desc.mesh, desc.tangents, model.restPositions);
    model.texGradients =
        uploadTexels(device, {.name = "mesh texture gradients", .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
                     VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels));
}

} // namespace

namespace {

void setFunction(const MeshModelDesc& desc, MeshModel& model) {
    const FunctionHeights& heights = *desc.function;
    RELIEF_CHECK(heights.movesSurface == false);
    const std::vector<vec3>& positions = desc.mesh->positions;
    model.function = heights.function;
    model.restPositions = desc.restPositions.empty()
                              ? positions
                              : std::vector<vec3>(desc.restPositions.begin(), desc.restPositions.end());
    RELIEF_CHECK(model.restPositions.size() == positions.size());
    model.tables.maps[0].scale = float(heights.scale);
    model.tables.maps[0].mid = float(heights.mid);
    model.tables.heightBound = heights.bound;
    model.tables.heightUnit = float(heights.unit);
    model.tables.heightStep = heights.step;
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
    indices = uploadIndices(device, mesh.indices);
    if (desc.albedo != nullptr)
        pictures.albedo = AlbedoMap{uploadAlbedo(device, *desc.albedo), desc.albedoWrap, desc.albedoTiles};
    tables.heightBound = 1; // heights of a mesh are relative: DenseMesh::heights
    if (desc.function != nullptr) setFunction(desc, *this);
    uploadDetail(device, desc, *this);
    vertexCount = std::uint32_t(mesh.positions.size());
    triangleCount = std::uint32_t(mesh.indices.size() / 3);
    hasTexCoords = !mesh.texCoords.empty();
    byteCount = device.allocatedBytes() - before;
}

} // namespace relief
