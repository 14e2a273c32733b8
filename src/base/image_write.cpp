// Writing pictures, whole or not at all.
#include "base/base.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace relief {

namespace {

OIIO::TypeDesc sampleDesc(SampleType sample) {
    switch (sample) {
    case SampleType::uint8: return OIIO::TypeDesc::UINT8;
    case SampleType::uint16: return OIIO::TypeDesc::UINT16;
    case SampleType::half: return OIIO::TypeDesc::HALF;
    case SampleType::real: return OIIO::TypeDesc::FLOAT;
    }
    fail(Failure::internal, "sample type {} does not exist", int(sample));
}

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

/// The nearest codes, halves upwards; what is below 0 or no number becomes 0, what is above 1 the largest code.
template <typename Code>
bool writeCodes(OIIO::ImageOutput& output, OIIO::TypeDesc type, const std::vector<float>& texels) {
    constexpr auto kLargest = float(std::numeric_limits<Code>::max());
    std::vector<Code> codes(texels.size());
    std::transform(texels.begin(), texels.end(), codes.begin(),
                   [](float x) { return x > 0 ? Code(std::floor(kLargest * std::min(x, 1.0f) + 0.5f)) : Code(0); });
    return output.write_image(type, codes.data());
}

/// Integers are rounded here, so that a picture is the same file with every build of OpenImageIO.
bool writeTexels(OIIO::ImageOutput& output, const Image& image) {
    const OIIO::TypeDesc sample = output.spec().format;
    if (sample == OIIO::TypeDesc::UINT8) return writeCodes<std::uint8_t>(output, sample, image.texels);
    if (sample == OIIO::TypeDesc::UINT16) return writeCodes<std::uint16_t>(output, sample, image.texels);
    return output.write_image(OIIO::TypeFloat, image.texels.data());
}

void encode(const std::string& path, const Image& image, const std::string& format, OIIO::ImageSpec spec) {
    checkShape(path, image);
    spec.attribute("DateTime", "2000:01:01 00:00:00"); // else the hour of writing: equal pictures must be equal files
    spec.attribute("oiio:UnassociatedAlpha", 1);       // otherwise colours are divided by alpha on the way out
    spec.attribute("tiff:write_exif", 0);              // it would be read back, and memory output cannot be read

    // Into memory first: the PNG writer does not notice a full disk, TIFF and EXR miss their last block.
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output || !output->supports("ioproxy") || !output->set_ioproxy(&memory))
        fail(Failure::internal, "OpenImageIO has no {} writer into memory: {}", format, OIIO::geterror());
    const bool isWritten = output->open(path, spec) && writeTexels(*output, image);
    if (!output->close() || !isWritten || output->has_error())
        fail(Failure::file, "{}: cannot be written as {}: {}", path, format, output->geterror());
    writeFile(path, {reinterpret_cast<const char*>(encoded.data()), encoded.size()});
}

} // namespace

void writeImage(const std::string& path, const Image& image, SampleType sample) {
    encode(path, image, chooseFormat(path, sample),
           OIIO::ImageSpec(image.width, image.height, image.channels, sampleDesc(sample)));
}

void writeImage(const std::string& path, const Image& image, const std::vector<ImageChannel>& channels) {
    const std::string format = chooseFormat(path, SampleType::real);
    if (format != "openexr") fail(Failure::usage, "{}: channels of their own names are written as .exr", path);
    if (channels.size() != std::size_t(image.channels))
        fail(Failure::internal, "{}: {} names for {} channels", path, channels.size(), image.channels);
    OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const ImageChannel& channel : channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(sampleDesc(channel.sample));
    }
    encode(path, image, format, spec);
}

} // namespace relief
