// Which faces hold patches that are not the limit surface although exact end caps were asked for.
#include <algorithm>

#include "surface/far.h"

namespace relief {
namespace {

/// True without a look at patches: vertices are apart from each other, no semi-sharp rule goes on, and no sharp corners
/// of texture coordinates follow each other on all levels.
bool isSurelyExact(const Cage& cage, const SurfaceOptions& options) {
    if (options.scheme == Scheme::bilinear || options.endCaps == EndCapKind::gregory) return true;
    if (cage.hasTexCoords() && cage.texBoundaryRule == TexBoundaryRule::boundaries) return false;
    return std::min(options.isolation, options.separation) >= kSeparation &&
           !hasFiniteSharpnessPast(cage, options.isolation);
}

} // namespace

bool hasFiniteSharpnessPast(const Cage& cage, int isolation) {
    const auto isPast = [&](float sharpness) {
        return sharpness > float(isolation) && sharpness < OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE;
    };
    return std::ranges::any_of(cage.creaseSharpness, isPast) || std::ranges::any_of(cage.vertexSharpness, isPast);
}

std::vector<std::uint32_t> listApproximateFaces(const Cage& cage, const SurfaceOptions& options,
                                                const Surface* surface) {
    if (isSurelyExact(cage, options)) return {};
    if (!surface) {
        const Surface built = buildSurface(cage, options);
        return listApproximateFaces(cage, options, &built);
    }
    const bool isCutShort = hasFiniteSharpnessPast(cage, options.isolation);
    const auto isGregory = [](std::uint32_t type) { return type == kPatchGregory || type == kPatchGregoryTriangle; };
    std::vector<std::uint32_t> faces;
    for (const Patch& patch : surface->patches) {
        const Far::PatchParam param{patch.param0, patch.param1};
        const bool isTexGregory = surface->hasTexCoords() && isGregory(patch.texType);
        if (isGregory(patch.type) || isTexGregory || (isCutShort && param.GetDepth() >= options.isolation))
            faces.push_back(surface->faces[std::size_t(param.GetFaceId())].cageFace);
    }
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
    return faces;
}

} // namespace relief
