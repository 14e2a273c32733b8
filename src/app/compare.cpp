#include "app/compare.h"

#include <algorithm>

namespace relief::app {
namespace {

constexpr int kGap = 4; ///< pixels between panels

void paste(const Image& panel, int left, Image& sheet) {
    RELIEF_CHECK(panel.channels == sheet.channels);
    for (int y = 0; y < panel.height; ++y)
        std::copy_n(panel.at(0, y), std::size_t(panel.width) * std::size_t(panel.channels), sheet.at(left, y));
}

} // namespace

Image arrangePanels(std::span<const Panel> panels, const Warn& warn) {
    const Image& first = panels.front().image;
    const int strip = std::clamp(first.height / 14, 20, 60), count = int(panels.size());
    Image sheet{count * (first.width + kGap) - kGap, first.height + strip, first.channels, {}};
    sheet.texels.assign(std::size_t(sheet.width) * std::size_t(sheet.height) * std::size_t(sheet.channels), 1);
    // One size of letters for all captions, by the longest. Letters are about half as wide as they are high.
    std::size_t longest = 1;
    for (const Panel& panel : panels) longest = std::max(longest, panel.caption.size());
    const int size = std::clamp(2 * first.width / int(longest), 6, strip / 2);
    bool hasFont = true;
    for (int i = 0; i < count; ++i) {
        const Panel& panel = panels[std::size_t(i)];
        const int left = i * (first.width + kGap);
        paste(panel.image, left, sheet);
        hasFont =
            drawText(sheet, panel.caption, left + first.width / 2, first.height + strip / 2, size, 0.1f) && hasFont;
    }
    if (!hasFont) warn("there is no font DejaVuSans (package fonts-dejavu-core): captions are missing");
    return sheet;
}

} // namespace relief::app
