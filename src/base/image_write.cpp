// Writing pictures, whole or not at all.
#include "base/base.h"
#include "base/pictures/module.h"
#include "base/png_write.h"

namespace relief {

namespace {

bool isInteger(SampleType sample) { return sample == SampleType::uint8 || sample == SampleType::uint16; }

/// The writer's name for the extension; throws when the format cannot hold such samples.
std::string chooseFormat(const std::string& path, SampleType sample) {
    const std::string extension = lowerExtension(path);
    if (extension == ".tif" || extension == ".tiff") return "tiff";
    if (extension == ".png") {
        if (isInteger(sample)) return "png";
        fail(Failure::usage, "{}: PNG holds 8 or 16-bit integers only; write .exr or .tif", path);
    }
    if (extension == ".exr") {
        if (!isInteger(sample)) return "openexr";
        fail(Failure::usage, "{}: EXR holds half and float samples only; write .png or .tif", path);
    }
    fail(Failure::usage, "{}: unknown kind of picture '{}'; use .png, .exr, .tif or .tiff", path, extension);
}

void checkShape(const std::string& path, const Image& image) {
    const std::size_t expected = std::size_t(image.width) * image.height * image.channels;
    if (image.width < 1 || image.height < 1 || image.channels < 1 || image.texels.size() != expected)
        fail(Failure::internal, "{}: a picture of {} x {} x {} cannot hold {} values", path, image.width, image.height,
             image.channels, image.texels.size());
}

void encode(const std::string& path, const Image& image, const ImageEncoding& encoding) {
    checkShape(path, image);
    const std::vector<unsigned char> encoded = imageModule().encodeImage(path, image, encoding);
    writeFile(path, {reinterpret_cast<const char*>(encoded.data()), encoded.size()});
}

} // namespace

void writeImage(const std::string& path, const Image& image, SampleType sample, const std::string& compression) {
    const std::string format = chooseFormat(path, sample);
    if (format != "png") return encode(path, image, {format, sample, {}, compression, {}});
    writeImage(path, image, sample, ImageAttributes());
}

void writeImage(const std::string& path, const Image& image, SampleType sample, const ImageAttributes& attributes) {
    const std::string format = chooseFormat(path, sample);
    if (format != "png") return encode(path, image, {format, sample, {}, "", attributes});
    checkShape(path, image);
    writeFile(path, encodePng(path, image, sample, attributes));
}

void writeImage(const std::string& path, const Image& image, const std::vector<ImageChannel>& channels,
                const ImageAttributes& attributes) {
    const std::string format = chooseFormat(path, SampleType::real);
    if (format != "openexr") fail(Failure::usage, "{}: channels of their own names are written as .exr", path);
    if (channels.size() != std::size_t(image.channels))
        fail(Failure::internal, "{}: {} names for {} channels", path, channels.size(), image.channels);
    encode(path, image, {format, SampleType::real, channels, "", attributes});
}

} // namespace relief
