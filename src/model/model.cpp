#include <algorithm>
#include <cmath>
#include <cstring>

#include "model/bounds.h"
#include "model/stages.h"

namespace relief {
namespace {

/// RGBA bytes of an albedo picture and of its mips, largest first; averages run on linear light.
struct AlbedoMips {
    std::vector<std::uint8_t> bytes;
    std::uint32_t levels = 0;
};

double linearOf(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }
double srgbOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t byteOf(double value) { return std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

struct AlbedoTables {
    double linear[256];
    std::uint8_t srgb[4096];
    AlbedoTables() {
        for (int i = 0; i < 256; ++i) linear[i] = linearOf(i / 255.0);
        for (int i = 0; i < 4096; ++i) srgb[i] = byteOf(srgbOf(i / 4095.0));
    }
};

AlbedoMips albedoMips(const Image& image) {
    static const AlbedoTables tables;
    AlbedoMips mips;
    auto width = std::size_t(image.width), height = std::size_t(image.height);
    mips.bytes.reserve(width * height * 4 * 4 / 3 + 64);
    for (std::size_t i = 0; i < width * height; ++i)
        for (std::size_t c = 0; c < 4; ++c)
            mips.bytes.push_back(c < 3 ? byteOf(image.texels[i * std::size_t(image.channels) + c]) : 255);
    std::size_t from = 0;
    for (mips.levels = 1; width > 1 || height > 1; ++mips.levels) {
        const std::size_t w = std::max<std::size_t>(1, width / 2), h = std::max<std::size_t>(1, height / 2);
        const std::size_t to = mips.bytes.size();
        for (std::size_t y = 0; y < h; ++y)
            for (std::size_t x = 0; x < w; ++x)
                for (std::size_t c = 0; c < 4; ++c) {
                    double sum = 0;
                    for (std::size_t k = 0; k < 4; ++k) {
                        const std::size_t sx = std::min(2 * x + k % 2, width - 1),
                                          sy = std::min(2 * y + k / 2, height - 1);
                        sum += tables.linear[mips.bytes[from + (sy * width + sx) * 4 + c]];
                    }
                    mips.bytes.push_back(tables.srgb[std::size_t(sum / 4 * 4095 + 0.5)]);
                }
        from = to, width = w, height = h;
    }
    return mips;
}

Texture emptyTexture(Device& device, VkFormat format) {
    const std::byte one[4] = {std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0}};
    return uploadTexture(device, {.name = "empty", .format = format}, one, 4);
}

} // namespace

Model::Model(Device& device, const ModelDesc& desc) {
    const std::uint64_t before = device.allocatedBytes();
    uploadMaps(device, desc);
    if (desc.dense != nullptr)
        uploadDense(device, *desc.dense);
    else
        uploadSurface(device, desc);
    byteCount_ = device.allocatedBytes() - before;
}

Model::~Model() = default;

void Model::uploadSurface(Device& device, const ModelDesc& desc) {
    const Surface& s = *desc.surface;
    const SurfaceRecords records = recordsOf(s);
    firstFace_ = records.firstFace, firstPatch_ = records.firstPatch, firstEdge_ = records.firstEdge;
    firstCorner_ = records.firstCorner, firstIncidence_ = records.firstIncidence;
    hasWideIndices_ = records.hasWideIndices;
    hasStraightCorners_ = records.hasStraightCorners;
    records_ =
        uploadTexels(device, {.name = "records"}, VK_FORMAT_R32G32B32A32_UINT, std::as_bytes(std::span(records.words)));
    words_ = uploadWords(device, "tree", s.tree);

    const std::vector<vec3> refined = refinePoints(s, desc.cagePositions);
    faceTexBoxes_ = relief::faceTexBoxes(s);
    faceHeightBounds_ = relief::faceHeightBounds(*heightPyramid_, faceTexBoxes_);
    faceBounds_ = relief::faceBounds(s, refined, faceHeightBounds_);
    if (enclosesVolume(s)) {
        faceNormals_ = relief::faceNormals(s, refined);
        normalBounds_ = relief::normalBounds(faceNormals_, faceTexBoxes_, *heightPyramid_);
    }
    std::vector<vec4> points;
    for (const vec3& p : refined) points.emplace_back(p, 1.0f);
    points_.texels =
        uploadTexels(device, {.name = "points"}, VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(points)));
    texPoints_ = uploadTexels(device, {.name = "texture points"}, VK_FORMAT_R32G32_SFLOAT,
                              std::as_bytes(std::span(s.texPoints)));
    mesh_ = uploadTexels(device, {.name = "no mesh"}, VK_FORMAT_R32G32B32A32_SFLOAT, {});
    meshTexCoords_ = uploadTexels(device, {.name = "no mesh texture coordinates"}, VK_FORMAT_R32G32_SFLOAT, {});
    faces_ = s.faces;
    edges_ = s.edges;
    tree_ = s.tree;
    for (const Corner& corner : s.corners) cornerFlags_.push_back(corner.flags);
    for (const Patch& patch : s.patches)
        patchIsRegular_.push_back(patch.type == kPatchRegular && (!s.hasTexCoords() || patch.texType == kPatchRegular));
    sideCount_ = s.sideCount;
    hasTexCoords_ = s.hasTexCoords();
    edgeIsHalf_.assign(s.edges.size(), false);
    for (std::uint32_t e = 0; e < s.edges.size(); ++e) edgeIsHalf_[e] = s.edges[e].partner != e;
    // The sides of an n-gon's corner quads that meet at its centre are as long as the half edges around it.
    for (const Face& face : s.faces) {
        const std::uint32_t first = face.sides[0];
        if (sideCount_ == 4 && (first & kSideSplit) == 0 &&
            s.edges[first & kSideEdgeMask].partner != (first & kSideEdgeMask))
            edgeIsHalf_[face.sides[1] & kSideEdgeMask] = edgeIsHalf_[face.sides[2] & kSideEdgeMask] = true;
    }
}

void Model::uploadDense(Device& device, const DenseMesh& mesh) {
    std::vector<vec4> vertices;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices.emplace_back(mesh.positions[i], mesh.heights.empty() ? 0.0f : mesh.heights[i]);
        vertices.emplace_back(mesh.normals[i], 0.0f);
    }
    mesh_ = uploadTexels(device, {.name = "mesh"}, VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(vertices)));
    meshTexCoords_ = uploadTexels(device, {.name = "mesh texture coordinates"}, VK_FORMAT_R32G32_SFLOAT,
                                  std::as_bytes(std::span(mesh.texCoords)));
    texPoints_ = uploadTexels(device, {.name = "no texture points"}, VK_FORMAT_R32G32_SFLOAT, {});
    points_.texels = uploadTexels(device, {.name = "no points"}, VK_FORMAT_R32G32B32A32_SFLOAT, {});
    records_ = uploadTexels(device, {.name = "no records"}, VK_FORMAT_R32G32B32A32_UINT, {});
    words_ = uploadTexels(device, {.name = "no words"}, VK_FORMAT_R32_UINT, {});
    indices_ = uploadArray<std::uint32_t>(device, "mesh indices", mesh.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    indexCount_ = std::uint32_t(mesh.indices.size());
    vertexCount_ = std::uint32_t(mesh.positions.size());
    hasTexCoords_ = !mesh.texCoords.empty();
    heightBound_ = 1;
    isDense_ = true;
}

void Model::uploadMaps(Device& device, const ModelDesc& desc) {
    if (desc.height != nullptr) {
        const HeightMap& map = *desc.height;
        const MapEncoding asFloats;
        const MapEncoding& encoding = desc.encoding != nullptr ? *desc.encoding : asFloats;
        const std::uint64_t most = 4ull * device.traits().maxTexelBufferElements;
        if (mapBytes(encoding.format, map.width, map.height) > most)
            fail(Failure::device, "a height map of {} x {} takes {} with its mips; {} reads {}", map.width, map.height,
                 humanBytes(mapBytes(encoding.format, map.width, map.height)), device.traits().name, humanBytes(most));
        const MapWords words = toWords(map, encoding);
        heights_ = uploadWords(device, "height map", words.words);
        mapFirsts_ = words.firsts;
        heightPyramid_ = std::make_unique<HeightPyramid>(map, words.roundOff);
        mapFormat_ = encoding.format;
        mapSize_ = {map.width, map.height};
        heightMid_ = float(words.mid), heightScale_ = float(words.scale), heightBound_ = float(map.heightBound());
        wrap_ = map.wrap;
    } else {
        heights_ = uploadWords(device, "no height map", {});
        heightPyramid_ = std::make_unique<HeightPyramid>();
    }
    if (desc.albedo != nullptr) {
        const AlbedoMips mips = albedoMips(*desc.albedo);
        // Samplers decode the codes each in its own way, but choose none: drivers differ by less than a code of a
        // picture.
        albedoMap_ = uploadTexture(device,
                                   {.name = "albedo map",
                                    .width = std::uint32_t(desc.albedo->width),
                                    .height = std::uint32_t(desc.albedo->height),
                                    .mipCount = mips.levels,
                                    .format = VK_FORMAT_R8G8B8A8_SRGB},
                                   std::as_bytes(std::span(mips.bytes)), 4);
        hasAlbedo_ = true;
    } else {
        albedoMap_ = emptyTexture(device, VK_FORMAT_R8G8B8A8_SRGB);
    }
}

void Model::describe(Scene& scene, std::span<Binding> bindings) const {
    scene.firstFace = firstFace_;
    scene.firstPatch = firstPatch_;
    scene.firstEdge = firstEdge_;
    scene.firstCorner = firstCorner_;
    scene.firstIncidence = firstIncidence_;
    bindings[kBindRecords].texels = records_.view.get();
    bindings[kBindTree].texels = words_.view.get();
    bindings[kBindPoints].texels = points_.texels.view.get();
    scene.pointsNow = points_.now;
    scene.pointsBefore = points_.before;
    scene.pointsRest = points_.rest.value_or(0);
    bindings[kBindTexPoints].texels = texPoints_.view.get();
    bindings[kBindMesh].texels = mesh_.view.get();
    bindings[kBindMeshTexCoords].texels = meshTexCoords_.view.get();
    bindings[kBindHeight].texels = heights_.view.get();
    bindings[kBindAlbedo].view = albedoMap_.view.get();
    scene.mapSize = mapSize_;
    scene.heightMid = heightMid_;
    scene.heightScale = heightScale_;
    scene.heightBound = heightBound_;
    scene.mapLevels = std::uint32_t(mapFirsts_.size());
    std::ranges::copy(mapFirsts_, scene.mapFirsts);
    scene.mapRepeats = wrap_ == Wrap::repeat ? 1 : 0;
    scene.edgeCount = std::uint32_t(edgeIsHalf_.size());
}

void Model::usePoints(PointSets points) {
    byteCount_ += points.texels.buffer.bytes - points_.texels.buffer.bytes;
    points_ = std::move(points);
    normalBounds_.clear(), faceNormals_.clear(); // of another pose
}

void Model::useFaceBounds(std::vector<Bounds> bounds) { faceBounds_ = std::move(bounds); }

std::vector<float> Model::uniformRates(float rate) const {
    std::vector<float> rates(edgeIsHalf_.size());
    for (std::size_t e = 0; e < rates.size(); ++e) rates[e] = edgeIsHalf_[e] ? std::ceil(rate / 2) : rate;
    return rates;
}

} // namespace relief
