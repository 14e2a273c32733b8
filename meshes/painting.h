// A height map and its albedo map, painted together.
#pragma once

#include "bake/bake.h"
#include "cage_builder.h"
#include "noise.h"

namespace relief::meshes {

/// Height in cage units; albedo in sRGB.
struct Paint {
    double height = 0;
    dvec3 albedo{0.5};
};

struct Painting {
    Image height; ///< one channel
    Image albedo; ///< three channels, or empty
};

inline Image blankImage(int width, int height, int channels) {
    return {width, height, channels, std::vector<float>(std::size_t(width) * height * channels)};
}

inline void put(Painting& painting, int x, int y, const Paint& paint) {
    *painting.height.at(x, y) = float(paint.height);
    for (int c = 0; c < 3; ++c) painting.albedo.at(x, y)[c] = float(glm::clamp(paint.albedo[c], 0.0, 1.0));
}

/// Paints by points of the surface, seams and gutters included.
inline Painting paintAtlas(Atlas& atlas, const ivec2& size, const std::function<Paint(const SurfacePoint&)>& painter) {
    Painting painting{blankImage(size.x, size.y, 1), blankImage(size.x, size.y, 3)};
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) { put(painting, x, y, painter(point)); });
    atlas.spread(painting.height);
    atlas.spread(painting.albedo);
    return painting;
}

/// Paints by texture coordinates.
inline Painting paintSquare(const ivec2& size, const std::function<Paint(const dvec2& st)>& painter) {
    Painting painting{blankImage(size.x, size.y, 1), blankImage(size.x, size.y, 3)};
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) put(painting, x, y, painter({(x + 0.5) / size.x, 1 - (y + 0.5) / size.y}));
    return painting;
}

} // namespace relief::meshes
