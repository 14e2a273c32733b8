// What the shared library exports.
#include "base/pictures/module.h"

extern "C" [[gnu::visibility("default")]] const relief::ImageModule* reliefImageModule() {
    static constexpr relief::ImageModule kModule = {
        .readImageInfo = relief::pictures::readImageInfo,
        .readImage = relief::pictures::readImage,
        .decodeImage = relief::pictures::decodeImage,
        .readImageRows = relief::pictures::readImageRows,
        .encodeImage = relief::pictures::encodeImage,
        .drawText = relief::pictures::drawText,
    };
    return &kModule;
}
