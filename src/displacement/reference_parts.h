// Internal: what the references of heights and of vectors share.
#pragma once

#include "displacement/displaced_frame.h"

namespace relief {

/// The limit surface at a point, not displaced.
DisplacedFrame frameWithoutHeight(const ReferenceSurface& surface, int face, const dvec2& uv);

/// What heights are multiplied with where they stretch with the surface since the rest pose.
double computeStretch(const ReferenceSurface& rest, const ReferenceSurface& now, int face, const dvec2& uv);

} // namespace relief
