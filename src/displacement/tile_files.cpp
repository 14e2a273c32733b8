// Names of the files of a set of tiles.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include "displacement/displacement.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstUdim = 1001, kLastUdim = 9999;
constexpr int kMostTiles = 1024; ///< along s and t

struct TileToken {
    const char* text;
    TilePattern::Numbers numbers;
};
constexpr TileToken kTileTokens[] = {{"<UDIM>", TilePattern::Numbers::udim},
                                     {"%(UDIM)d", TilePattern::Numbers::udim},
                                     {"<uvtile>", TilePattern::Numbers::fromZero},
                                     {"<UVTILE>", TilePattern::Numbers::fromOne}};

/// Reads digits that are all of the text; empty for anything else.
std::optional<int> digitsOf(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool isAll = error == std::errc() && end == text.data() + text.size();
    if (text.empty() || text.front() == '-' || !isAll) return {};
    return number;
}

/// Reads u and v of "u3_v12".
std::optional<ivec2> pairOf(std::string_view text) {
    const std::size_t middle = text.find("_v");
    if (!text.starts_with('u') || middle == std::string_view::npos) return {};
    const std::optional<int> u = digitsOf(text.substr(1, middle - 1)), v = digitsOf(text.substr(middle + 2));
    if (!u || !v) return {};
    return ivec2(*u, *v);
}

/// The place that a number names; empty for a text that is no number. Throws for numbers of no tile.
std::optional<ivec2> placeOf(const std::string& path, std::string_view text, TilePattern::Numbers numbers) {
    if (numbers == TilePattern::Numbers::udim) {
        const std::optional<int> number = digitsOf(text);
        if (!number) return {};
        if (*number < kFirstUdim || *number > kLastUdim)
            fail(Failure::input, "{}: {} is no tile of a UDIM set; they go from {} to {}", path, *number, kFirstUdim,
                 kLastUdim);
        return ivec2((*number - kFirstUdim) % 10, (*number - kFirstUdim) / 10);
    }
    const std::optional<ivec2> pair = pairOf(text);
    if (!pair) return {};
    const int first = numbers == TilePattern::Numbers::fromOne ? 1 : 0;
    const ivec2 place = *pair - first;
    if (std::min(place.x, place.y) < 0 || std::max(place.x, place.y) >= kMostTiles)
        fail(Failure::input, "{}: u{}_v{} is no tile; u and v go from {} to {}", path, pair->x, pair->y, first,
             first + kMostTiles - 1);
    return place;
}

} // namespace

std::optional<TilePattern> findTilePattern(const std::string& path) {
    const std::size_t folder = path.find_last_of('/') + 1; // 0 where there is none
    std::optional<TilePattern> pattern;
    for (const TileToken& token : kTileTokens) {
        const std::string_view text = token.text;
        const std::size_t at = path.find(text, folder);
        if (at == std::string::npos) continue;
        if (pattern || path.find(text, at + 1) != std::string::npos)
            fail(Failure::usage, "{}: a name has one number of a tile", path);
        pattern = {path.substr(0, at), path.substr(at + text.size()), token.numbers};
    }
    return pattern;
}

std::string nameTile(const TilePattern& pattern, const ivec2& place) {
    if (pattern.numbers == TilePattern::Numbers::udim) return std::to_string(kFirstUdim + place.x + 10 * place.y);
    const int first = pattern.numbers == TilePattern::Numbers::fromOne ? 1 : 0;
    return fmt::format("u{}_v{}", place.x + first, place.y + first);
}

std::vector<TileFile> listTiles(const std::string& path) {
    const std::optional<TilePattern> pattern = findTilePattern(path);
    RELIEF_CHECK(pattern.has_value());
    std::error_code error;
    if (fs::exists(path, error))
        fail(Failure::input,
             "{}: a file has this name, which stands for the files of a set of tiles; give the file another name",
             path);
    // The mark stands in the name of the file, not in that of its folder, which is searched.
    const std::size_t slash = path.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
    const std::string before = pattern->before.substr(slash == std::string::npos ? 0 : slash + 1);
    fs::directory_iterator files(folder, error);
    if (error) fail(Failure::file, "{}: its folder cannot be read: {}", path, error.message());

    // By rows from the lowest (s,t) on: two names may number one tile ("1001" and "01001").
    const auto isBefore = [](const ivec2& a, const ivec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
    std::map<ivec2, std::string, decltype(isBefore)> found(isBefore);
    for (const fs::directory_entry& file : files) {
        const std::string name = file.path().filename().string();
        if (name.size() <= before.size() + pattern->after.size() || !name.starts_with(before) ||
            !name.ends_with(pattern->after))
            continue;
        const std::string_view text =
            std::string_view(name).substr(before.size(), name.size() - before.size() - pattern->after.size());
        const std::string full = pattern->before + std::string(text) + pattern->after;
        const std::optional<ivec2> place = placeOf(full, text, pattern->numbers);
        if (!place) continue;
        const auto [other, isNew] = found.emplace(*place, full);
        if (!isNew)
            fail(Failure::input, "{} and {} are both tile {} of a set; remove one", std::min(other->second, full),
                 std::max(other->second, full), nameTile(*pattern, *place));
    }
    if (found.empty())
        fail(Failure::file, "{}: there is no file of this set of tiles, such as {}{}{}", path, pattern->before,
             nameTile(*pattern, ivec2(0)), pattern->after);
    std::vector<TileFile> list;
    for (const auto& [place, file] : found) list.push_back({place, file});
    return list;
}

} // namespace relief
