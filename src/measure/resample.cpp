// A map of fewer texels: the least-squares fit of what lookups read of it.
#include <algorithm>
#include <cmath>

#include "measure/measure.h"

namespace relief {
namespace {

/// The two texels of a line between whose centres a point lies.
struct TexelPair {
    std::size_t first = 0, second = 0;
    double weight = 0; ///< of the second; the first has 1 - weight
};

/// `x`: 0..1 along the line of `count` texels.
TexelPair findTexels(double x, std::size_t count, Wrap wrap) {
    const double at = x * double(count) - 0.5, whole = std::floor(at);
    const auto texel = [&](double i) {
        if (wrap == Wrap::clamp) return std::size_t(std::clamp(i, 0.0, double(count - 1)));
        return std::size_t(i + double(count)) % count;
    };
    return {texel(whole), texel(whole + 1), at - whole};
}

/// Fits lines of `to` texels to lines of `from` texels. Both are piecewise linear; the sum of squared differences at
/// two points per texel becomes least. The matrix of the normal equations has three entries per row; each Gauss-Seidel
/// sweep leaves a quarter of the error or less.
class LineFit {
public:
    LineFit(std::size_t from, std::size_t to, Wrap wrap) : diagonal_(to, 0), after_(to, 0), right_(to) {
        const std::size_t count = 2 * std::max(from, to);
        for (std::size_t k = 0; k < count; ++k) {
            const double x = (double(k) + 0.5) / double(count);
            from_.push_back(findTexels(x, from, wrap));
            const TexelPair& p = to_.emplace_back(findTexels(x, to, wrap));
            diagonal_[p.first] += (1 - p.weight) * (1 - p.weight);
            diagonal_[p.second] += p.weight * p.weight;
            if (p.first == p.second)
                diagonal_[p.first] += 2 * p.weight * (1 - p.weight);
            else
                after_[p.first] += p.weight * (1 - p.weight); // the second is the one after the first
        }
    }

    void fit(std::span<const float> from, std::span<float> to) {
        RELIEF_CHECK(to.size() == right_.size());
        // The right side of the normal equations, from the samples of this line.
        std::ranges::fill(right_, 0);
        for (std::size_t k = 0; k < from_.size(); ++k) {
            const TexelPair &f = from_[k], &t = to_[k];
            const double value = std::lerp(double(from[f.first]), double(from[f.second]), f.weight);
            right_[t.first] += (1 - t.weight) * value;
            right_[t.second] += t.weight * value;
        }
        // Gauss-Seidel, from the solution of the diagonal alone.
        const std::size_t n = to.size();
        std::vector<double> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = right_[i] / diagonal_[i];
        for (int sweep = 0; sweep < 24 && n > 1; ++sweep)
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t before = (i + n - 1) % n, next = (i + 1) % n;
                x[i] = (right_[i] - after_[before] * x[before] - after_[i] * x[next]) / diagonal_[i];
            }
        std::ranges::copy(x, to.begin());
    }

private:
    std::vector<TexelPair> from_, to_;
    std::vector<double> diagonal_, after_, right_; ///< entries (i, i), entries (i, i + 1), right side
};

/// Exchanges rows and columns.
std::vector<float> transpose(std::span<const float> texels, std::size_t width) {
    const std::size_t height = texels.size() / width;
    std::vector<float> columns(texels.size());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) columns[x * height + y] = texels[y * width + x];
    return columns;
}

/// `texels`: lines of `from` texels; the result has lines of `to`.
std::vector<float> fitLines(std::span<const float> texels, std::size_t from, std::size_t to, Wrap wrap) {
    if (from == to) return {texels.begin(), texels.end()};
    LineFit line(from, to, wrap);
    std::vector<float> fitted(texels.size() / from * to);
    for (std::size_t i = 0; i < texels.size() / from; ++i)
        line.fit(texels.subspan(i * from, from), std::span(fitted).subspan(i * to, to));
    return fitted;
}

} // namespace

HeightMap resampleMap(const HeightMap& map, int width, int height) {
    RELIEF_CHECK(map.texels.size() == std::size_t(map.width) * std::size_t(map.height));
    const auto from = std::size_t(map.width), to = std::size_t(width);
    const std::vector<float> rows = fitLines(map.texels, from, to, map.wrap);
    const std::vector<float> columns =
        fitLines(transpose(rows, to), std::size_t(map.height), std::size_t(height), map.wrap);
    return makeHeightMap(width, height, transpose(columns, std::size_t(height)), map.mid, map.scale, map.wrap);
}

} // namespace relief
