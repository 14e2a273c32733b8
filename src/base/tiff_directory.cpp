#include "base/tiff_directory.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <vector>

#include "base/base.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostEntries = 1 << 24; ///< of one array of offsets; pages have a few thousand
constexpr std::size_t kMostPages = 4096;

/// Bytes of one value of each type (0: no such type).
constexpr std::array<std::uint64_t, 19> kTypeBytes = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};

enum Tag : std::uint64_t {
    kBitsPerSample = 258,
    kCompression = 259,
    kStripOffsets = 273,
    kStripByteCounts = 279,
    kTileOffsets = 324,
    kTileByteCounts = 325,
    kGdalNoData = 42113
};

constexpr std::uint64_t kNotCompressed = 1; ///< of tag Compression

struct Entry {
    std::uint64_t tag = 0, type = 0, count = 0, at = 0; ///< `at`: where its values lie in the file
};

class TiffReader {
public:
    explicit TiffReader(const std::string& path) : file_(path), size_(file_.size()) {
        isBigEndian_ = bytes(0, 1) == "M";
        isBig_ = number(2, 2) == 43;
    }

    TiffFacts read() {
        std::set<std::uint64_t> seen; // directories may form a ring
        std::uint64_t at = isBig_ ? number(8, 8) : number(4, 4);
        while (at != 0 && facts_.isWhole && seen.size() < kMostPages && seen.insert(at).second)
            at = readDirectory(at, seen.size() == 1);
        return facts_;
    }

private:
    /// Bytes that lie in the file; else the file counts as cut.
    std::string bytes(std::uint64_t at, std::uint64_t count) {
        if (!isInside(at, count)) return "";
        std::string result(count, '\0');
        if (file_.read(at, result.data(), count) != count) facts_.isWhole = false;
        return result;
    }

    std::uint64_t number(std::uint64_t at, std::uint64_t count) { return valueOf(bytes(at, count)); }

    [[nodiscard]] std::uint64_t valueOf(std::string_view digits) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < digits.size(); ++i) {
            const std::size_t place = isBigEndian_ ? digits.size() - 1 - i : i;
            value |= std::uint64_t(static_cast<unsigned char>(digits[i])) << (8 * place);
        }
        return value;
    }

    bool isInside(std::uint64_t at, std::uint64_t count) {
        const bool isIn = count <= size_ && at <= size_ - count;
        facts_.isWhole = facts_.isWhole && isIn;
        return isIn;
    }

    std::vector<std::uint64_t> numbers(const Entry& entry) {
        std::vector<std::uint64_t> values;
        if (entry.count > kMostEntries) return values;
        const std::uint64_t width = kTypeBytes[entry.type];
        const std::string all = bytes(entry.at, entry.count * width);
        for (std::size_t at = 0; at < all.size(); at += width)
            values.push_back(valueOf(std::string_view(all).substr(at, width)));
        return values;
    }

    std::uint64_t firstNumber(const Entry& entry) {
        return entry.count > 0 ? number(entry.at, kTypeBytes[entry.type]) : 0;
    }

    /// Returns where the next directory lies, 0 after the last one.
    std::uint64_t readDirectory(std::uint64_t at, bool isFirst) {
        const std::uint64_t countBytes = isBig_ ? 8 : 2, entryBytes = isBig_ ? 20 : 12, offsetBytes = isBig_ ? 8 : 4;
        const std::uint64_t count = number(at, countBytes), first = at + countBytes;
        if (count > size_ / entryBytes) facts_.isWhole = false;
        std::vector<std::uint64_t> offsets, sizes;
        std::uint64_t bits = 0, compression = 0;
        for (std::uint64_t i = 0; i < count && facts_.isWhole; ++i) {
            const Entry entry = readEntry(first + i * entryBytes, offsetBytes);
            if (entry.type == 0) continue;
            if (entry.tag == kStripOffsets || entry.tag == kTileOffsets) offsets = numbers(entry);
            if (entry.tag == kStripByteCounts || entry.tag == kTileByteCounts) sizes = numbers(entry);
            if (entry.tag == kBitsPerSample) bits = firstNumber(entry);
            if (entry.tag == kCompression) compression = firstNumber(entry);
            if (isFirst && entry.tag == kGdalNoData) readNoData(entry);
        }
        // A piece that is not stored at all (a sparse file) has offset and size 0.
        for (std::size_t i = 0; i < std::min(offsets.size(), sizes.size()); ++i) isInside(offsets[i], sizes[i]);
        if (isFirst && bits == 64 && compression == kNotCompressed && !offsets.empty() && isInside(offsets[0], 8))
            facts_.first = std::bit_cast<double>(number(offsets[0], 8));
        return facts_.isWhole ? number(first + count * entryBytes, offsetBytes) : 0;
    }

    /// An entry of an unknown type comes back with type 0.
    Entry readEntry(std::uint64_t at, std::uint64_t offsetBytes) {
        Entry entry{number(at, 2), number(at + 2, 2), number(at + 4, offsetBytes), at + 4 + offsetBytes};
        if (entry.type >= kTypeBytes.size() || kTypeBytes[entry.type] == 0) return {};
        const std::uint64_t width = kTypeBytes[entry.type];
        if (entry.count > size_ / width) {
            facts_.isWhole = false;
            return {};
        }
        if (entry.count * width > offsetBytes) entry.at = number(entry.at, offsetBytes);
        if (!isInside(entry.at, entry.count * width)) return {};
        return entry;
    }

    void readNoData(const Entry& entry) {
        constexpr std::uint64_t kLongest = 64; // of a number in decimal
        const std::string text = bytes(entry.at, std::min(entry.count, kLongest));
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (end != text.c_str()) facts_.noData = value;
    }

    InputFile file_;
    std::uint64_t size_ = 0;
    bool isBigEndian_ = false, isBig_ = false;
    TiffFacts facts_;
};

} // namespace

TiffFacts readTiffFacts(const std::string& path) { return TiffReader(path).read(); }

} // namespace relief
