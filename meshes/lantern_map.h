// The lantern's maps: hammered bronze, ripples in its glass panes.
#pragma once

#include "lantern.h"
#include "painting.h"

namespace relief::meshes {

/// How deep a point of a panel lies inside the pane: 1 in the middle, 0 on its border. `panel` is 0..1 each way.
inline double paneDepth(const dvec2& panel) {
    dvec2 d = glm::abs(panel - 0.5) / dvec2(0.32, 0.31);
    return 1 - std::max(d.y, d.x + 0.47 * d.y * d.y);
}

inline Painting paintLantern(const ivec2& size) {
    return paintSquare(size, [](const dvec2& st) {
        dvec2 at = lanternCoordinates(st); // in sides of the lantern, and 0..1 over a panel's height
        double side = at.x - std::floor(at.x);
        dvec3 p(at.x * 7.0, at.y * 14.0, 0.5);
        Cells dents = cells(warped(p, 0.7, 0.35, 3), 5);
        double hammered = 0.010 * (dents.nearest * dents.nearest - 0.35) + 0.0015 * noise(p * 6.0, 7);
        dvec3 bronze = glm::mix(dvec3(0.46, 0.31, 0.16), dvec3(0.36, 0.23, 0.12), smoothstep(0.3, 0.9, dents.nearest));
        bronze = glm::mix(bronze, dvec3(0.20, 0.36, 0.31), 0.7 * smoothstep(0.10, 0.45, fractal(p * 0.35, 3, 9)));
        double depth = at.y > 0 && at.y < 1 ? paneDepth({side, at.y}) : -1;
        if (depth < -0.15) return Paint{hammered, bronze};
        double ripple = 0.004 * std::sin(18 * depth + 3 * noise(p * 0.7, 11)), glass = smoothstep(0.0, 0.06, depth);
        double bead = 0.022 * std::exp(-std::pow(depth / 0.07, 2));
        dvec3 amber = glm::mix(dvec3(0.85, 0.45, 0.10), dvec3(1.0, 0.80, 0.38), smoothstep(0.0, 0.9, depth));
        return Paint{glm::mix(hammered, ripple, glass) + bead, glm::mix(bronze, amber, glass)};
    });
}

} // namespace relief::meshes
