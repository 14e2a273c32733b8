// Several maps of one surface, added.
#pragma once

#include "displacement/height_map.h"
#include "displacement/vector_map.h"

namespace relief {

/// Where a map is looked up: at repeat * (s,t) + offset.
struct MapPlacement {
    dvec2 repeat{1}, offset{0};

    [[nodiscard]] dvec2 at(const dvec2& st) const { return repeat * st + offset; }
    [[nodiscard]] bool isIdentity() const { return repeat == dvec2(1) && offset == dvec2(0); }
};

/// A map per face that has the heights of another map of the same surface, in cage units, at its nodes. `reference` is
/// the surface's; the map is looked up at its placement where it is over texture coordinates. `segments`: along each
/// side of each face, a power of two; without it as many as there are texels under the face, 4096 at
/// most. Throws as linkFaces does, and Failure::input for more than 2^28 nodes.
HeightMap toFaceMap(const HeightMap& map, const MapPlacement& placement, const Surface& surface,
                    const ReferenceSurface& reference, std::optional<int> segments = {});

/// One of the maps that are added.
struct MapLayer {
    std::string name;              ///< of its file, for messages
    HeightMap map;                 ///< heights, or vectors; a map per face need not be fitted yet
    MapPlacement placement;        ///< of the map
    std::string maskName;          ///< for messages
    std::optional<HeightMap> mask; ///< its values multiply those of the map; it is looked up at (s,t) itself
};

/// Whether the sum of layers repeats in every unit square: each repeats a whole number of times.
bool repeatsWhole(std::span<const MapLayer> layers);

/// Adds layers: h(s,t) = sum of mask_i(s,t) h_i(repeat_i (s,t) + offset_i), in cage units. The sum of vectors and
/// heights are vectors of tangent space, with heights along the normal.
///
/// The result has as many texels per unit square as the finest layer or mask, and is a set of tiles where a layer is
/// one, over the unit squares of all sets. At its texel centres it is exact but for the rounding of floats; between
/// them it is bilinear. Layers of the same size without a repeat are exact everywhere. A coarser one is cut at its own
/// texels' centres, by at most 1/8 of its second difference there along each axis, and so is the product with a mask.
/// Maps per face are added node by node of the finer one, which is exact but for what lies beside an edge where a map
/// changes its size: there the edge is the sum of its owner's.
///
/// Throws Failure::usage for what cannot be added: maps per face and others (toFaceMap() makes those of these), vectors
/// of object space and of tangent space, a set or a map per face that repeats; Failure::input for maps per face of
/// different cages and a sum too large for memory.
EncodedMap addLayers(std::span<const MapLayer> layers, Wrap wrap, MapFormat format);

} // namespace relief
