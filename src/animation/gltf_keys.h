// Values of the keys of a glTF clip at a time.
#pragma once

#include "base/base.h"
#include "cage/gltf.h"

namespace relief {

/// What a clip moves: one entry per node.
struct GltfMotion {
    std::vector<GltfTransform> transforms;
    std::vector<std::vector<double>> weights; ///< of morph targets
};

/// Replaces what the clip moves by its value at a time: that of the first key before it, that of the last after it.
void applyClip(const GltfClip& clip, double seconds, GltfMotion& motion);

/// Seconds of the earliest and the latest key; (0, 0) without keys or with one time only.
dvec2 keyRangeOf(const GltfClip& clip);

} // namespace relief
