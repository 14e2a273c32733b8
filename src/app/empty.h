// Pictures in which nothing was drawn, and why.
#pragma once

#include "app/options.h"

namespace relief::app {

/// Whether no pixel is covered.
bool isEmpty(const Picture& picture);

/// What is known of a picture without a covered pixel.
struct EmptyView {
    std::span<const dvec3> points; ///< that outline what should be seen, as the camera has them
    const Camera& camera;
    int width = 0, height = 0; ///< pixels
    Coordinates coordinates;   ///< of the points, for messages
};

/// Why nothing was drawn, as the end of a sentence: "all its points lie at (0, 0, 0)".
std::string reasonOf(const EmptyView& view);

} // namespace relief::app
