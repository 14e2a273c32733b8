// Reading pictures: OpenImageIO decodes them, but this file decides which of its readers is used and how much memory it
// may take.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fcntl.h>
#include <unistd.h>

#include "base/base.h"
#include "base/picture_facts.h"
#include "base/pictures/module.h"
#include "base/tiff_directory.h"

namespace relief::pictures {

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

/// Whether the name stands for one picture per tile of texture coordinates, as renderers write it.
bool namesTiles(const std::string& path) {
    std::string name = path;
    std::ranges::transform(name, name.begin(), [](unsigned char letter) { return char(std::tolower(letter)); });
    const auto has = [&](std::string_view token) { return name.find(token) != std::string::npos; };
    return has("<udim>") || has("%(udim)d") || has("<uvtile>");
}

/// The file of a picture. Throws for a name that stands for several.
PictureBytes bytesOfFile(const std::string& path) {
    if (namesTiles(path) && !std::filesystem::exists(path))
        fail(Failure::usage,
             "{}: a set of tiles is of maps over texture coordinates, not of single pictures; name the picture of one "
             "tile",
             path);
    return PictureBytes(path);
}

std::string findFormat(const std::string& path, const PictureBytes& picture) {
    std::array<char, 16> start{};
    const std::string_view bytes(start.data(), picture.read(0, start.data(), start.size()));
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

/// Throws for a file that was cut.
void checkEnd(const std::string& path, const PictureBytes& picture, const std::string& format) {
    const bool isWhole = format == "png"    ? readPngFacts(picture).isWhole
                         : format == "jpeg" ? jpegHasEnd(picture)
                         : format == "tiff" ? readTiffFacts(path).isWhole
                                            : true;
    if (!isWhole) fail(Failure::input, "{}: damaged {} picture: the file ends before the picture does", path, format);
}

// --- reading -----------------------------------------------------------------------------------------------------

/// Until its end nothing goes to stderr: libpng prints a line of its own for damaged files, and OpenImageIO 2.4 offers
/// no way to stop it (the reason comes back by geterror() all the same). The other libraries are silent.
class SilentStderr {
public:
    explicit SilentStderr(bool isWanted) : kept_(isWanted ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3) : -1) {
        if (kept_ < 0) return;
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (nowhere < 0) return;
        dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    SilentStderr(const SilentStderr&) = delete;
    SilentStderr& operator=(const SilentStderr&) = delete;
    ~SilentStderr() {
        if (kept_ < 0) return;
        dup2(kept_, STDERR_FILENO);
        close(kept_);
    }

private:
    int kept_;
};

/// Throws what the library says: that it cannot read such a file, or that the file is damaged.
[[noreturn]] void failToDecode(const std::string& path, const std::string& format, const std::string& why) {
    // The libraries below call it a bad file, too, when there is no memory for it.
    if (why.find("memory") != std::string::npos || why.find("bad_alloc") != std::string::npos)
        fail(Failure::device, "{}: no memory is left to read this picture: {}", path, why);
    for (const std::string_view word : {"upport", "nimplemented", "Sorry", "sorry"})
        if (why.find(word) != std::string::npos)
            fail(Failure::input, "{}: this kind of {} picture is not supported: {}", path, format, why);
    fail(Failure::input, "{}: damaged {} picture: {}", path, format, why);
}

struct OpenImage {
    std::string path;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory; ///< of a picture that is no file; `input` reads it
    std::unique_ptr<OIIO::ImageInput> input;
    std::string format;
    OIIO::ImageSpec spec; ///< of its part
    int part = 0;
};

/// Lets the reader take the bytes in memory. Only readers that are known to do so get any.
void readFromMemory(OpenImage& image, const PictureBytes& picture) {
    if (image.format != "png" && image.format != "jpeg")
        fail(Failure::input, "{}: a picture inside of another file is PNG or JPEG, this one is {}", image.path,
             image.format);
    const std::span<const unsigned char> bytes = picture.inMemory();
    image.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
    if (!image.input->set_ioproxy(image.memory.get()))
        fail(Failure::internal, "OpenImageIO has no {} reader of memory: {}", image.format, reason(*image.input));
}

/// `path` stands for the picture in messages where it is no file.
OpenImage openImage(const std::string& path, const PictureBytes& picture, const ImageLimits& limits, int part = 0) {
    OpenImage image{.path = path, .format = findFormat(path, picture), .part = part};
    checkEnd(path, picture, image.format);
    const SilentStderr silence(image.format == "png");
    image.input = OIIO::ImageInput::create(image.format);
    if (!image.input) fail(Failure::internal, "OpenImageIO has no {} reader: {}", image.format, OIIO::geterror());
    if (!picture.isFile()) readFromMemory(image, picture);
    OIIO::ImageSpec asked;
    asked.attribute("oiio:UnassociatedAlpha", 1); // otherwise colours come multiplied by alpha: not the stored numbers
    asked.attribute("oiio:RawColor", 1);
    if (!image.input->open(path, image.spec, asked)) failToDecode(path, image.format, reason(*image.input));
    if (part > 0) {
        if (!image.input->seek_subimage(part, 0)) failToDecode(path, image.format, reason(*image.input));
        image.spec = image.input->spec();
    }
    checkSpec(image.spec, path, limits);
    return image;
}

void checkChannel(int channel, const OIIO::ImageSpec& spec, const std::string& path) {
    if (channel >= spec.nchannels)
        fail(Failure::input, "{}: there is no channel {}; channels 0 to {} exist", path, channel, spec.nchannels - 1);
}

bool isSignedInteger(const OIIO::TypeDesc& type) {
    return type.basetype == OIIO::TypeDesc::INT8 || type.basetype == OIIO::TypeDesc::INT16 ||
           type.basetype == OIIO::TypeDesc::INT32 || type.basetype == OIIO::TypeDesc::INT64;
}

template <typename T>
void convert(const std::vector<char>& from, std::vector<float>& to) {
    constexpr double kMost = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < to.size(); ++i) {
        T value;
        std::memcpy(&value, &from[i * sizeof(T)], sizeof(T));
        const auto number = double(value); // a double past the range of floats is not infinite
        to[i] = std::isfinite(number) ? float(std::clamp(number, -kMost, kMost)) : float(number);
    }
}

/// Types that OpenImageIO's own conversion would scale to -1..1 or make infinite.
void convertNumbers(const OIIO::TypeDesc& type, const std::vector<char>& from, std::vector<float>& to) {
    switch (type.basetype) {
    case OIIO::TypeDesc::INT8: return convert<std::int8_t>(from, to);
    case OIIO::TypeDesc::INT16: return convert<std::int16_t>(from, to);
    case OIIO::TypeDesc::INT32: return convert<std::int32_t>(from, to);
    case OIIO::TypeDesc::INT64: return convert<std::int64_t>(from, to);
    default: return convert<double>(from, to);
    }
}

/// Rows of one strip: whole rows of tiles, about 16 MB.
int stripHeight(const OIIO::ImageSpec& spec, int channels) {
    constexpr std::uint64_t kStripBytes = 1 << 24;
    const std::uint64_t rowBytes = std::uint64_t(spec.width) * std::uint64_t(channels) * sizeof(float);
    const int rows = int(std::clamp<std::uint64_t>(kStripBytes / rowBytes, 1, 256));
    return spec.tile_height > 0 ? std::max(rows / spec.tile_height, 1) * spec.tile_height : rows;
}

/// Channels from `first` to before `end`, rows from `y` to before `y + count`, as samples of `type` at `target`.
struct Strip {
    int first = 0, end = 0, y = 0, count = 0;
};
void readStrip(const OpenImage& source, const Strip& strip, const OIIO::TypeDesc& type, void* target) {
    const OIIO::ImageSpec& spec = source.spec;
    OIIO::ImageInput& input = *source.input;
    const int top = spec.y + strip.y, bottom = top + strip.count;
    const SilentStderr silence(source.format == "png");
    const bool isRead =
        spec.tile_height > 0
            ? input.read_tiles(source.part, 0, spec.x, spec.x + spec.width, top, bottom, spec.z, spec.z + 1,
                               strip.first, strip.end, type, target)
            : input.read_scanlines(source.part, 0, top, bottom, spec.z, strip.first, strip.end, type, target);
    // The TIFF reader returns true for strips that it could not read.
    if (!isRead || input.has_error()) failToDecode(source.path, source.format, reason(input));
}

/// Reads a strip of samples that convertNumbers turns into floats. `stored` is kept for the next one.
void readNumbers(const OpenImage& source, const Strip& strip, std::vector<char>& stored, std::vector<float>& texels) {
    const OIIO::TypeDesc type = source.spec.format;
    stored.resize(texels.size() * type.size());
    readStrip(source, strip, type, stored.data());
    convertNumbers(type, stored, texels);
}

// OpenImageIO 2.4 does not read doubles in uncompressed tiles and very small strips of a TIFF: its buffer comes back as
// the memory was, often zeros, and there is no error.

bool isTiffOfDoubles(const OpenImage& source) {
    return source.format == "tiff" && source.spec.format == OIIO::TypeDesc::DOUBLE;
}

[[noreturn]] void failAtDoubles(const OpenImage& source) {
    failToDecode(
        source.path, source.format,
        "its 64-bit samples are not those of the file, as with some that are not supported; store 32-bit ones");
}

/// `stored`: what the library gave for the first rows from the first channel on.
void checkFirstDouble(const OpenImage& source, std::span<const char> stored) {
    if (!isTiffOfDoubles(source) || source.part > 0) return;
    const std::optional<double> first = readTiffFacts(source.path).first;
    double given = 0;
    std::memcpy(&given, stored.data(), sizeof(given));
    const bool isSame = !first || given == *first || (std::isnan(given) && std::isnan(*first));
    if (!isSame) failAtDoubles(source);
}

/// Gives `take` the channels from `first` to before `end`, strip by strip.
void readRows(const OpenImage& source, int first, int end, const TakeRows& take) {
    const OIIO::ImageSpec& spec = source.spec;
    const bool isConverted = isSignedInteger(spec.format) || spec.format == OIIO::TypeDesc::DOUBLE;
    const int step = stripHeight(spec, end - first);
    std::vector<float> texels;
    std::vector<char> stored;
    bool isBlank = isTiffOfDoubles(source);
    for (Strip strip{first, end}; strip.y < spec.height; strip.y += strip.count) {
        strip.count = std::min(step, spec.height - strip.y);
        texels.resize(std::size_t(strip.count) * std::size_t(spec.width) * std::size_t(end - first));
        if (isConverted)
            readNumbers(source, strip, stored, texels);
        else
            readStrip(source, strip, OIIO::TypeFloat, texels.data());
        if (strip.y == 0 && first == 0) checkFirstDouble(source, stored);
        isBlank = isBlank && std::ranges::all_of(texels, [](float texel) { return texel == 0; });
        take(strip.y, strip.count, texels);
    }
    if (isBlank) failAtDoubles(source);
    if (!source.input->close()) failToDecode(source.path, source.format, reason(*source.input));
}

/// The first part and those that hold a picture of the same size. Smaller pages of a TIFF are previews of the first.
std::vector<ImagePart> partsOf(const OpenImage& image) {
    constexpr int kMostParts = 1024, kMask = 4;
    std::vector<ImagePart> parts;
    const bool hasParts = image.format == "openexr" || image.format == "tiff";
    for (int part = 0; part < kMostParts && (part == 0 || hasParts); ++part) {
        if (part > 0 && !image.input->seek_subimage(part, 0)) break;
        const OIIO::ImageSpec spec = image.input->spec();
        const bool isPicture = spec.width == image.spec.width && spec.height == image.spec.height &&
                               spec.get_int_attribute("tiff:PhotometricInterpretation") != kMask;
        if (part > 0 && !isPicture && image.format == "tiff") break;
        parts.push_back({.name = std::string(spec.get_string_attribute("oiio:subimagename", std::to_string(part))),
                         .channelNames = spec.channelnames});
    }
    image.input->geterror(); // that there is no further part is no fault
    return parts;
}

/// The color profile that a TIFF or JPEG carries.
std::string profileOf(const OIIO::ImageSpec& spec) {
    if (spec.find_attribute("ICCProfile") == nullptr) return "";
    return fmt::format("ICC profile {}",
                       std::string(spec.get_string_attribute("ICCProfile:profile_description", "without a name")));
}

ImageAttributes attributesOf(const OIIO::ImageSpec& spec) {
    ImageAttributes attributes = splitAttributes(std::string(spec.get_string_attribute(kTiffDescription)));
    for (const OIIO::ParamValue& value : spec.extra_attribs)
        if (value.type() == OIIO::TypeString && std::string_view(value.name().string()).starts_with(kAttributePrefix))
            attributes[value.name().string()] = value.get_string();
    return attributes;
}

Image readChannels(const OpenImage& source, int first, int end) {
    Image image{.width = source.spec.width, .height = source.spec.height, .channels = end - first, .texels = {}};
    image.texels.reserve(std::size_t(image.width) * image.height * image.channels);
    readRows(source, first, end, [&](int, int, std::span<const float> rows) {
        image.texels.insert(image.texels.end(), rows.begin(), rows.end());
    });
    return image;
}

} // namespace

ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits) {
    const PictureBytes picture = bytesOfFile(path);
    const OpenImage image = openImage(path, picture, limits);
    const OIIO::ImageSpec& spec = image.spec;
    std::vector<ImagePart> parts = partsOf(image);
    image.input->close();
    const PngFacts png = image.format == "png" ? readPngFacts(picture) : PngFacts();
    return {.width = spec.width,
            .height = spec.height,
            .channels = spec.nchannels,
            .format = image.format,
            .sample = spec.format.c_str(),
            .sampleBytes = int(spec.format.size()),
            .isFloat = spec.format.is_floating_point(),
            .isSigned = isSignedInteger(spec.format),
            .noData = image.format == "tiff" ? readTiffFacts(path).noData : png.noData,
            .colorTag = image.format == "png" ? png.colorTag : profileOf(spec),
            .channelNames = spec.channelnames,
            .parts = std::move(parts),
            .attributes = attributesOf(spec)};
}

Image readImage(const std::string& path, int channel, const ImageLimits& limits, int part) {
    const OpenImage source = openImage(path, bytesOfFile(path), limits, part);
    checkChannel(channel, source.spec, path);
    return readChannels(source, std::max(channel, 0), channel < 0 ? source.spec.nchannels : channel + 1);
}

Image decodeImage(std::span<const unsigned char> bytes, const std::string& name, const ImageLimits& limits) {
    const OpenImage source = openImage(name, PictureBytes(bytes), limits);
    return readChannels(source, 0, source.spec.nchannels);
}

void readImageRows(const std::string& path, const TakeRows& take, const ImageLimits& limits) {
    const OpenImage source = openImage(path, bytesOfFile(path), limits);
    readRows(source, 0, source.spec.nchannels, take);
}

} // namespace relief::pictures
