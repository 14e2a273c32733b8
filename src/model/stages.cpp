#include "model/stages.h"

#include <algorithm>

namespace relief {
namespace {

enum class BindingKind { inputs, words, floats, image, integerImage };

struct BindingRow {
    std::uint32_t slot;
    BindingKind kind;
};

/// The kinds of set 0's bindings (shared/bindings.h).
constexpr BindingRow kBindings[] = {
    {kBindInputs, BindingKind::inputs},
    {kBindHeight, BindingKind::words},
    {kBindAlbedo, BindingKind::image},
    {kBindEnvironment, BindingKind::image},
    {kBindShadow, BindingKind::image},
    {kBindRecords, BindingKind::words},
    {kBindTree, BindingKind::words},
    {kBindPoints, BindingKind::floats},
    {kBindTexPoints, BindingKind::floats},
    {kBindEdgeRates, BindingKind::floats},
    {kBindDrawFaces, BindingKind::words},
    {kBindMesh, BindingKind::floats},
    {kBindMeshTexCoords, BindingKind::floats},
    {kBindDiceTable, BindingKind::words},
    {kBindDiceTiles, BindingKind::words},
    {kBindDiceFirsts, BindingKind::words},
    {kBindLevels, BindingKind::floats},
    {kBindEdgeHeights, BindingKind::floats},
    {kBindDepths, BindingKind::image},
    {kBindNormals, BindingKind::image},
    {kBindColors, BindingKind::image},
    {kBindInstances, BindingKind::integerImage},
    {kBindSlopes, BindingKind::image},
    {kBindNormalMap, BindingKind::image},
    {kBindMeshTexGradients, BindingKind::floats},
    {kBindMeshIndices, BindingKind::words},
    {kBindScreen, BindingKind::words},
    {kBindSamples, BindingKind::words},
    {kBindShadowCodes, BindingKind::words},
    {kBindSampleColors, BindingKind::words},
    {kBindSampleInstances, BindingKind::words},
    {kBindFaceTriangles, BindingKind::words},
};
static_assert(std::size(kBindings) == kBindCount);

VkDescriptorType tableType(const Device& device) {
    return device.traits().readsTablesAs == TableAccess::storageBuffers ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                        : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
}

VkDescriptorType descriptorType(const Device& device, BindingKind kind) {
    switch (kind) {
    case BindingKind::inputs: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::image:
    case BindingKind::integerImage: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    default: return tableType(device);
    }
}

/// The pictures that fragments read. They keep the samplers that are bound.
void describePictures(const ModelPictures& pictures, PassInputs& inputs, PassBindings& bindings) {
    const auto toInputs = [](const PictureTiles& tiles) { return vec4(vec2(tiles.first), 1.0f / vec2(tiles.count)); };
    inputs.model.albedoTiles = toInputs(pictures.albedo ? pictures.albedo->tiles : PictureTiles{});
    inputs.model.slopeTiles = toInputs(pictures.slopes ? pictures.slopes->tiles : PictureTiles{});
    inputs.model.normalTiles = toInputs(pictures.normalMap ? pictures.normalMap->tiles : PictureTiles{});
    if (pictures.albedo) bindings[kBindAlbedo].view = pictures.albedo->texture.view.get();
    if (pictures.normalMap) bindings[kBindNormalMap].view = pictures.normalMap->texture.view.get();
    if (!pictures.slopes) return;
    inputs.model.slopeUnit = pictures.slopes->unit;
    bindings[kBindSlopes].view = pictures.slopes->texture.view.get();
}

} // namespace

std::vector<std::uint32_t> ShaderConstants::values() const {
    std::vector<std::uint32_t> values(kIdCount, 0);
    values[kIdGenericBasis] = isGenericBasis;
    values[kIdHasTexCoords] = hasTexCoords;
    values[kIdHasHeight] = hasHeight;
    values[kIdNormal] = std::uint32_t(normal);
    values[kIdWantsTexCoords] = wantsTexCoords;
    values[kIdShow] = show;
    values[kIdHasAlbedoMap] = hasAlbedoMap;
    values[kIdGroupSize] = groupSize;
    values[kIdHasMips] = hasMips;
    values[kIdIsCommon] = isCommon;
    values[kIdStretches] = stretches;
    values[kIdHasMotion] = hasMotion;
    values[kIdMapFormat] = std::uint32_t(mapFormat);
    values[kIdHasWideIndices] = hasWideIndices;
    values[kIdHasStraightCorners] = hasStraightCorners;
    values[kIdPatchTypes] = patchTypes;
    values[kIdPass] = pass;
    values[kIdIsMesh] = isMesh;
    values[kIdIsPlaced] = isPlaced;
    values[kIdHasInstances] = hasInstances;
    values[kIdEntries] = entryCount;
    values[kIdIsFine] = isFine;
    values[kIdHeightFunction] = heightFunction;
    values[kIdReadsRest] = readsRest;
    values[kIdReadsSampleBuffers] = readsSampleBuffers;
    values[kIdReadsShadowCodes] = readsShadowCodes;
    values[kIdWritesIds] = writesIds;
    values[kIdHasSampleColors] = hasSampleColors;
    values[kIdHasTexGradients] = hasTexGradients;
    values[kIdHasSlopes] = hasSlopes;
    values[kIdNormalMap] = normalMap;
    values[kIdVectorSpace] = vectorSpace;
    values[kIdShading] = shading;
    values[kIdAddsLight] = addsLight;
    values[kIdHasOcclusion] = hasOcclusion;
    values[kIdMapAddressing] = std::uint32_t(addressing);
    values[kIdReadsNodes] = readsNodes;
    values[kIdHasPictureTiles] = hasPictureTiles;
    return values;
}

bool areOfGoneFunction(std::span<const std::uint32_t> values) {
    const std::uint32_t number = values[kIdHeightFunction];
    return number != 0 && !HeightFunction::lives(number);
}

ShaderConstants constantsOf(const SurfaceModel& model, NormalKind normal) {
    return {.hasTexCoords = model.hasTexCoords,
            .hasHeight = model.isDisplaced(),
            .normal = normal,
            .stretches = model.stretches(),
            .mapFormat = model.mapFormat(),
            .addressing = model.addressing(),
            .hasWideIndices = model.hasWideIndices,
            .hasStraightCorners = model.hasStraightCorners,
            .patchTypes = model.patchTypes,
            .heightFunction = model.function ? model.function->number() : 0,
            .vectorSpace = model.height ? model.height->vectorSpace : kVectorNone,
            .readsRest = model.points.rest.has_value()};
}

ShaderConstants constantsOf(const MeshModel& model) {
    return {.hasTexCoords = model.hasTexCoords,
            .isMesh = true,
            .heightFunction = model.function ? model.function->number() : 0};
}

std::uint64_t largestTable(const Device& device, std::uint64_t elementBytes) {
    const DeviceTraits& traits = device.traits();
    return traits.readsTablesAs == TableAccess::storageBuffers ? traits.maxStorageBufferRange
                                                               : elementBytes * traits.maxTexelBufferElements;
}

TexelBuffer uploadWords(Device& device, const std::string& name, std::span<const std::uint32_t> words) {
    return uploadTexels(device, {.name = name}, VK_FORMAT_R32_UINT, std::as_bytes(words));
}

namespace {

constexpr VkBufferUsageFlags kIndexUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;

bool readsIndices(const Device& device, std::uint64_t count) { return count <= largestTable(device, 4) / 4; }

} // namespace

TexelBuffer makeIndices(Device& device, std::uint64_t count) {
    const BufferDesc desc{.name = "indices", .bytes = count * 4, .usage = kIndexUsage};
    if (!readsIndices(device, count)) return {makeBuffer(device, desc), {}};
    return makeTexels(device, desc, VK_FORMAT_R32_UINT);
}

TexelBuffer uploadIndices(Device& device, std::span<const std::uint32_t> indices) {
    const BufferDesc desc{.name = "indices", .usage = kIndexUsage};
    if (!readsIndices(device, indices.size())) return {uploadArray(device, desc.name, indices, desc.usage), {}};
    return uploadTexels(device, desc, VK_FORMAT_R32_UINT, std::as_bytes(indices));
}

PipelineLayoutDesc tableLayout(const Device& device, std::uint32_t count, std::uint32_t pushBytes) {
    return {std::vector<VkDescriptorType>(count, tableType(device)), pushBytes};
}

Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file, bool isTriangles) {
    return {stage, shaderCode(file, isTriangles, device.traits().readsTablesAs)};
}

Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file,
                  const HeightFunction* function, bool isTriangles) {
    if (function != nullptr) {
        const std::span<const std::uint32_t> code = function->shader(file, isTriangles, device.traits().readsTablesAs);
        if (!code.empty()) return {stage, code, function->weak_from_this().lock()};
    }
    return shaderStage(device, stage, file, isTriangles);
}

Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file, const SurfaceModel& model) {
    return shaderStage(device, stage, file, model.function.get(), model.isTriangles());
}

PipelineLayoutDesc passLayout(const Device& device) {
    PipelineLayoutDesc layout{std::vector<VkDescriptorType>(kBindCount), kPushBytes};
    for (const BindingRow& row : kBindings) layout.bindings[row.slot] = descriptorType(device, row.kind);
    return layout;
}

Buffer makeInputBuffer(Device& device) {
    return makeBuffer(device, {.name = "pass inputs",
                               .bytes = sizeof(PassInputs),
                               .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
}

void writeInputs(VkCommandBuffer commands, const Buffer& buffer, const PassInputs& inputs) {
    vkCmdUpdateBuffer(commands, buffer.handle.get(), 0, sizeof(PassInputs), &inputs);
    barrier(commands);
}

PassResources::PassResources(Device& device)
    : inputs_(makeInputBuffer(device)),
      noWords_(uploadTexels(device, {.name = "no words"}, VK_FORMAT_R32G32B32A32_UINT, {})),
      noFloats_(uploadTexels(device, {.name = "no floats"}, VK_FORMAT_R32G32B32A32_SFLOAT, {})),
      noImage_(uploadTexture(device, {.name = "no image"}, std::as_bytes(std::span("\0\0\0", 4)), 4)),
      noIntegers_(uploadTexture(device, {.name = "no integers", .format = VK_FORMAT_R8_UINT},
                                std::as_bytes(std::span("", 1)), 1)),
      sampler_(makeSampler(device, {.filter = VK_FILTER_NEAREST})) {}

PassBindings PassResources::bindings() const {
    PassBindings bindings;
    for (const BindingRow& row : kBindings) {
        Binding& binding = bindings[row.slot];
        switch (row.kind) {
        case BindingKind::inputs: binding.uniform = inputs_.handle.get(); break;
        case BindingKind::words: binding = noWords_.binding(); break;
        case BindingKind::floats: binding = noFloats_.binding(); break;
        case BindingKind::image: binding.view = noImage_.view.get(), binding.sampler = sampler_.get(); break;
        case BindingKind::integerImage: binding.view = noIntegers_.view.get(), binding.sampler = sampler_.get(); break;
        }
    }
    return bindings;
}

void describe(const SurfaceModel& model, PassInputs& inputs, PassBindings& bindings) {
    inputs.model = model.tables;
    inputs.model.pointsNow = model.points.now;
    inputs.model.pointsBefore = model.points.before;
    inputs.model.pointsRest = model.points.rest.value_or(0);
    bindings[kBindRecords] = model.recordTable.binding();
    bindings[kBindTree] = model.treeTable.binding();
    bindings[kBindPoints] = model.points.table.binding();
    bindings[kBindTexPoints] = model.texPointTable.binding();
    if (model.height) {
        inputs.model.maps[0] = model.height->record;
        std::ranges::copy(model.height->otherRecords, inputs.model.maps + 1);
        inputs.model.heightBound = model.height->heightBound;
        if (!model.function) bindings[kBindHeight] = model.height->words.binding();
    }
    describePictures(model.pictures, inputs, bindings);
}

void describe(const MeshModel& model, PassInputs& inputs, PassBindings& bindings) {
    inputs.model = model.tables;
    bindings[kBindMesh] = model.vertices.binding();
    bindings[kBindMeshIndices] = model.indices.binding();
    bindings[kBindMeshTexCoords] = model.texCoords.binding();
    describePictures(model.pictures, inputs, bindings);
    bindings[kBindMeshTexGradients] = model.texGradients.binding();
}

} // namespace relief
