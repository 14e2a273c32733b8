// Pictures in which there is nothing to see, and why.
#pragma once

#include "app/options.h"

namespace relief::app {

/// Whether so few pixels are covered that the object may have been missed.
bool isSparse(const Picture& picture);

/// What is known of a sparse picture.
struct EmptyView {
    std::span<const dvec3> points; ///< that outline what should be seen, as the camera has them
    const Camera& camera;
    int width = 0, height = 0; ///< pixels
    Coordinates coordinates;   ///< of the points, for messages
};

/// "there is nothing to see: all of its points lie on one line", or "" where there is something.
std::string complaintOf(const Picture& picture, const EmptyView& view);

} // namespace relief::app
