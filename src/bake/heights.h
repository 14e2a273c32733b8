// Heights of a sculpt over a surface: one line per sample of a texel.
#pragma once

#include "bake/layers.h"
#include "bake/lines.h"
#include "bake/texels.h"
#include "distance/distance.h"

namespace relief {

enum class TexelState : std::uint8_t {
    outside, ///< no sample of it lies on the surface
    hit,
    missed, ///< a void: all its lines miss the sculpt
};

struct BakeOptions {
    LineSearch lines;
    bool dropsBehind = false; ///< hits behind the back of another triangle are none
    LayerOptions layers;      ///< what is baked besides
    ShowProgress progress = ShowProgress::never;
};

/// A baked map. Counts of texels are of those that have a sample inside of an island.
struct BakedHeights {
    int width = 0, height = 0;
    std::vector<float> heights; ///< in the unit of the surface, rows from the top
    std::vector<TexelState> states;
    std::vector<Image> layers; ///< one per BakeOptions::layers
    std::uint64_t texelCount = 0, voidCount = 0;
    std::uint64_t sampleCount = 0, missCount = 0;
    std::uint64_t behindCount = 0; ///< samples whose line passes the back of another triangle first
    std::vector<bool> seenFaces;   ///< faces that a sample lies in
    std::uint64_t insideCount = 0; ///< samples where LineSearch::cage lies inside of the surface
};

/// Looks for the sculpt on the line of each sample as SculptLines does. On all cores; the result does not depend on how
/// many there are.
/// Texels without a hit are filled: voids on the surface by a membrane between the texels around them (a discrete
/// Laplace equation), all others by means of the heights around them. A map without any hit stays 0.
/// Layers are means over the samples inside of islands; all texels without any are filled from around.
BakedHeights bakeHeights(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const TexelSource& texels,
                         const BakeOptions& options);

} // namespace relief
