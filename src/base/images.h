// Images on disk: PNG, TIFF, EXR, HDR and JPEG in; PNG, TIFF and EXR out. All but writing PNG needs a shared library,
// which the first of these functions that needs it loads: Failure::internal where it is not found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace relief {

// --- the library ---------------------------------------------------------------------------------------------------

/// Loads the shared library of pictures in a thread of its own, so that the first picture need not wait for it. Nothing
/// is reported: where it cannot be loaded, whoever needs a picture says so.
[[nodiscard]] std::jthread prepareImages();

// --- headers ------------------------------------------------------------------------------------------------------

/// What an image file may hold before it is refused. Checked on its header, before memory is taken.
struct ImageLimits {
    int side = 32768;                        ///< largest width and height, pixels
    std::uint64_t decodedBytes = 1ull << 30; ///< largest width * height * channels * bytes per sample
};

/// A part of an EXR or a page of a TIFF.
struct ImagePart {
    std::string name; ///< its name in the file, else its number from 0
    std::vector<std::string> channelNames;
};

/// Text that relief writes into headers of pictures, by its name, which begins with kAttributePrefix: one line each.
using ImageAttributes = std::map<std::string, std::string>;
inline constexpr std::string_view kAttributePrefix = "relief:";

/// The header of an image file. All but `parts` describes the first part.
struct ImageInfo {
    int width = 0, height = 0, channels = 0;
    std::string format; ///< reader's name: "png", "openexr", "tiff", "hdr", "jpeg"
    std::string sample; ///< sample type: "uint8", "int16", "half", "float", ...
    int sampleBytes = 0;
    bool isFloat = false;         ///< half, float or double samples: heights in units, not 0..1
    bool isSigned = false;        ///< signed integers: texels are the stored numbers, not 0..1
    std::optional<double> noData; ///< the stored number that stands for a void: GDAL_NODATA of a TIFF, which may be
                                  ///< NaN, or the grey that a PNG makes transparent
    std::string colorTag;         ///< what in the file says that its numbers are colors, for messages: "sRGB"; else ""
    std::vector<std::string> channelNames;
    std::vector<ImagePart> parts; ///< at least the first one; only pages of its size
    ImageAttributes attributes;   ///< of an EXR, TIFF or PNG: what relief has written into it

    /// True for samples whose texels are numbers with a unit of their own: 0 means no height.
    [[nodiscard]] bool hasUnit() const { return isFloat || isSigned; }
};

/// Names one channel of a file: the part's number and the channel's number in it, both from 0.
struct ChannelIndex {
    int part = 0, channel = 0;
};

/// Finds a channel by `word`: its number in the first part, its name ("R", "Displacement.R", or "part.R" with its
/// part's name before it), or the name of a layer or part, which stands for its first channel.
/// Empty where there is no such channel.
std::optional<ChannelIndex> findChannel(const ImageInfo& info, std::string_view word);

/// Names of the file's layers in their order: parts, and what stands before the last dot of channel names.
std::vector<std::string> layersOf(const ImageInfo& info);

/// Reads a header. The reader is chosen by the file's first bytes (EXR, TIFF, PNG, HDR, JPEG), never by its name.
/// Throws Failure::file when the file cannot be opened, Failure::input when it is no such image or passes a limit.
ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits = {});

// --- pixels -------------------------------------------------------------------------------------------------------

/// Floats, row-major from the top row, channels interleaved. Unsigned integers are mapped to 0..1, signed integers are
/// the stored numbers; colors are not transformed.
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<float> texels; ///< width * height * channels

    [[nodiscard]] const float* at(int x, int y) const { return &texels[(std::size_t(y) * width + x) * channels]; }
    float* at(int x, int y) { return &texels[(std::size_t(y) * width + x) * channels]; }
};

/// Reads the pixels of one part as raw data: all channels, or only `channel` (from 0) when it is not negative.
/// Throws as readImageInfo does.
Image readImage(const std::string& path, int channel = -1, const ImageLimits& limits = {}, int part = 0);

/// Decodes a PNG or JPEG that lies in memory, as readImage does a file. `name` stands for it in messages.
/// Throws Failure::input.
Image decodeImage(std::span<const unsigned char> bytes, const std::string& name, const ImageLimits& limits = {});

/// Called with rows first..first+count-1: count * width * channels texels.
using TakeRows = std::function<void(int first, int count, std::span<const float> texels)>;

/// Reads all channels of the first part as readImage does, but hands them to `take` in strips of a few megabytes, from
/// the top, so that the whole image is never in memory.
void readImageRows(const std::string& path, const TakeRows& take, const ImageLimits& limits = {});

/// A texel that is NaN or infinite; column, row and channel count from 0, the top left texel is (0,0).
struct BadTexel {
    int x = 0, y = 0, channel = 0;
    float value = 0;
};

/// The first bad texel in row-major order; empty when all are finite.
std::optional<BadTexel> findNotFinite(const Image& image);

// --- drawing ------------------------------------------------------------------------------------------------------

/// Draws a line of text, `size` pixels high, centred at (x, y), into an image of 3 or 4 channels. False where there is
/// no font.
bool drawText(Image& image, const std::string& text, int x, int y, int size, float grey);

// --- writing ------------------------------------------------------------------------------------------------------

enum class SampleType { uint8, uint16, half, real };

/// Writes PNG, TIFF or EXR by the extension of `path`, whole or not at all.
/// Values are written as they are; for integer samples they are clamped to 0..1.
/// PNG holds integers, EXR half and real, TIFF all of them (half is stored as real).
/// `compression`: "zip", "piz" and others of EXR, "zip", "lzw" and others of TIFF; empty: the format's own choice. PNG
/// has one. Throws Failure::usage for an unknown extension or a sample type that the format does not have,
/// Failure::file when writing fails.
void writeImage(const std::string& path, const Image& image, SampleType sample, const std::string& compression = "");

/// Writes a .exr, .tif or .png with text in its header: each name and text is one line. Throws as the other writeImage
/// does.
void writeImage(const std::string& path, const Image& image, SampleType sample, const ImageAttributes& attributes);

/// One channel of an EXR: its name, which may hold the layer's ("N.X"), and half or real samples.
struct ImageChannel {
    std::string name;
    SampleType sample = SampleType::real;
};

/// Writes an .exr whose channels have names and sample types of their own: `channels` has one entry per channel of the
/// image. `attributes`: text in its header. Throws as the other writeImage does.
void writeImage(const std::string& path, const Image& image, const std::vector<ImageChannel>& channels,
                const ImageAttributes& attributes = {});

} // namespace relief
