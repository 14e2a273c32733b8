// Geometry images on disk: an EXR with channels X, Y, Z and NX, NY, NZ. Its header holds a version, how the border is
// sewn (segments per side, the first path's start, then segments and mate of each path) and, where positions are not in
// world units, their origin and unit.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "geometry_image/grid.h"

namespace relief {
namespace {

constexpr const char* kVersionAttribute = "relief:geometry_image";
constexpr const char* kSewingAttribute = "relief:sewing";
constexpr const char* kOriginAttribute = "relief:origin";
constexpr const char* kVersion = "1";
constexpr std::array<const char*, 6> kChannels{"X", "Y", "Z", "NX", "NY", "NZ"};

std::string textOf(const ImageInfo& info, const char* attribute) {
    const auto found = info.attributes.find(attribute);
    return found == info.attributes.end() ? std::string() : found->second;
}

/// The numbers of a text between blanks; empty where something else stands there.
template <typename Number>
std::vector<Number> numbersOf(const std::string& text) {
    std::vector<Number> numbers;
    const char *at = text.data(), *end = at + text.size();
    while (at != end) {
        if (*at == ' ') {
            ++at;
            continue;
        }
        Number number{};
        const auto [after, error] = std::from_chars(at, end, number);
        if (error != std::errc() || (after != end && *after != ' ')) return {};
        numbers.push_back(number);
        at = after;
    }
    return numbers;
}

std::string toText(const Sewing& sewing) {
    std::string text = fmt::format("{} {}", sewing.sideSegments, sewing.first);
    for (const Sewing::Path& path : sewing.paths) text += fmt::format(" {} {}", path.segments, path.mate);
    return text;
}

/// Empty where the text is no sewing of an image of that size.
std::optional<Sewing> parseSewing(const std::string& text, int size) {
    const std::vector<int> numbers = numbersOf<int>(text);
    if (numbers.size() < 4 || numbers.size() % 2 != 0) return {};
    Sewing sewing{.sideSegments = numbers[0], .first = numbers[1]};
    const int side = sewing.sideSegments;
    if (side < 1 || size < 2 || (size - 1) % side != 0 || !std::has_single_bit(unsigned((size - 1) / side))) return {};
    if (sewing.first < 0 || sewing.first >= side) return {};
    for (std::size_t i = 2; i < numbers.size(); i += 2) sewing.paths.push_back({numbers[i], numbers[i + 1]});
    std::int64_t sum = 0;
    for (std::size_t p = 0; p < sewing.paths.size(); ++p) {
        const Sewing::Path& path = sewing.paths[p];
        if (path.segments < 1 || path.mate < 0 || std::size_t(path.mate) >= sewing.paths.size()) return {};
        const Sewing::Path& mate = sewing.paths[std::size_t(path.mate)];
        if (std::size_t(mate.mate) != p || mate.segments != path.segments) return {};
        sum += path.segments;
    }
    if (sum != 4 * std::int64_t(side)) return {};
    return sewing;
}

/// Refuses samples that are sewn and differ: a picture that has been resized, filtered or painted.
void checkSewn(const GeometryImage& image, const std::string& path) {
    const SewnGrid grid = sewGrid(image, 0);
    for (std::size_t sample = 0; sample < grid.vertices.size(); ++sample) {
        const std::uint32_t first = grid.samples[grid.vertices[sample]];
        if (image.positions[sample] == image.positions[first] && image.normals[sample] == image.normals[first])
            continue;
        const auto size = std::size_t(image.size);
        fail(Failure::input,
             "{}: the samples in column {}, row {} and column {}, row {} (from 0, top left) are sewn together and "
             "differ; the picture has been changed since it was written",
             path, first % size, first / size, sample % size, sample / size);
    }
}

/// Coordinates in which the surface fills -1 ... 1, where halves are densest.
Coordinates unitBoxOf(const GeometryImage& image) {
    const Bounds box = image.coordinates.toWorld(computeBounds(image.positions));
    const double half = std::max(box.longestSide() / 2, kSmallestSide);
    return {.origin = box.center(), .unit = std::exp2(std::ceil(std::log2(half)))};
}

} // namespace

bool isGeometryImage(const ImageInfo& info) { return info.attributes.contains(kVersionAttribute); }

bool isGeometryImageFile(const std::string& path) {
    return lowerExtension(path) == ".exr" && isGeometryImage(readImageInfo(path));
}

GeometryImage readGeometryImageInfo(const ImageInfo& info, const std::string& name) {
    // What kind of picture it is.
    if (!isGeometryImage(info))
        fail(Failure::input, "{}: this picture is no geometry image; relief geometry-image writes one", name);
    if (const std::string version = textOf(info, kVersionAttribute); version != kVersion)
        fail(Failure::input, "{}: a geometry image of version {}; this program reads version {}", name,
             onOneLine(version), kVersion);
    for (const char* channel : kChannels)
        if (std::ranges::find(info.channelNames, channel) == info.channelNames.end())
            fail(Failure::input, "{}: a geometry image has the channels X, Y, Z, NX, NY and NZ; {} is missing", name,
                 channel);
    if (info.width != info.height || info.width < 2 || info.width > kLargestGeometryImage)
        fail(Failure::input, "{}: a geometry image is a square of 2 to {} samples per side, not {} x {}", name,
             kLargestGeometryImage, info.width, info.height);
    // How its border is sewn.
    GeometryImage image{.size = info.width};
    const std::optional<Sewing> sewing = parseSewing(textOf(info, kSewingAttribute), image.size);
    if (!sewing)
        fail(Failure::input,
             "{}: its header does not say how a border of {} samples per side is sewn; it has been resized "
             "or cut",
             name, image.size);
    image.sewing = *sewing;
    // Where its positions lie.
    if (const std::string origin = textOf(info, kOriginAttribute); !origin.empty()) {
        const std::vector<double> numbers = numbersOf<double>(origin);
        const bool isGood = numbers.size() == 4 && numbers[3] >= kSmallestSide &&
                            std::ranges::all_of(numbers, [](double x) { return std::abs(x) <= kFarthestCoordinate; });
        if (!isGood)
            fail(Failure::input, "{}: its header does not say where its positions lie: '{}'", name, onOneLine(origin));
        image.coordinates = {.origin = {numbers[0], numbers[1], numbers[2]}, .unit = numbers[3]};
    }
    return image;
}

GeometryImage readGeometryImage(const std::string& path) {
    const ImageInfo info = readImageInfo(path);
    GeometryImage image = readGeometryImageInfo(info, path);
    const Image picture = readImage(path);
    if (const std::optional<BadTexel> bad = findNotFinite(picture))
        fail(Failure::input, "{}: the sample in column {}, row {} (from 0, top left) is {}", path, bad->x, bad->y,
             bad->value);
    std::array<std::size_t, 6> numbers{};
    for (std::size_t c = 0; c < kChannels.size(); ++c)
        numbers[c] = std::size_t(std::ranges::find(info.channelNames, kChannels[c]) - info.channelNames.begin());
    const auto channels = std::size_t(picture.channels), count = std::size_t(image.size) * std::size_t(image.size);
    for (std::size_t i = 0; i < count; ++i) {
        const float* texel = &picture.texels[i * channels];
        image.positions.emplace_back(texel[numbers[0]], texel[numbers[1]], texel[numbers[2]]);
        image.normals.emplace_back(texel[numbers[3]], texel[numbers[4]], texel[numbers[5]]);
    }
    checkSewn(image, path);
    return image;
}

GeometryImage roundSamples(const GeometryImage& image, SampleType sample) {
    GeometryImage rounded = image;
    if (sample != SampleType::half) return rounded;
    rounded.coordinates = unitBoxOf(image);
    const auto round = [](const vec3& v) {
        return vec3(glm::unpackHalf1x16(glm::packHalf1x16(v.x)), glm::unpackHalf1x16(glm::packHalf1x16(v.y)),
                    glm::unpackHalf1x16(glm::packHalf1x16(v.z)));
    };
    for (vec3& p : rounded.positions) p = round(vec3(rounded.coordinates.toLocal(image.coordinates.toWorld(dvec3(p)))));
    for (vec3& n : rounded.normals) n = round(n);
    return rounded;
}

void writeGeometryImage(const std::string& path, const GeometryImage& source, SampleType sample) {
    if (lowerExtension(path) != ".exr") fail(Failure::usage, "{}: a geometry image is written as .exr", path);
    const GeometryImage image = roundSamples(source, sample);
    Image picture{.width = image.size, .height = image.size, .channels = int(kChannels.size()), .texels = {}};
    picture.texels.reserve(6 * image.positions.size());
    for (std::size_t i = 0; i < image.positions.size(); ++i) {
        const vec3 &p = image.positions[i], &n = image.normals[i];
        picture.texels.insert(picture.texels.end(), {p.x, p.y, p.z, n.x, n.y, n.z});
    }
    ImageAttributes attributes{{kVersionAttribute, kVersion}, {kSewingAttribute, toText(image.sewing)}};
    const dvec3& origin = image.coordinates.origin;
    if (!image.coordinates.isIdentity())
        attributes[kOriginAttribute] = fmt::format("{} {} {} {}", origin.x, origin.y, origin.z, image.coordinates.unit);
    std::vector<ImageChannel> channels;
    channels.reserve(std::size(kChannels));
    for (const char* name : kChannels) channels.push_back({name, sample});
    writeImage(path, picture, channels, attributes);
}

} // namespace relief
