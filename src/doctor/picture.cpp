#include <algorithm>
#include <cmath>

#include "doctor/examiners.h"

namespace relief {
namespace {

// Linear values are written as they are: these are colors of the screen.
constexpr vec3 kFold{0.93f, 0.16f, 0.14f}, kStretch{1, 0.6f, 0.1f}, kEmpty{0.25f, 0.5f, 1}, kSeam{1, 0.2f, 0.95f};
constexpr vec3 kPaper{0.09f}, kOutline{0.75f};

struct LegendRow {
    const char* word;
    vec3 color;
};
constexpr LegendRow kLegend[] = {
    {"folds", kFold}, {"stretched texels", kStretch}, {"empty islands", kEmpty}, {"seams", kSeam}};

/// A square picture of a square of texture space.
class LayoutCanvas {
public:
    /// The unit square, and as much around it as the layout needs.
    LayoutCanvas(const SurfaceLayout& layout, int side)
        : lower_(glm::min(dvec2(0), glm::max(layout.lower, dvec2(-kMostAround)))),
          side_(side), image_{.width = side, .height = side, .channels = 3, .texels = {}} {
        const dvec2 upper = glm::max(dvec2(1), glm::min(layout.upper, dvec2(1 + kMostAround)));
        extent_ = std::max(upper.x - lower_.x, upper.y - lower_.y);
        image_.texels.assign(std::size_t(side) * std::size_t(side) * 3, kPaper.x);
    }

    [[nodiscard]] dvec2 toPixels(const dvec2& st) const {
        return {(st.x - lower_.x) / extent_ * side_ - 0.5, (1 - (st.y - lower_.y) / extent_) * side_ - 0.5};
    }
    [[nodiscard]] dvec2 toTexture(const dvec2& pixel) const {
        return {lower_.x + (pixel.x + 0.5) / side_ * extent_, lower_.y + (1 - (pixel.y + 0.5) / side_) * extent_};
    }
    void set(int x, int y, const vec3& color) {
        for (int k = 0; k < 3; ++k) image_.at(x, y)[k] = color[k];
    }
    void blend(int x, int y, const vec3& color, float share) {
        if (x < 0 || y < 0 || x >= side_ || y >= side_) return;
        for (int k = 0; k < 3; ++k) image_.at(x, y)[k] = std::lerp(image_.at(x, y)[k], color[k], share);
    }
    /// Calls `take` with each pixel of a quad.
    template <typename Take>
    void eachPixel(const std::array<dvec2, 4>& corners, const Take& take) {
        std::array<dvec2, 4> points;
        for (std::size_t k = 0; k < 4; ++k) points[k] = toPixels(corners[k]);
        eachPointIn(points, dvec2(0), dvec2(side_ - 1), take);
    }
    /// A line `width` pixels wide.
    void drawLine(const dvec2& from, const dvec2& to, const vec3& color, float share, double width) {
        const dvec2 a = toPixels(from), b = toPixels(to), d = b - a;
        const dvec2 low = glm::max(glm::floor(glm::min(a, b) - width), dvec2(0));
        const dvec2 high = glm::min(glm::ceil(glm::max(a, b) + width), dvec2(side_ - 1));
        for (int y = int(low.y); y <= high.y; ++y)
            for (int x = int(low.x); x <= high.x; ++x) {
                const dvec2 p(x, y);
                const double t = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-9), 0.0, 1.0);
                const double covered = std::clamp(0.5 * width + 0.5 - glm::length(p - a - t * d), 0.0, 1.0);
                if (covered > 0) blend(x, y, color, share * float(covered));
            }
    }
    [[nodiscard]] Image& image() { return image_; }

private:
    static constexpr double kMostAround = 9;
    dvec2 lower_;
    double extent_ = 1;
    int side_;
    Image image_;
};

void drawHeights(LayoutCanvas& canvas, const HeightMap& map, const SurfaceLayout& layout) {
    const double range = std::max(double(map.highest) - map.lowest, 1e-30);
    for (const LayoutCell& cell : layout.cells)
        canvas.eachPixel(cell.corners, [&](int x, int y) {
            double share = 0.5;
            if (map.scale != 0) {
                MapPlace place = placeOf(cell);
                if (map.addressing != Addressing::faces) place.st = canvas.toTexture({x, y});
                const double h = sampleHeight(map, place).h;
                share = (h / map.scale + map.mid - map.lowest) / range;
            }
            canvas.set(x, y, vec3(float(0.2 + 0.4 * share)));
        });
}

void drawCells(LayoutCanvas& canvas, const HeightMap& map, const DoctorSubject& subject) {
    const SurfaceLayout& layout = *subject.layout;
    const std::vector<vec2> ranges = computeIslandRanges(layout, map, coverTexels(layout, map));
    const StretchLimit limit = computeStretchLimit(layout, map);
    const bool hasIslands = layout.islandFaces.size() > 1;
    for (const LayoutCell& cell : layout.cells) {
        const bool isFolded = foldFactorOf(cell, map, *subject.reference) <= 0,
                   isEmpty = hasIslands && isEmptyIsland(ranges[cell.island], map);
        const bool isStretched = limit.isExceededBy(texelExtents(cell, map));
        if (!isFolded && !isEmpty && !isStretched) continue;
        const vec3 color = isFolded ? kFold : isStretched ? kStretch : kEmpty;
        canvas.eachPixel(cell.corners, [&](int x, int y) { canvas.blend(x, y, color, 0.7f); });
    }
}

/// The sides of faces, and over them the seams that disagree, as strongly as they do.
void drawEdges(LayoutCanvas& canvas, const Examination& examination, const DoctorSubject& subject) {
    const Surface& surface = *subject.surface;
    const EdgeIncidences incidences = edgeIncidences(surface);
    const auto draw = [&](std::size_t edge, const vec3& color, float share, double width) {
        constexpr int kPieces = 8;
        for (const Incidence& incidence : incidences.of(edge)) {
            const auto at = [&](int i) {
                const double x = std::lerp(double(incidence.start), double(incidence.end), double(i) / kPieces);
                return subject.reference
                    ->texture(int(incidence.face), sidePoint(surface.sideCount, int(incidence.side), x))
                    .st;
            };
            for (int i = 0; i < kPieces; ++i) canvas.drawLine(at(i), at(i + 1), color, share, width);
        }
    };
    for (std::size_t edge = 0; edge < surface.edges.size(); ++edge) draw(edge, kOutline, 0.25f, 1);
    const HeightMap& map = examination.map;
    const double range = std::abs(map.scale) * (double(map.highest) - map.lowest);
    for (const SeamEdge& seam : examination.seams.edges) {
        const double share = range > 0 ? seam.max / range : 0;
        if (share > 0.01) draw(seam.edge, kSeam, float(std::clamp(0.4 + 4 * share, 0.0, 1.0)), 4);
    }
}

void drawLegend(Image& image) {
    const int height = std::max(image.width / 32, 12), columns = int(std::size(kLegend)), width = image.width / columns;
    Image sheet{.width = image.width, .height = image.height + 2 * height, .channels = 3, .texels = image.texels};
    sheet.texels.resize(std::size_t(sheet.width) * std::size_t(sheet.height) * 3, 0.0f);
    for (int column = 0; column < columns; ++column) {
        const LegendRow& row = kLegend[column];
        const int left = column * width + height / 2, top = image.height + height / 2;
        for (int y = top; y < top + height; ++y)
            for (int x = left; x < left + height; ++x)
                for (int k = 0; k < 3; ++k) sheet.at(x, y)[k] = row.color[k];
        drawText(sheet, row.word, column * width + width / 2 + height / 2, top + height / 2, height * 5 / 8, 0.9f);
    }
    image = std::move(sheet);
}

} // namespace

Image drawFindings(const Examination& examination, const DoctorSubject& subject, int side) {
    LayoutCanvas canvas(*subject.layout, side);
    drawHeights(canvas, examination.map, *subject.layout);
    drawCells(canvas, examination.map, subject);
    drawEdges(canvas, examination, subject);
    drawLegend(canvas.image());
    return std::move(canvas.image());
}

} // namespace relief
