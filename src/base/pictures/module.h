// Internal: the module of pictures, a shared library that holds what needs OpenImageIO. That library loads some 260
// others, so it is loaded with the first picture that needs it, and not with the program. PNG is written without it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/images.h"

namespace relief {

/// How a picture is encoded in a file.
struct ImageEncoding {
    std::string format;                 ///< writer's name: "tiff" or "openexr"
    SampleType sample;                  ///< of all channels, where `channels` is empty
    std::vector<ImageChannel> channels; ///< with names and sample types of their own
    std::string compression;            ///< empty: the format's own choice
    ImageAttributes attributes;         ///< of an EXR; of a TIFF lines of its description
};

/// What the module does; base/images.h describes the functions of the same names.
struct ImageModule {
    ImageInfo (*readImageInfo)(const std::string& path, const ImageLimits& limits);
    Image (*readImage)(const std::string& path, int channel, const ImageLimits& limits, int part);
    Image (*decodeImage)(std::span<const unsigned char> bytes, const std::string& name, const ImageLimits& limits);
    void (*readImageRows)(const std::string& path, const TakeRows& take, const ImageLimits& limits);
    /// Returns the bytes of a file. `path` stands for it in messages. Throws Failure::file.
    std::vector<unsigned char> (*encodeImage)(const std::string& path, const Image& image,
                                              const ImageEncoding& encoding);
    bool (*drawText)(Image& image, const std::string& text, int x, int y, int size, float grey);
};

/// The name of the function without arguments that the shared library exports: it returns a `const ImageModule*`.
constexpr const char* kImageModuleEntry = "reliefImageModule";

/// Loads the shared library at the first call. Threads that call it meanwhile wait.
/// Throws Failure::device where there is no memory for it, Failure::internal where it is not found.
const ImageModule& imageModule();

/// The parts of the module, each in a source file of its own.
namespace pictures {
ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits);
Image readImage(const std::string& path, int channel, const ImageLimits& limits, int part);
Image decodeImage(std::span<const unsigned char> bytes, const std::string& name, const ImageLimits& limits);
void readImageRows(const std::string& path, const TakeRows& take, const ImageLimits& limits);
std::vector<unsigned char> encodeImage(const std::string& path, const Image& image, const ImageEncoding& encoding);
bool drawText(Image& image, const std::string& text, int x, int y, int size, float grey);

inline constexpr const char* kTiffDescription = "ImageDescription"; ///< a TIFF has no other place for text of one's own
/// Attributes as lines of a name, a blank and the text, and back; other lines are none.
std::string joinAttributes(const ImageAttributes& attributes);
ImageAttributes splitAttributes(const std::string& lines);
} // namespace pictures

} // namespace relief
