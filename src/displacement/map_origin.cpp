#include "displacement/map_origin.h"

#include <charconv>

namespace relief {
namespace {

constexpr const char* kProgramAttribute = "relief:program";
constexpr const char* kCageAttribute = "relief:topology"; ///< maps per face have it as well
constexpr const char* kMidAttribute = "relief:mid";
constexpr const char* kScaleAttribute = "relief:scale";

/// Reads all of an attribute's text, integers in base 16.
template <typename Number>
bool readNumber(const ImageInfo& info, const char* name, Number& number) {
    const auto found = info.attributes.find(name);
    if (found == info.attributes.end()) return false;
    const std::string& text = found->second;
    const char* const last = text.data() + text.size();
    std::from_chars_result result{};
    if constexpr (std::is_integral_v<Number>)
        result = std::from_chars(text.data(), last, number, 16);
    else
        result = std::from_chars(text.data(), last, number);
    return result.ec == std::errc() && result.ptr == last;
}

} // namespace

ImageAttributes toAttributes(const MapOrigin& origin) {
    return {{kProgramAttribute, "relief bake"},
            {kCageAttribute, fmt::format("{:016x}", origin.topology)},
            {kMidAttribute, fmt::format("{}", origin.mid)},
            {kScaleAttribute, fmt::format("{}", origin.scale)}};
}

std::optional<MapOrigin> readMapOrigin(const ImageInfo& info) {
    MapOrigin origin;
    if (!readNumber(info, kCageAttribute, origin.topology) || !readNumber(info, kMidAttribute, origin.mid) ||
        !readNumber(info, kScaleAttribute, origin.scale))
        return {};
    return origin;
}

} // namespace relief
