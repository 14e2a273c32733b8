// Internal: how drags and keys move the camera, as plain arithmetic.
#pragma once

#include <optional>

#include "frame/frame.h"

namespace relief {

/// A camera that turns around a point of the world.
struct Orbit {
    dvec3 target{0};
    double azimuth = 30, elevation = 20; ///< degrees, as CameraOptions
    double distance = 1;                 ///< cage units
    double fieldOfView = 30;             ///< vertical, degrees
};

/// The orbit of a camera that was placed by `options`, in the coordinates of its object.
Orbit makeOrbit(const CameraOptions& options, const Camera& placed, const Coordinates& coordinates);
/// Options that place the camera of an orbit.
CameraOptions toOptions(const Orbit& orbit);

/// Turns the object with the cursor: half a degree per pixel. The elevation stays within -90..90.
Orbit turn(Orbit orbit, const dvec2& pixels);
/// Moves the target so that the point in its plane below the cursor follows it. `height`: rows of the picture.
Orbit pan(Orbit orbit, const dvec2& pixels, int height);
/// Multiplies the distance by `factor`; the point in the target's plane below the cursor stays where it is.
Orbit zoom(Orbit orbit, double factor, const dvec2& cursor, const ivec2& size);
/// Changes the field of view and keeps the size of what is in the target's plane.
Orbit widen(Orbit orbit, double fieldOfView);

/// The narrowest field of view that the command line takes, in degrees: the object is seen in nearly parallel lines.
inline constexpr double kParallelView = 1;

/// Where a camera shows a point of its own coordinates, in pixels from the upper left corner; nothing behind the eye.
std::optional<dvec2> toPixel(const Camera& camera, const dvec3& point, const ivec2& size);

} // namespace relief
