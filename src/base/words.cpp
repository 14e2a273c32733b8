#include "base/base.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace relief {

namespace {

/// Edit distance where swapping two neighbours is one edit, as typing errors go (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(beforeLast, last), std::swap(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            const bool isSwap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (isSwap) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string lowered(std::string_view word) {
    std::string result(word);
    for (char& letter : result) letter = char(std::tolower(static_cast<unsigned char>(letter)));
    return result;
}

} // namespace

std::string lowerExtension(const std::string& path) {
    return lowered(std::filesystem::path(path).extension().string());
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
    // A third of the letters may be wrong; more than that is another word.
    std::size_t nearest = std::max<std::size_t>(1, word.size() / 3) + 1;
    std::string found;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = editDistance(lowered(word), lowered(candidate));
        if (distance >= nearest || distance >= candidate.size()) continue;
        nearest = distance;
        found = candidate;
    }
    return found;
}

std::string humanBytes(std::uint64_t bytes) {
    static constexpr std::array kUnits = {"kB", "MB", "GB", "TB", "PB", "EB"};
    if (bytes < 1000) return fmt::format("{} B", bytes);
    std::size_t unit = 0;
    double value = double(bytes) / 1000;
    while (value >= 999.95 && unit + 1 < kUnits.size()) value /= 1000, ++unit; // 999.95 would print as 1000.0
    return fmt::format("{:.1f} {}", value, kUnits[unit]);
}

} // namespace relief
