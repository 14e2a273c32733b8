// Internal: a picture as the bytes of a PNG file.
#pragma once

#include <string>

#include "base/images.h"

namespace relief {

/// Returns the bytes of a PNG of `sample`s, which are integers; equal pictures are equal bytes. The values are clamped
/// to 0..1. `path` stands for the picture in messages. Throws Failure::file for more than 4 channels.
/// `attributes` become chunks of text (tEXt).
std::string encodePng(const std::string& path, const Image& image, SampleType sample,
                      const ImageAttributes& attributes = {});

} // namespace relief
