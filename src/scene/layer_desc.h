// What a command line asks for of one more map.
#pragma once

#include <optional>
#include <string>

#include "displacement/displacement.h"

namespace relief {

/// A map that is added to the heights or vectors of an object.
struct LayerDesc {
    std::string path;
    std::optional<double> mid, scale;
    std::string channel;
    std::optional<VectorOptions> vectors; ///< `path` is a vector map of this space, order and flips
    std::string mask;                     ///< path of the map that it is multiplied with, or empty
    MapPlacement placement;
};

} // namespace relief
