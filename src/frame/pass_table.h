// Internal: the passes that draw, and the techniques that a picture can show, one row each.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>

#include "frame/frame.h"
#include "shared/constants.h"

namespace relief {

// --- passes -------------------------------------------------------------------------------------------------------

constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16_SFLOAT;
constexpr VkFormat kColorFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32; // codes that shaders/rounding.glsl chooses
constexpr VkFormat kInstanceFormat = VK_FORMAT_R8_UINT;
constexpr VkFormat kCrackFormat = VK_FORMAT_R16_SFLOAT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kShadowFormat = VK_FORMAT_D16_UNORM; // even steps suit a parallel projection
constexpr VkFormat kLayerFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

enum class DrawPass { shadow, surface, lines, cracks, layers, errors };

struct DrawPassRow {
    const char* name = nullptr;
    std::uint32_t constant = 0;       ///< kPass... of shared/constants.h
    const char* fragment = nullptr;   ///< shader file; null: depth alone
    std::array<VkFormat, 2> colors{}; ///< VK_FORMAT_UNDEFINED: none
    VkFormat depth = VK_FORMAT_UNDEFINED;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool marksInstances = false; ///< where there are several: one more target of kInstanceFormat
    bool hasNormals = false;     ///< else positions are all that counts, and no normal is cheaper than the limit normal
    bool bendsNormals = false;   ///< by slopes of heights and normal maps, per fragment
    bool drawsHidden = false;    ///< faces out of view too: what casts a shadow, and what cracks are counted through
    bool isAdditive = false;
    bool drawsLines = false;
    bool namesPoints = false; ///< fragments know where in their face they lie: diced meshes are drawn face by face
};

/// The rows of all passes, in the order of DrawPass.
constexpr DrawPassRow kDrawPasses[] = {
    {.name = "shadow", .constant = kPassShadow, .depth = kShadowFormat, .drawsHidden = true},
    {.name = "surface",
     .constant = kPassSurface,
     .fragment = "surface.frag",
     .colors = {kNormalFormat, kColorFormat},
     .depth = kDepthFormat,
     .samples = VK_SAMPLE_COUNT_4_BIT,
     .marksInstances = true,
     .hasNormals = true,
     .bendsNormals = true},
    {.name = "lines",
     .constant = kPassLines,
     .fragment = "surface.frag",
     .colors = {kNormalFormat, kColorFormat},
     .depth = kDepthFormat,
     .samples = VK_SAMPLE_COUNT_4_BIT,
     .marksInstances = true,
     .hasNormals = true,
     .drawsLines = true},
    {.name = "cracks",
     .constant = kPassCracks,
     .fragment = "crack.frag",
     .colors = {kCrackFormat},
     .drawsHidden = true,
     .isAdditive = true},
    {.name = "layers",
     .constant = kPassLayers,
     .fragment = "layers.frag",
     .colors = {kLayerFormat, kLayerFormat},
     .depth = kDepthFormat,
     .marksInstances = true,
     .hasNormals = true,
     .bendsNormals = true,
     .namesPoints = true},
    {.name = "errors",
     .constant = kPassLayers,
     .fragment = "errors.frag",
     .colors = {kNormalFormat, kColorFormat},
     .depth = kDepthFormat,
     .samples = VK_SAMPLE_COUNT_4_BIT,
     .marksInstances = true,
     .hasNormals = true,
     .namesPoints = true},
};

constexpr const DrawPassRow& rowOf(DrawPass pass) { return kDrawPasses[std::size_t(pass)]; }

// --- techniques ---------------------------------------------------------------------------------------------------

/// What a picture shows, and what that needs.
struct Technique {
    Show show;
    std::uint32_t constant; ///< kShow... of shared/constants.h
    bool isLit = false;     ///< shadows, environment, tone curve; else colours to be seen as they are
    bool wantsAlbedo = false;
    bool wantsTexCoords = false;
    bool wantsFaces = false;           ///< fragments read the number of their face: a diced mesh is drawn face by face
    bool hasLines = false;             ///< a pass of lines over the surface
    DrawPass pass = DrawPass::surface; ///< that draws the surface
};

/// The rows of all techniques, in the order of Show.
constexpr Technique kTechniques[] = {
    {.show = Show::shaded, .constant = kShowShaded, .isLit = true, .wantsAlbedo = true},
    {.show = Show::normal, .constant = kShowNormal},
    {.show = Show::height, .constant = kShowHeight},
    {.show = Show::rate, .constant = kShowRate, .wantsFaces = true},
    {.show = Show::faces, .constant = kShowFaces, .wantsFaces = true},
    {.show = Show::wireframe, .constant = kShowWireframe, .hasLines = true},
    {.show = Show::texCoords, .constant = kShowTexCoords, .wantsTexCoords = true},
    {.show = Show::error, .constant = kShowError, .pass = DrawPass::errors},
};
static_assert(std::ranges::all_of(kTechniques, [](const Technique& t) { return &t - kTechniques == int(t.show); }));

constexpr const Technique& techniqueOf(Show show) { return kTechniques[std::size_t(show)]; }

} // namespace relief
