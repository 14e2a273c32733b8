// Encoding pictures: TIFF and EXR.
#include <algorithm>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/base.h"
#include "base/codes.h"
#include "base/pictures/module.h"

namespace relief::pictures {

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

template <typename Code>
bool writeCodes(OIIO::ImageOutput& output, OIIO::TypeDesc type, const std::vector<float>& texels) {
    std::vector<Code> codes(texels.size());
    std::transform(texels.begin(), texels.end(), codes.begin(), toCode<Code>);
    return output.write_image(type, codes.data());
}

/// Integers are rounded here, so that a picture is the same file with every build of OpenImageIO.
bool writeTexels(OIIO::ImageOutput& output, const Image& image) {
    const OIIO::TypeDesc sample = output.spec().format;
    if (sample == OIIO::TypeDesc::UINT8) return writeCodes<std::uint8_t>(output, sample, image.texels);
    if (sample == OIIO::TypeDesc::UINT16) return writeCodes<std::uint16_t>(output, sample, image.texels);
    return output.write_image(OIIO::TypeFloat, image.texels.data());
}

OIIO::ImageSpec makeSpec(const Image& image, const ImageEncoding& encoding) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, sampleDesc(encoding.sample));
    if (!encoding.channels.empty()) spec.channelnames.clear();
    for (const ImageChannel& channel : encoding.channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(sampleDesc(channel.sample));
    }
    if (!encoding.compression.empty()) spec.attribute("compression", encoding.compression);
    const bool hasNames = encoding.format != "tiff";
    for (const auto& [name, text] : encoding.attributes)
        if (hasNames) spec.attribute(name, text);
    if (!hasNames && !encoding.attributes.empty())
        spec.attribute(kTiffDescription, joinAttributes(encoding.attributes));
    spec.attribute("DateTime", "2000:01:01 00:00:00"); // else the hour of writing: equal pictures must be equal files
    spec.attribute("oiio:UnassociatedAlpha", 1);       // otherwise colours are divided by alpha on the way out
    spec.attribute("tiff:write_exif", 0);              // it would be read back, and memory output cannot be read
    return spec;
}

} // namespace

std::vector<unsigned char> encodeImage(const std::string& path, const Image& image, const ImageEncoding& encoding) {
    // Into memory first: TIFF and EXR do not notice that a full disk misses their last block.
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(encoding.format);
    if (!output || !output->supports("ioproxy") || !output->set_ioproxy(&memory))
        fail(Failure::internal, "OpenImageIO has no {} writer into memory: {}", encoding.format, OIIO::geterror());
    const bool isWritten = output->open(path, makeSpec(image, encoding)) && writeTexels(*output, image);
    if (!output->close() || !isWritten || output->has_error())
        fail(Failure::file, "{}: cannot be written as {}: {}", path, encoding.format, output->geterror());
    return encoded;
}

} // namespace relief::pictures
