// Internal: the matrices and images of a picture in the making.
#pragma once

#include "frame/pass_table.h"
#include "triangles/stages.h"

namespace relief {

/// Right-handed view, Y down in clip space, depth 1 at the near and 0 at the far distance.
mat4 perspectiveMatrix(const Camera& camera, double aspect);

/// Parallel projection along the key light, holding the whole object; nearer to the light is larger.
mat4 shadowMatrix(const dvec3& towardsLight, const Bounds& bounds);

/// The images of a picture in the making.
struct Targets {
    Texture normals, colors, depths; ///< four samples per pixel, what surface.frag writes
    Texture instances;               ///< of the picture's size once one has several, else a single pixel
    Texture shadow;
    Buffer picture; ///< four halves per pixel, mapped
};

Targets makeTargets(Device& device, const RendererDesc& desc);
Texture makeInstanceTarget(Device& device, const RendererDesc& desc, VkSampleCountFlagBits samples);

/// The images that layers are made from, one sample per pixel; made when layers are first asked for.
struct LayerTargets {
    Texture normals, surfacePoints, depths; ///< what layers.frag writes
    std::optional<Texture> instances;
    Buffer values; ///< kLayerChannels floats per pixel, mapped
};

LayerTargets makeLayerTargets(Device& device, const RendererDesc& desc);

} // namespace relief
