// For other modules: what a baked map says in its header about how it is to be read.
#pragma once

#include <optional>

#include "base/base.h"

namespace relief {

/// The cage that a map was baked over, and what makes heights of its values.
struct MapOrigin {
    std::uint64_t topology = 0; ///< hashTopology() of the cage
    double mid = 0, scale = 1;  ///< h = scale * (value - mid), cage units
};

/// The text that writeImage() puts into the header of a picture.
ImageAttributes toAttributes(const MapOrigin& origin);

/// Reads it back; empty for files without it, and where it is damaged.
std::optional<MapOrigin> readMapOrigin(const ImageInfo& info);

} // namespace relief
