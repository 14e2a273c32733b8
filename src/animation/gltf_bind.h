// How the points of a cage follow the vertices of a glTF file.
#pragma once

#include "animation/animation.h"
#include "cage/gltf.h"

namespace relief {

/// A joint of the rig: world of the node * inverse bind, from the coordinates of the rig's rest.
struct GltfJoint {
    std::uint32_t node = 0;
    glm::dmat4 inverseBind{1};
};

/// A morph target of the rig: a weight of the node.
struct GltfMorph {
    std::uint32_t node = 0, target = 0;
};

struct GltfBinding {
    Rig rig;
    std::vector<GltfJoint> joints; ///< rig.jointCount: those that some cage point needs
    std::vector<GltfMorph> morphs; ///< rig.morphCount
    Coordinates rest;              ///< of the points of the rig, in the spaces of their meshes
    Coordinates posed;             ///< of poses, in the world
};

/// Binds each cage point to the vertex that it follows. `path`: of the file, for messages. Throws as readSkin where a
/// point has no vertex.
GltfBinding bindCage(const GltfScene& scene, const Cage& cage, bool bindsNearest, const std::string& path,
                     const Warn& warn);

} // namespace relief
