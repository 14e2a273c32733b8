#include <algorithm>
#include <cmath>

#include "displacement/neighbours.h"
#include "maps/maps.h"
#include "maps/transforms.h"

namespace relief {

namespace {

/// Numbers per texel, row after row.
struct Field {
    int width = 0, height = 0;
    std::vector<double> values;

    [[nodiscard]] std::span<double> row(int j) {
        return std::span(values).subspan(std::size_t(j) * std::size_t(width), std::size_t(width));
    }
};

/// The slopes of normals along x and y (y runs up, rows run down).
struct Slopes {
    const NormalMap& map;
    bool halvesBorder = false; ///< across a clamped border, where a difference sees half of a slope

    [[nodiscard]] dvec2 at(int i, int j) const {
        const vec3& n = map.normals[std::size_t(j) * std::size_t(map.width) + std::size_t(i)];
        const dvec2 slope(-double(n.x) / n.z, -double(n.y) / n.z);
        if (!halvesBorder) return slope;
        const auto isBorder = [](int k, int size) { return k == 0 || k == size - 1; };
        return slope * dvec2(isBorder(i, map.width) ? 0.5 : 1, isBorder(j, map.height) ? 0.5 : 1);
    }
};

void checkNormals(const NormalMap& map, const std::string& name) {
    checkNormalSpace(map.space, name);
    const auto isBelow = [](const vec3& n) { return !(n.z > 0); };
    const auto below = std::ranges::find_if(map.normals, isBelow);
    if (below == map.normals.end()) return;
    const std::size_t first = std::size_t(below - map.normals.begin()), width = std::size_t(map.width);
    fail(Failure::input,
         "{}: {} of {} normals point along the surface or below it (the first in column {}, row {} from 0, top left); "
         "no height has such a normal",
         name, std::ranges::count_if(map.normals, isBelow), map.normals.size(), first % width, first / width);
}

/// Means over the texels of a map.
struct SlopeMeans {
    dvec2 slope{0};
    double square = 0;        ///< of the slopes' lengths
    double squareOfSteps = 0; ///< of the difference of a slope from that of the texel before it along its own axis
};

SlopeMeans computeMeans(const Slopes& slopes) {
    const NormalMap& map = slopes.map;
    SlopeMeans sums;
    for (int j = 0; j < map.height; ++j)
        for (int i = 0; i < map.width; ++i) {
            const dvec2 slope = slopes.at(i, j);
            const double left = slopes.at(beside(i, -1, map.width, map.wrap), j).x;
            const double above = slopes.at(i, beside(j, -1, map.height, map.wrap)).y;
            sums.slope += slope;
            sums.square += glm::dot(slope, slope);
            sums.squareOfSteps += 0.5 * (std::pow(slope.x - left, 2) + std::pow(slope.y - above, 2));
        }
    const auto count = double(map.normals.size());
    return {sums.slope / count, sums.square / count, sums.squareOfSteps / count};
}

/// The right side of the normal equations: the transposed differences of the slopes.
Field transposeDifferences(const Slopes& slopes, const dvec2& texel) {
    const NormalMap& map = slopes.map;
    Field field{map.width, map.height, std::vector<double>(map.normals.size(), 0)};
    for (int j = 0; j < map.height; ++j)
        for (int i = 0; i < map.width; ++i) {
            const dvec2 half = 0.5 * slopes.at(i, j) / texel;
            const std::span<double> row = field.row(j);
            row[std::size_t(beside(i, 1, map.width, map.wrap))] += half.x;
            row[std::size_t(beside(i, -1, map.width, map.wrap))] -= half.x;
            field.row(beside(j, -1, map.height, map.wrap))[std::size_t(i)] += half.y; // y runs up
            field.row(beside(j, 1, map.height, map.wrap))[std::size_t(i)] -= half.y;
        }
    return field;
}

using Transform = void (AxisTransform::*)(std::span<double>, std::span<double>);

void transformRows(Field& field, AxisTransform& axis, Transform transform) {
    std::vector<double> none(std::size_t(field.width));
    for (int j = 0; j < field.height; j += 2)
        (axis.*transform)(field.row(j), j + 1 < field.height ? field.row(j + 1) : std::span(none));
}

/// Columns, some at a time so that whole lines of the cache are read.
void transformColumns(Field& field, AxisTransform& axis, Transform transform) {
    constexpr int kAtOnce = 16;
    const auto height = std::size_t(field.height);
    std::vector<double> columns(kAtOnce * height);
    const auto column = [&](int k) { return std::span(columns).subspan(std::size_t(k) * height, height); };
    for (int first = 0; first < field.width; first += kAtOnce) {
        const int count = std::min(kAtOnce, field.width - first);
        for (int j = 0; j < field.height; ++j)
            for (int k = 0; k < count; ++k) column(k)[std::size_t(j)] = field.row(j)[std::size_t(first + k)];
        for (int k = 0; k < count; k += 2) (axis.*transform)(column(k), column(k + 1));
        for (int j = 0; j < field.height; ++j)
            for (int k = 0; k < count; ++k) field.row(j)[std::size_t(first + k)] = column(k)[std::size_t(j)];
    }
}

/// The eigenvalues of an axis: of the squared differences, and of the squared second differences, which are weighed.
std::vector<double> computeEigenvalues(const AxisTransform& axis, double texel, double smoothness) {
    std::vector<double> values;
    for (int k = 0; k < axis.size(); ++k) {
        const double half = std::sin(0.5 * axis.angle(k));
        const double slope = axis.isHidden(k) ? 0 : std::sin(axis.angle(k)); // sin(pi) is not 0 in floating point
        values.push_back((slope * slope + smoothness * 16 * std::pow(half, 4)) / (texel * texel));
    }
    return values;
}

/// Solves the normal equations in place. Waves that no slope shows become 0.
void solve(Field& field, Wrap wrap, const dvec2& texel, double smoothness) {
    AxisTransform x(field.width, wrap), y(field.height, wrap);
    const std::vector<double> alongX = computeEigenvalues(x, texel.x, smoothness);
    const std::vector<double> alongY = computeEigenvalues(y, texel.y, smoothness);
    transformRows(field, x, &AxisTransform::forward);
    transformColumns(field, y, &AxisTransform::forward);
    for (int j = 0; j < field.height; ++j)
        for (int i = 0; i < field.width; ++i) {
            const double eigenvalue = alongX[std::size_t(i)] + alongY[std::size_t(j)];
            double& value = field.row(j)[std::size_t(i)];
            value = eigenvalue > 0 ? value / eigenvalue : 0;
        }
    transformColumns(field, y, &AxisTransform::inverse);
    transformRows(field, x, &AxisTransform::inverse);
}

/// How much second differences count beside the slopes: the ratio of the variances of rounding and of what is there.
double computeSmoothness(double rounding, double squareOfSteps) {
    const double noise = rounding * rounding, signal = squareOfSteps - 2 * noise;
    return signal > noise ? noise / signal : noise > 0 ? 1 : 0;
}

/// Means over the texels of heights.
struct Fit {
    Field heights;
    double residualSquare = 0;  ///< of what their slopes differ from those asked for
    double roughnessSquare = 0; ///< of their second differences
};

Fit computeFit(const Slopes& slopes, const dvec2& texel, double smoothness) {
    const NormalMap& map = slopes.map;
    Fit fit{.heights = transposeDifferences(slopes, texel)};
    solve(fit.heights, map.wrap, texel, smoothness);
    const auto at = [&](int i, int j) { return fit.heights.row(j)[std::size_t(i)]; };
    for (int j = 0; j < map.height; ++j) {
        const int above = beside(j, -1, map.height, map.wrap), below = beside(j, 1, map.height, map.wrap);
        for (int i = 0; i < map.width; ++i) {
            const double left = at(beside(i, -1, map.width, map.wrap), j), middle = at(i, j);
            const double right = at(beside(i, 1, map.width, map.wrap), j);
            const dvec2 slope = 0.5 * dvec2(right - left, at(i, above) - at(i, below)) / texel;
            const dvec2 bend = dvec2(right + left - 2 * middle, at(i, above) + at(i, below) - 2 * middle) / texel;
            const dvec2 residual = slopes.at(i, j) - slope;
            fit.residualSquare += glm::dot(residual, residual);
            fit.roughnessSquare += glm::dot(bend, bend);
        }
    }
    fit.residualSquare /= double(map.normals.size());
    fit.roughnessSquare /= double(map.normals.size());
    return fit;
}

/// Differences across a clamped border see half of the slope there. Maps of other programs have all of it: taken as it
/// is, it is made up for by waves of two texels through the whole map. The smoother one of both readings is right.
Fit chooseFit(const NormalMap& map, const dvec2& texel, double smoothness) {
    Fit fit = computeFit({map}, texel, smoothness);
    if (map.wrap == Wrap::repeat) return fit;
    Fit halved = computeFit({map, true}, texel, smoothness);
    constexpr double kClearly = 0.25; // heights that are rough themselves may be smoother by chance
    return halved.roughnessSquare < kClearly * fit.roughnessSquare ? std::move(halved) : std::move(fit);
}

} // namespace

double computeSlopeRounding(const ImageInfo& info) {
    const double step = info.sample == "uint8"    ? 2.0 / 255
                        : info.sample == "uint16" ? 2.0 / 65535
                        : info.sample == "half"   ? 2.0 / 2048
                                                  : 0;
    return step / std::sqrt(12.0);
}

void checkNormalSpace(NormalSpace space, const std::string& name) {
    if (space != NormalSpace::tangent)
        fail(Failure::usage, "{}: heights are made of normals in tangent space; those of an object have no one height",
             name);
}

IntegratedHeights integrateNormals(const NormalMap& map, const IntegrationOptions& options, const std::string& name) {
    RELIEF_CHECK(options.size.x > 0);
    RELIEF_CHECK(options.size.y > 0);
    checkNormals(map, name);
    const dvec2 texel = options.size / dvec2(map.width, map.height);
    const SlopeMeans means = computeMeans({map});
    const Fit fit = chooseFit(map, texel, computeSmoothness(options.rounding, means.squareOfSteps));
    const std::vector<double>& heights = fit.heights.values;
    IntegratedHeights result{
        .slopeRms = std::sqrt(means.square), .residualRms = std::sqrt(fit.residualSquare), .meanSlope = means.slope};
    result.heights =
        makeHeightMap(map.width, map.height, std::vector<float>(heights.begin(), heights.end()), 0, 1, map.wrap);
    return result;
}

} // namespace relief
