// How far the faces along an edge disagree about the height there.
#include <algorithm>
#include <cmath>

#include "check/check.h"

namespace relief {
namespace {

/// Samples along an edge: at least this many, and two per texel, so that no texel is skipped.
constexpr int kFewestSteps = 8, kMostSteps = 512;

/// Texture coordinates nearer than this are the same: they come from two patches in double precision.
constexpr double kSameTexture = 1e-9;

class SeamMeter {
public:
    SeamMeter(const Surface& surface, const ReferenceSurface& reference, const HeightMap& map)
        : surface_(surface), reference_(reference), map_(map) {}

    SeamReport measure() {
        const EdgeIncidences incidences = edgeIncidences(surface_);
        for (std::size_t edge = 0; edge < surface_.edges.size(); ++edge)
            if (isSeam(incidences.of(edge))) addEdge(incidences.of(edge));
        if (report_.length > 0) report_.mean /= report_.length;
        return report_;
    }

private:
    [[nodiscard]] dvec2 pointOf(const Incidence& incidence, double t) const {
        return sidePoint(surface_.sideCount, int(incidence.side),
                         std::lerp(double(incidence.start), double(incidence.end), t));
    }
    [[nodiscard]] dvec2 textureOf(const Incidence& incidence, double t) const {
        return reference_.texture(int(incidence.face), pointOf(incidence, t)).st;
    }

    [[nodiscard]] bool isSeam(std::span<const Incidence> incidences) const {
        for (const Incidence& incidence : incidences.subspan(1))
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const dvec2 own = textureOf(incidences.front(), t), other = textureOf(incidence, t);
                const double scale = 1 + std::max(glm::length(own), glm::length(other));
                if (glm::length(own - other) > kSameTexture * scale) return true;
            }
        return false;
    }

    [[nodiscard]] int stepsAlong(std::span<const Incidence> incidences) const {
        double most = 0;
        for (const Incidence& incidence : incidences) {
            const dvec2 a = textureOf(incidence, 0), b = textureOf(incidence, 0.5), c = textureOf(incidence, 1);
            most = std::max(most, texels(b - a) + texels(c - b));
        }
        return int(std::clamp(std::ceil(2 * most), double(kFewestSteps), double(kMostSteps)));
    }
    [[nodiscard]] double texels(const dvec2& st) const {
        return std::max(std::abs(st.x) * map_.width, std::abs(st.y) * map_.height);
    }

    /// Largest minus smallest height that the faces see.
    [[nodiscard]] double disagreement(std::span<const Incidence> incidences, double t) const {
        double lowest = 1e300, highest = -1e300;
        for (const Incidence& incidence : incidences) {
            const double h = sampleHeight(map_, textureOf(incidence, t)).h;
            lowest = std::min(lowest, h), highest = std::max(highest, h);
        }
        return highest - lowest;
    }

    [[nodiscard]] double lengthOf(const Incidence& incidence) const {
        constexpr int kPieces = 4;
        const auto at = [&](int i) {
            return reference_.limit(int(incidence.face), pointOf(incidence, double(i) / kPieces)).p;
        };
        double length = 0;
        for (int i = 0; i < kPieces; ++i) length += glm::length(at(i + 1) - at(i));
        return length;
    }

    /// The trapezoidal rule along the edge; report_.mean sums disagreement times length until measure() ends.
    void addEdge(std::span<const Incidence> incidences) {
        const int steps = stepsAlong(incidences);
        double sum = 0;
        for (int i = 0; i <= steps; ++i) {
            const double t = double(i) / steps, apart = disagreement(incidences, t);
            sum += i == 0 || i == steps ? 0.5 * apart : apart;
            if (apart > report_.max)
                report_.max = apart, report_.worst = {incidences.front().face, vec2(pointOf(incidences.front(), t))};
        }
        const double length = lengthOf(incidences.front());
        ++report_.seamEdgeCount;
        report_.length += length;
        report_.mean += sum / steps * length;
    }

    const Surface& surface_;
    const ReferenceSurface& reference_;
    const HeightMap& map_;
    SeamReport report_;
};

} // namespace

SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, const HeightMap& map) {
    return SeamMeter(surface, reference, map).measure();
}

} // namespace relief
