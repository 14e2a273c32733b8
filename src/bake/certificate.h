// The proof of a baked map: the surface displaced by it, measured against the sculpt.
#pragma once

#include "bake/lines.h"
#include "displacement/displacement.h"
#include "distance/distance.h"

namespace relief {

struct BakeCertificateOptions {
    LineSearch lines;
    std::uint64_t triangleCount = 1'000'000; ///< about so many of the displaced surface
    bool wantsDistances = false;             ///< fill in BakeCertificate::displaced
    ShowProgress progress = ShowProgress::never;
};

/// What is measured, in the unit of the surface. Shares are of the area of the limit surface.
struct BakeCertificate {
    SurfaceDistance distance;   ///< forth: from the displaced surface to the sculpt
    double missedShare = 0;     ///< lines along the normals miss the sculpt
    double behindShare = 0;     ///< the nearest hit lies behind the back of another sheet
    double foldedShare = 0;     ///< 1 + h kappa <= 0 for a principal curvature kappa (dn = kappa dp)
    double overturnedShare = 0; ///< displaced triangles that face against the limit normal
    std::uint64_t overturnedCount = 0;
    int rate = 0;                    ///< segments that each side of a face is cut into
    std::uint64_t triangleCount = 0; ///< of the displaced surface
    /// With BakeCertificateOptions::wantsDistances the displaced surface, else empty. `heights`: distance to the sculpt
    /// per vertex, negative where its line misses.
    DenseMesh displaced;
};

/// Displaces the surface by the map in double precision and measures it against the sculpt. The sides of all faces are
/// cut into the same number of segments.
BakeCertificate certifyBake(const ReferenceSurface& surface, const HeightMap& map, const MeasuredSurface& sculpt,
                            const BakeCertificateOptions& options);

} // namespace relief
