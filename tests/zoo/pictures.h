// Pictures of the zoo's cages.
#pragma once

#include "loads.h"

namespace relief::test {

inline Renderer& renderer() {
    static Renderer instance(device(), {.width = 160, .height = 160, .shadowSide = 1});
    return instance;
}

/// Cracks are thin: these pictures have finer pixels.
inline Renderer& crackRenderer() {
    static Renderer instance(device(), {.width = 512, .height = 512, .shadowSide = 1});
    return instance;
}

inline std::vector<Path> drawnPaths() {
    if (!device().traits().hasTessellation) return {Path::grid, Path::dice};
    return {Path::tessellation, Path::grid, Path::dice};
}

/// Normals of a cage, or whatever reads no light, with room for heights around it.
inline RenderOptions pictureOptions(const std::vector<vec3>& positions, const CameraOptions& view) {
    RenderOptions options;
    std::vector<dvec3> points(positions.begin(), positions.end());
    for (const dvec3& p : points) options.bounds.add(p);
    options.camera = frameCamera(points, view, 1);
    options.show = Show::normal;
    options.edgePixels = 3;
    options.lighting.castsShadows = false;
    return options;
}

/// None of them looks along an axis or along the shift.
inline constexpr CameraOptions kCrackViews[] = {{.azimuth = 31, .elevation = 17}, {.azimuth = 163, .elevation = -41}};

/// 4 % of the side of a triangle.
inline vec3 crackShift(double side) { return float(0.04 * side) * vec3(0.42f, 0.57f, 0.71f); }

} // namespace relief::test
