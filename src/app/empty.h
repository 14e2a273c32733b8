// Pictures in which there is nothing to see, and why.
#pragma once

#include "frame/frame.h"

namespace relief::app {

/// Whether so few pixels are covered that the object may have been missed.
bool isSparse(const Picture& picture);

/// What a sparse picture was meant to show.
struct EmptyView {
    std::span<const dvec3> points; ///< that outline the object, in the camera's coordinates
    const Camera& camera;
    ivec2 size{0};           ///< pixels
    Coordinates coordinates; ///< of the points, for messages
};

/// Says why there is nothing to see, such as "there is nothing to see: all of its points lie on one line"; empty where
/// there is something.
std::string complaintOf(const Picture& picture, const EmptyView& view);

} // namespace relief::app
