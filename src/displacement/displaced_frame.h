// The displaced surface in double precision: the reference that the device is compared with.
#pragma once

#include "displacement/height_map.h"

namespace relief {

/// Which normal a surface is shaded with.
enum class NormalKind {
    limit,      ///< of the limit surface below the displacement
    firstOrder, ///< of the displaced surface, as if the limit normal did not change along it (Blinn 1978)
    full,       ///< of the displaced surface (Lee, Moreton, Hoppe 2000)
};

/// The unit normal of a limit surface, its derivatives by u and v, and |p_u x p_v|.
struct NormalFrame {
    dvec3 n{0}, nu{0}, nv{0};
    double area = 0;
};

/// Computes the unit normal and its derivatives. Not finite where the frame has no tangent plane.
NormalFrame computeNormalFrame(const LimitFrame& frame);

/// Normals of q = p + h n, not unit: as long as the area per unit of (u,v).
struct DisplacedNormals {
    dvec3 firstOrder{0}, full{0};
};

/// Computes the normals of q. `dh` = (h_u, h_v). Not finite where the frame has no tangent plane.
DisplacedNormals computeDisplacedNormals(const LimitFrame& frame, double h, const dvec2& dh);

/// A point of the displaced surface with its three unit normals.
struct DisplacedFrame {
    LimitFrame limit;
    TexFrame tex;
    HeightSample height;
    dvec3 normal{0}; ///< limit normal n
    dvec3 q{0};      ///< p + h n
    dvec3 firstOrder{0}, full{0};
    dvec3 qu{0}, qv{0}; ///< derivatives of q by u and v; only of vector maps
};

/// Evaluates the displaced surface at (face,u,v) in double precision: the reference that the device is compared with.
/// It shares no formula with the shaders. Without a map the height is 0.
/// With `rest`, the same surface in another pose, heights are multiplied with the square root of the area gained since
/// then, 4 at most.
DisplacedFrame displacedFrame(const ReferenceSurface& surface, const HeightMap* map, int face, const dvec2& uv,
                              const ReferenceSurface* rest = nullptr);

/// A height and its derivatives by (u,v), cage units.
struct FaceHeight {
    double h = 0, hu = 0, hv = 0;
};

/// Evaluates the surface displaced by a height that no map holds; hs and ht of DisplacedFrame::height are its
/// derivatives by u and v.
DisplacedFrame displacedFrame(const ReferenceSurface& surface, const FaceHeight& height, int face, const dvec2& uv);

} // namespace relief
