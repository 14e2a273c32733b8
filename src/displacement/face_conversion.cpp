// Converts maps over texture coordinates to maps per face.
#include <algorithm>
#include <cmath>

#include "displacement/layers.h"

namespace relief {
namespace {

constexpr int kMostPerSide = 4096;
constexpr double kMostNodes = double(1 << 28); ///< a gigabyte of floats

/// Segments of a face that are as fine as the texels of a map under it, as powers of two.
ivec2 chooseSegments(const ReferenceSurface& reference, int face, const dvec2& texels) {
    constexpr int kSteps = 8;
    dvec2 lengths(0); // along u and v in texels, the longest of three lines
    for (int line = 0; line <= 2; ++line)
        for (int axis = 0; axis < 2; ++axis) {
            double length = 0;
            dvec2 last(0);
            for (int k = 0; k <= kSteps; ++k) {
                const double x = double(k) / kSteps, y = 0.5 * line;
                const dvec2 at = reference.texture(face, axis == 0 ? dvec2(x, y) : dvec2(y, x)).st * texels;
                if (k > 0) length += glm::length(at - last);
                last = at;
            }
            lengths[axis] = std::max(lengths[axis], length);
        }
    const double most = std::log2(kMostPerSide);
    return ivec2(glm::clamp(glm::ceil(glm::log2(glm::max(lengths, 1.0)) - 1e-6), 0.0, most));
}

} // namespace

HeightMap toFaceMap(const HeightMap& map, const MapPlacement& placement, const Surface& surface,
                    const ReferenceSurface& reference, std::optional<int> segments) {
    const dvec2 texels = dvec2(map.width, map.height) * glm::abs(placement.repeat);
    std::vector<ivec2> perFace;
    perFace.reserve(surface.faces.size());
    for (int face = 0; face < int(surface.faces.size()); ++face)
        perFace.push_back(reference.isHole(face) ? ivec2(0)
                          : segments             ? ivec2(int(std::lround(std::log2(*segments))))
                                                 : chooseSegments(reference, face, texels));
    double nodes = 0;
    for (const ivec2& each : perFace) nodes += (std::exp2(each.x) + 1) * (std::exp2(each.y) + 1);
    if (nodes > kMostNodes)
        fail(Failure::input,
             "a map per face as fine as its textures would have {:.3g} heights, {:.3g} are the most; "
             "repeat maps less often, or make them smaller",
             nodes, kMostNodes);
    return makeFaceMap(surface, perFace, [&](int face, const dvec2& uv) {
        return sampleHeight(map, {.face = face, .uv = uv, .st = placement.at(reference.texture(face, uv).st)}).h;
    });
}

} // namespace relief
