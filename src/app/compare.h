// Pictures of one view by several techniques, side by side.
#pragma once

#include <span>
#include <string>

#include "frame/frame.h"

namespace relief::app {

struct Panel {
    Image image; ///< display values 0..1, 3 channels; as large as the others
    std::string caption;
};

/// Arranges panels in a row, each with its caption below it. Warns where there is no font for captions.
Image arrangePanels(std::span<const Panel> panels, const Warn& warn);

} // namespace relief::app
