// Internal: the matrices and images of a picture in the making.
#pragma once

#include "frame/pass_table.h"
#include "triangles/stages.h"

namespace relief {

/// Right-handed view, Y down in clip space, depth 1 at the near and 0 at the far distance.
mat4 perspectiveMatrix(const Camera& camera, double aspect);

/// Parallel projection along the key light, holding the whole object; nearer to the light is larger.
mat4 shadowMatrix(const dvec3& towardsLight, const Bounds& bounds);

/// What draws of the device write samples to.
struct SampleImages {
    Texture normals, colors, depths; ///< four samples per pixel, what surface.frag writes
    Texture instances;               ///< of the picture's size once one has several, else a single pixel
    bool isPlaceholder = false;      ///< of single pixels
};

SampleImages makeSampleImages(Device& device, const RendererDesc& desc);
Texture makeShadowImage(Device& device, const RendererDesc& desc);

/// Bytes of the four samples of a pixel in SampleBuffers.
inline constexpr std::uint64_t kSampleBytes = 32;

/// What the compute rasterizer writes samples to, and what it needs meanwhile.
struct SampleBuffers {
    TexelBuffer samples;   ///< four per pixel, two per element: normal and depth of each
    TexelBuffer shadow;    ///< one word per texel of the shadow map
    TexelBuffer colors;    ///< four normals and colours per pixel; made when a picture first has ids
    TexelBuffer instances; ///< four per pixel; made when a picture first has several
    TexelBuffer screen;    ///< vertices of the largest mesh so far
    Buffer listed;         ///< triangles that are not small: room for as many as the largest mesh so far has
};

SampleBuffers makeSampleBuffers(Device& device, const RendererDesc& desc);
/// Makes a table of `pixelBytes` bytes per pixel, not written yet.
TexelBuffer makeSampleTable(Device& device, const RendererDesc& desc, const char* name, std::uint64_t pixelBytes);

/// Four halves per pixel, mapped.
Buffer makePictureBuffer(Device& device, const RendererDesc& desc);
Texture makeInstanceTarget(Device& device, const RendererDesc& desc, VkSampleCountFlagBits samples);

/// The images that the fixed function draws layers to, one sample per pixel; made when it first does.
struct LayerTargets {
    Texture normals, surfacePoints, depths; ///< what layers.frag writes
    std::optional<Texture> instances;
};

LayerTargets makeLayerTargets(Device& device, const RendererDesc& desc);
/// kLayerChannels floats per pixel, mapped.
Buffer makeLayerBuffer(Device& device, const RendererDesc& desc);

} // namespace relief
