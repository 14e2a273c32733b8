// Internal: a picture as the bytes of a PNG file.
#pragma once

#include <string>

#include "base/images.h"

namespace relief {

/// Returns the bytes of a PNG of `sample`s, which are integers; equal pictures are equal bytes. The values are clamped
/// to 0..1. `path` stands for the picture in messages. `attributes` become chunks of text (tEXt): names are up to 79
/// characters long. Throws Failure::file for more than 4 channels.
std::string encodePng(const std::string& path, const Image& image, SampleType sample,
                      const ImageAttributes& attributes = {});

} // namespace relief
