#include "app/units.h"

#include <charconv>
#include <cmath>
#include <map>

namespace relief::app {

std::optional<std::uint64_t> parseBytes(const std::string& word) {
    double number = 0;
    const char* end = word.data() + word.size();
    const auto [unit, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc()) return {};
    const std::map<std::string, double> units{{"", 1}, {"K", 1e3}, {"M", 1e6}, {"G", 1e9}, {"T", 1e12}};
    const auto found = units.find(std::string(unit, end));
    if (found == units.end()) return {};
    const double bytes = number * found->second;
    if (!(bytes >= 1e6 && bytes <= 1e12)) return {};
    return std::uint64_t(bytes);
}

CLI::Validator sizeInBytes() {
    const auto check = [](const std::string& word) {
        return parseBytes(word) ? std::string() : fmt::format("{} is not a size in 1M..1T, such as 512M or 2G", word);
    };
    return {check, ""};
}

std::optional<Distance> parseDistance(std::string word) {
    Distance distance{.isShare = word.ends_with('%')};
    if (distance.isShare) word.pop_back();
    if (word.empty() || !CLI::detail::lexical_cast(word, distance.value) || std::isnan(distance.value)) return {};
    if (distance.isShare) distance.value /= 100;
    return distance;
}

CLI::Validator distanceFromZero() {
    const auto check = [](const std::string& word) {
        const std::optional<Distance> distance = parseDistance(word);
        if (distance && distance->value >= 0 && std::isfinite(distance->value)) return std::string();
        return fmt::format("{} is no distance: 0 or more cage units, or a percentage of the diagonal such as 0.01%",
                           word);
    };
    return {check, ""};
}

} // namespace relief::app
