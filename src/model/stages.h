// What shader stages are given: specialization constants, set 0, and the models' part of both. For triangles, pose and
// frame.
#pragma once

#include "model/model.h"
#include "model/records.h"
#include "model/shaders.h"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/push.h"

namespace relief {

// --- specialization constants --------------------------------------------------------------------------------------

/// One member per id of shared/constants.h.
struct ShaderConstants {
    bool isGenericBasis = false, hasTexCoords = false, hasHeight = false;
    NormalKind normal = NormalKind::full;
    bool wantsTexCoords = false;
    std::uint32_t show = kShowShaded;
    bool hasAlbedoMap = false;
    std::uint32_t groupSize = 64;
    bool hasMips = false, isCommon = false, stretches = false, hasMotion = false;
    MapFormat mapFormat = MapFormat::real;
    Addressing addressing = Addressing::texture;
    bool readsNodes = false, hasPictureTiles = false;
    bool hasWideIndices = false, hasStraightCorners = false;
    std::uint32_t patchTypes = 0; ///< kIdPatchTypes
    std::uint32_t pass = kPassSurface;
    bool isMesh = false, isPlaced = false, hasInstances = false;
    std::uint32_t entryCount = 0; ///< kIdEntries
    bool isFine = false;
    bool hasTexGradients = false, hasSlopes = false;
    std::uint32_t normalMap = kNormalMapNone;
    std::uint32_t heightFunction = 0; ///< HeightFunction::number()
    std::uint32_t vectorSpace = kVectorNone;
    bool readsRest = false;
    bool readsSampleBuffers = false, readsShadowCodes = false, writesIds = false, hasSampleColors = false;
    std::uint32_t shading = kShadingPhysical;
    bool addsLight = false, hasOcclusion = false;

    /// One value per id, in the order of ids.
    [[nodiscard]] std::vector<std::uint32_t> values() const;
};

/// What follows from a model alone.
ShaderConstants constantsOf(const SurfaceModel& model, NormalKind normal);
ShaderConstants constantsOf(const MeshModel& model);

/// Whether pipelines of these values() are of a height function that is gone: nobody asks for them again.
bool areOfGoneFunction(std::span<const std::uint32_t> values);

// --- tables --------------------------------------------------------------------------------------------------------

/// The most bytes that shaders read from one table of elements of that many bytes.
std::uint64_t largestTable(const Device& device, std::uint64_t elementBytes);

/// A table of 32-bit words.
TexelBuffer uploadWords(Device& device, const std::string& name, std::span<const std::uint32_t> words);

/// Indices of a mesh, three per triangle: what draws take, and a table where the device reads one of that size.
TexelBuffer makeIndices(Device& device, std::uint64_t count);
TexelBuffer uploadIndices(Device& device, std::span<const std::uint32_t> indices);

/// The layout of `count` tables alone, bindings 0 to count - 1.
PipelineLayoutDesc tableLayout(const Device& device, std::uint32_t count, std::uint32_t pushBytes);

/// SPIR-V of a stage for this device's way of reading tables, for faces with four sides or three.
Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file, bool isTriangles = false);
/// SPIR-V of a stage with a height function in it, where the stage depends on one; null: as above. A function that is
/// shared is the owner of its code; the code of others lives as long as they do.
Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file,
                  const HeightFunction* function, bool isTriangles);
/// SPIR-V of a stage that works on a surface, with the surface's height function if it has one.
Stage shaderStage(const Device& device, VkShaderStageFlagBits stage, std::string_view file, const SurfaceModel& model);

// --- set 0 ---------------------------------------------------------------------------------------------------------

/// Set 0 of every pass (kBind...) with room for push constants.
PipelineLayoutDesc passLayout(const Device& device);

using PassBindings = std::array<Binding, kBindCount>;

/// A uniform buffer that holds one PassInputs.
Buffer makeInputBuffer(Device& device);
/// Writes it in a command buffer, before the passes that read it.
void writeInputs(VkCommandBuffer commands, const Buffer& buffer, const PassInputs& inputs);

/// The uniform buffer of a pass, and what is bound where a pass has nothing of its own: every binding is filled,
/// because Mesa 22.3's CPU driver walks all descriptors of a set, whether or not a shader reads them.
class PassResources {
public:
    explicit PassResources(Device& device);

    [[nodiscard]] PassBindings bindings() const;
    void write(VkCommandBuffer commands, const PassInputs& inputs) const { writeInputs(commands, inputs_, inputs); }

private:
    Buffer inputs_;
    TexelBuffer noWords_, noFloats_;
    Texture noImage_, noIntegers_;
    Owned<VkSampler> sampler_;
};

/// Fills a model's part of the inputs and binds its tables. Pictures keep the samplers that are bound.
void describe(const SurfaceModel& model, PassInputs& inputs, PassBindings& bindings);
void describe(const MeshModel& model, PassInputs& inputs, PassBindings& bindings);

/// Workgroups that one dispatch may have on every device.
inline constexpr std::uint32_t kGroupsAtOnce = 65535;

/// Records the push constants of a pass.
template <typename Push>
void pushConstants(VkCommandBuffer commands, const Pipeline& pipeline, const Push& block) {
    push(commands, pipeline, std::as_bytes(std::span(&block, 1)));
}

} // namespace relief
