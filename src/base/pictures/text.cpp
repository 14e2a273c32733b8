// Text in pictures, by OpenImageIO and FreeType, and in their headers.
#include <filesystem>
#include <sstream>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "base/pictures/module.h"

namespace relief::pictures {

bool drawText(Image& image, const std::string& text, int x, int y, int size, float grey) {
    // OpenImageIO looks for a name in a few folders, which are not Debian's.
    const char* debians = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    const std::string font = std::filesystem::exists(debians) ? debians : "DejaVuSans";
    OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width, image.height, image.channels, OIIO::TypeFloat),
                          image.texels.data());
    const float color[4] = {grey, grey, grey, 1};
    const bool isDrawn =
        OIIO::ImageBufAlgo::render_text(buffer, x, y, text, size, font, {color, image.channels},
                                        OIIO::ImageBufAlgo::TextAlignX::Center, OIIO::ImageBufAlgo::TextAlignY::Center);
    if (!isDrawn) (void)buffer.geterror(); // taken, so that nothing prints it
    return isDrawn;
}

std::string joinAttributes(const ImageAttributes& attributes) {
    std::string lines;
    for (const auto& [name, text] : attributes) lines += name + ' ' + text + '\n';
    return lines;
}

ImageAttributes splitAttributes(const std::string& lines) {
    ImageAttributes attributes;
    std::istringstream rest(lines);
    for (std::string line; std::getline(rest, line);) {
        const std::size_t blank = line.find(' ');
        if (line.starts_with(kAttributePrefix) && blank != std::string::npos)
            attributes[line.substr(0, blank)] = line.substr(blank + 1);
    }
    return attributes;
}

} // namespace relief::pictures
