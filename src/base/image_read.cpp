// Pictures in: OpenImageIO decodes, but which of its readers runs and how much memory it may take is decided here.
#include "base/base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <OpenImageIO/imageio.h>

namespace relief {

namespace {

using namespace std::string_view_literals;

constexpr int kMaxChannels = 1024;

struct Magic {
    std::string_view bytes;
    const char* format;
};

constexpr std::array kMagics = {
    Magic{"\x76\x2f\x31\x01"sv, "openexr"},
    Magic{"II*\0"sv, "tiff"},
    Magic{"MM\0*"sv, "tiff"},
    Magic{"II+\0"sv, "tiff"},
    Magic{"MM\0+"sv, "tiff"},
    Magic{"\x89PNG\r\n\x1a\n"sv, "png"},
    Magic{"#?RADIANCE"sv, "hdr"},
    Magic{"#?RGBE"sv, "hdr"},
    Magic{"\xff\xd8\xff"sv, "jpeg"},
};

std::string findFormat(const std::string& path) {
    std::array<char, 16> start{};
    const std::string_view bytes(start.data(), InputFile(path).read(0, start.data(), start.size()));
    for (const Magic& magic : kMagics)
        if (bytes.starts_with(magic.bytes)) return magic.format;
    fail(Failure::input, "{}: not a picture that can be read; use EXR, TIFF, PNG, HDR or JPEG", path);
}

/// OpenImageIO's message on one line. Fetching it also stops the library from printing it.
template <typename Source>
std::string reason(const Source& source) {
    std::string text = source.geterror();
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "no reason given" : text;
}

/// The libraries below call it a bad file, too, when there is no memory for it.
[[noreturn]] void failDamaged(const std::string& path, const std::string& format, const std::string& reason) {
    if (reason.find("memory") != std::string::npos || reason.find("bad_alloc") != std::string::npos)
        fail(Failure::device, "{}: no memory is left to read this picture: {}", path, reason);
    fail(Failure::input, "{}: damaged {} picture: {}", path, format, reason);
}

/// Throws unless the header's numbers are sane and within the limits; nothing has been allocated for them yet.
void checkSpec(const OIIO::ImageSpec& spec, const std::string& path, const ImageLimits& limits) {
    const auto isSide = [&](int side) { return side >= 1 && side <= limits.side; };
    if (!isSide(spec.width) || !isSide(spec.height))
        fail(Failure::input, "{}: the picture says it is {} x {} pixels; sides of 1 to {} are read", path, spec.width,
             spec.height, limits.side);
    if (spec.nchannels < 1 || spec.nchannels > kMaxChannels)
        fail(Failure::input, "{}: the picture says it has {} channels; 1 to {} are read", path, spec.nchannels,
             kMaxChannels);
    if (spec.deep || spec.depth != 1)
        fail(Failure::input, "{}: deep and volume pictures are not read; flatten it first", path);
    if (spec.tile_width < 0 || spec.tile_width > limits.side || spec.tile_height < 0 || spec.tile_height > limits.side)
        fail(Failure::input, "{}: the picture says its tiles are {} x {} pixels; up to {} are read", path,
             spec.tile_width, spec.tile_height, limits.side);
    const std::uint64_t pixels =
        std::max(std::uint64_t(spec.width) * spec.height, std::uint64_t(spec.tile_width) * spec.tile_height);
    const std::uint64_t bytes = pixels * spec.nchannels * spec.format.size();
    if (bytes > limits.decodedBytes)
        fail(Failure::input, "{}: the picture decodes to {}; up to {} are read", path, humanBytes(bytes),
             humanBytes(limits.decodedBytes));
}

// --- files that were cut: libjpeg fills them up with grey and calls it success, libpng prints to stderr ------------

/// True when the chunks (length, type, data, checksum) run to the end chunk.
bool pngHasEnd(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(8);
    std::array<unsigned char, 8> head{};
    while (file.read(reinterpret_cast<char*>(head.data()), head.size())) {
        const std::uint32_t length = std::uint32_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
        const bool isEnd = std::equal(head.begin() + 4, head.end(), "IEND");
        file.seekg(std::streamoff(length) + (isEnd ? 3 : 4), std::ios::cur);
        if (isEnd) return file.get() != std::ifstream::traits_type::eof(); // the last byte of its checksum
    }
    return false;
}

constexpr int kStartOfImage = 0xd8, kEndOfImage = 0xd9, kFirstRestart = 0xd0;

bool standsAlone(int marker) { return marker == 0x01 || (marker >= kFirstRestart && marker <= kStartOfImage); }

/// True when the picture's own end marker is there.
bool jpegHasEnd(const std::string& path) {
    const std::string bytes = readFile(path);
    const auto byteAt = [&](std::size_t i) { return int(static_cast<unsigned char>(bytes[i])); };
    // Segments carry their length (a thumbnail inside one has an end marker too, which must not count); between them
    // lies coded data, where 0xff is followed by 0 unless it begins a marker.
    for (std::size_t i = 0; i + 1 < bytes.size();) {
        const int marker = byteAt(i + 1);
        if (byteAt(i) != 0xff || marker == 0 || marker == 0xff) {
            ++i;
            continue;
        }
        if (marker == kEndOfImage) return true;
        i += 2;
        if (standsAlone(marker)) continue;
        if (i + 1 >= bytes.size()) return false;
        i += std::size_t(byteAt(i)) << 8 | std::size_t(byteAt(i + 1));
    }
    return false;
}

void checkEnd(const std::string& path, const std::string& format) {
    if ((format == "png" && !pngHasEnd(path)) || (format == "jpeg" && !jpegHasEnd(path)))
        fail(Failure::input, "{}: damaged {} picture: the file ends before the picture does", path, format);
}

// --- reading -----------------------------------------------------------------------------------------------------

struct OpenImage {
    std::unique_ptr<OIIO::ImageInput> input;
    std::string format;
    OIIO::ImageSpec spec;
};

OpenImage openImage(const std::string& path, const ImageLimits& limits) {
    OpenImage image{.input = nullptr, .format = findFormat(path), .spec = {}};
    checkEnd(path, image.format);
    image.input = OIIO::ImageInput::create(image.format);
    if (!image.input) fail(Failure::internal, "OpenImageIO has no {} reader: {}", image.format, OIIO::geterror());
    OIIO::ImageSpec asked;
    asked.attribute("oiio:UnassociatedAlpha", 1); // otherwise colours come multiplied by alpha: not the stored numbers
    asked.attribute("oiio:RawColor", 1);
    if (!image.input->open(path, image.spec, asked)) failDamaged(path, image.format, reason(*image.input));
    checkSpec(image.spec, path, limits);
    return image;
}

void checkChannel(int channel, const OIIO::ImageSpec& spec, const std::string& path) {
    if (channel >= spec.nchannels)
        fail(Failure::input, "{}: there is no channel {}; channels 0 to {} exist", path, channel, spec.nchannels - 1);
}

} // namespace

ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits) {
    const OpenImage image = openImage(path, limits);
    const OIIO::ImageSpec& spec = image.spec;
    image.input->close();
    return {.width = spec.width,
            .height = spec.height,
            .channels = spec.nchannels,
            .format = image.format,
            .sample = spec.format.c_str(),
            .sampleBytes = int(spec.format.size()),
            .isFloat = spec.format.is_floating_point(),
            .channelNames = spec.channelnames};
}

Image readImage(const std::string& path, int channel, const ImageLimits& limits) {
    const OpenImage source = openImage(path, limits);
    checkChannel(channel, source.spec, path);
    const int first = std::max(channel, 0);
    const int end = channel < 0 ? source.spec.nchannels : channel + 1;
    Image image{.width = source.spec.width, .height = source.spec.height, .channels = end - first, .texels = {}};
    image.texels.resize(std::size_t(image.width) * image.height * image.channels);
    const bool isRead = source.input->read_image(0, 0, first, end, OIIO::TypeFloat, image.texels.data());
    const bool isSilent = !source.input->has_error(); // the TIFF reader returns true for strips that it could not read
    const bool isClosed = source.input->close();
    if (!isRead || !isSilent || !isClosed) failDamaged(path, source.format, reason(*source.input));
    return image;
}

} // namespace relief
