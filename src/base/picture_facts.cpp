#include "base/picture_facts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

namespace relief {

namespace {

using namespace std::string_view_literals;

std::uint32_t bigEndianAt(std::span<const unsigned char> bytes) {
    return std::uint32_t(bytes[0]) << 24 | std::uint32_t(bytes[1]) << 16 | std::uint32_t(bytes[2]) << 8 | bytes[3];
}

/// What the data of a chunk says of color; "" where it says nothing.
std::string colorTagOf(std::string_view type, const PictureBytes& picture, std::uint64_t offset, std::uint64_t length) {
    constexpr std::uint32_t kLinear = 100000; // of gAMA: 1, times 100000
    std::array<unsigned char, 80> data{};     // a profile's name has up to 79 bytes
    picture.read(offset, data.data(), std::min<std::uint64_t>(length, data.size() - 1));
    if (type == "sRGB"sv) return "sRGB";
    if (type == "iCCP"sv) return fmt::format("ICC profile {}", reinterpret_cast<const char*>(data.data()));
    if (type != "gAMA"sv || length != 4) return "";
    const std::uint32_t gamma = bigEndianAt(data);
    return gamma == kLinear || gamma == 0 ? "" : fmt::format("gamma {:.2g}", double(kLinear) / gamma);
}

/// The grey that a tRNS chunk names, of samples of up to 8 bits from 0 to 255; empty where the picture is no grey one.
std::optional<double> transparentGrey(std::span<const unsigned char> header, std::span<const unsigned char> data) {
    constexpr unsigned kGrey = 0;
    const unsigned bits = header[8], kind = header[9]; // after width and height (section 11.2.1)
    if (kind != kGrey || bits == 0 || bits > 16 || data.size() != 2) return {};
    const unsigned grey = unsigned(data[0]) << 8 | data[1];
    return bits < 8 ? grey * 255.0 / ((1u << bits) - 1) : grey;
}

constexpr int kStartOfImage = 0xd8, kEndOfImage = 0xd9, kFirstRestart = 0xd0;

bool standsAlone(int marker) { return marker == 0x01 || (marker >= kFirstRestart && marker <= kStartOfImage); }

} // namespace

std::size_t PictureBytes::read(std::uint64_t offset, void* target, std::size_t count) const {
    if (file_) return file_->read(offset, target, count);
    if (offset >= bytes_.size()) return 0;
    const std::size_t found = std::min<std::size_t>(count, bytes_.size() - offset);
    std::memcpy(target, bytes_.data() + offset, found);
    return found;
}

std::string PictureBytes::readAll() const {
    if (file_) return readFile(file_->path());
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
}

PngFacts readPngFacts(const PictureBytes& picture) {
    PngFacts facts;
    std::uint64_t at = 8;
    std::array<unsigned char, 13> header{};
    std::array<unsigned char, 8> head{}; // of a chunk: length and type; data and a checksum follow
    while (picture.read(at, head.data(), head.size()) == head.size()) {
        const std::uint64_t length = bigEndianAt(head), end = at + head.size() + length + 4;
        const std::string_view type(reinterpret_cast<const char*>(&head[4]), 4);
        if (type == "IEND"sv) {
            facts.isWhole = end <= picture.size();
            break;
        }
        if (type == "IHDR"sv && length == header.size()) picture.read(at + head.size(), header.data(), length);
        if (type == "tRNS"sv) {
            std::array<unsigned char, 2> grey{};
            picture.read(at + head.size(), grey.data(), grey.size());
            facts.noData = transparentGrey(header, std::span(grey).first(length == grey.size() ? length : 0));
        }
        // sRGB overrides a profile, and both the gamma for older readers (section 4.3).
        const std::string tag = colorTagOf(type, picture, at + head.size(), length);
        if (!tag.empty() && (facts.colorTag.empty() || type != "gAMA"sv)) facts.colorTag = tag;
        at = end;
    }
    return facts;
}

bool jpegHasEnd(const PictureBytes& picture) {
    const std::string bytes = picture.readAll();
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

} // namespace relief
