// Uncompressed TIFFs of one channel by hand, as elevation models are written: any sample type, GDAL_NODATA, either byte
// order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace relief::test {

struct TiffDesc {
    int width = 0, height = 0;
    int sampleFormat = 1; ///< 1 unsigned, 2 signed, 3 real
    std::string noData;   ///< "": no such tag
    bool isBigEndian = false;
    bool hasDirectoryLast = false;
    int pageCount = 1; ///< the same pixels again
};

/// The bytes of a number in the file's order.
template <typename T>
std::string bytesOf(T value, bool isBigEndian) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (isBigEndian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// Samples are of type T, row after row.
template <typename T>
std::string tiffOf(const TiffDesc& desc, const std::vector<T>& samples) {
    std::string pixels;
    pixels.assign(reinterpret_cast<const char*>(samples.data()), samples.size() * sizeof(T));
    if (desc.isBigEndian)
        for (std::size_t at = 0; at < pixels.size(); at += sizeof(T))
            std::reverse(pixels.begin() + long(at), pixels.begin() + long(at + sizeof(T)));
    const std::string text = desc.noData.empty() ? "" : desc.noData + std::string(1, '\0');
    const auto entryCount = std::uint16_t(text.empty() ? 10 : 11);
    const auto directoryBytes = std::uint32_t(2 + 12 * entryCount + 4);
    const auto pixelBytes = std::uint32_t(pixels.size()), textBytes = std::uint32_t((text.size() + 3) / 4 * 4);
    const std::uint32_t head = 8, textAt = head,
                        pixelsAt = desc.hasDirectoryLast ? textAt + textBytes
                                                         : textAt + textBytes + desc.pageCount * directoryBytes;
    const std::uint32_t firstDirectory = desc.hasDirectoryLast ? pixelsAt + pixelBytes : textAt + textBytes;

    const auto number16 = [&](std::uint16_t value) { return bytesOf(value, desc.isBigEndian); };
    const auto number32 = [&](std::uint32_t value) { return bytesOf(value, desc.isBigEndian); };
    std::string directories;
    for (int page = 0; page < desc.pageCount; ++page) {
        std::string entries;
        const auto add = [&](std::uint16_t tag, std::uint32_t value, std::uint16_t type = 4, std::uint32_t count = 1) {
            const bool isShort = type == 3;
            entries += number16(tag) + number16(type) + number32(count) +
                       (isShort ? number16(std::uint16_t(value)) + std::string(2, '\0') : number32(value));
        };
        add(256, std::uint32_t(desc.width)), add(257, std::uint32_t(desc.height));
        add(258, 8 * sizeof(T), 3), add(259, 1, 3), add(262, 1, 3);
        add(273, pixelsAt), add(277, 1, 3), add(278, std::uint32_t(desc.height)), add(279, pixelBytes);
        add(339, std::uint32_t(desc.sampleFormat), 3);
        if (text.size() > 4) add(42113, textAt, 2, std::uint32_t(text.size()));
        if (!text.empty() && text.size() <= 4) // short values stand in the entry itself
            entries += number16(42113) + number16(2) + number32(std::uint32_t(text.size())) + text +
                       std::string(4 - text.size(), '\0');
        const bool isLast = page + 1 == desc.pageCount;
        directories += number16(entryCount) + entries +
                       number32(isLast ? 0 : firstDirectory + std::uint32_t(page + 1) * directoryBytes);
    }
    const std::string start = (desc.isBigEndian ? "MM" : "II") + number16(42) + number32(firstDirectory);
    const std::string padded = text + std::string(textBytes - text.size(), '\0');
    return start + padded + (desc.hasDirectoryLast ? pixels + directories : directories + pixels);
}

} // namespace relief::test
