#include <algorithm>

#include "measure/measure.h"

namespace relief {
namespace {

/// Texels 0..count-1 of a line as means of what they cover of `from`.
void shrinkLine(std::span<const float> from, std::span<float> to) {
    const double step = double(from.size()) / double(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        const double first = double(i) * step, end = std::min(double(i + 1) * step, double(from.size()));
        double sum = 0;
        for (auto k = std::size_t(first); k < from.size() && double(k) < end; ++k)
            sum += from[k] * (std::min(end, double(k) + 1) - std::max(first, double(k)));
        to[i] = float(sum / (end - first));
    }
}

} // namespace

HeightMap resampled(const HeightMap& map, int width, int height) {
    if (width == map.width && height == map.height) return map;
    std::vector<float> rows(std::size_t(width) * std::size_t(map.height));
    for (std::size_t y = 0; y < std::size_t(map.height); ++y)
        shrinkLine(std::span(map.texels).subspan(y * std::size_t(map.width), std::size_t(map.width)),
                   std::span(rows).subspan(y * std::size_t(width), std::size_t(width)));
    std::vector<float> texels(std::size_t(width) * std::size_t(height));
    std::vector<float> column(rows.size() / std::size_t(width)), shrunk(texels.size() / std::size_t(width));
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
        for (std::size_t y = 0; y < column.size(); ++y) column[y] = rows[y * std::size_t(width) + x];
        shrinkLine(column, shrunk);
        for (std::size_t y = 0; y < shrunk.size(); ++y) texels[y * std::size_t(width) + x] = shrunk[y];
    }
    return makeHeightMap(width, height, std::move(texels), map.mid, map.scale, map.wrap);
}

} // namespace relief
