// What tests that evaluate and draw surfaces on the device share.
#pragma once

#include "frame/frame.h"
#include "on_device.h"

namespace relief::test {

inline SurfaceSampler& sampler() {
    static SurfaceSampler instance(device());
    return instance;
}

/// A picture of a cage as it stands, seen from somewhere.
inline RenderOptions optionsFor(const Cage& cage, const CameraOptions& from = {}) {
    RenderOptions options;
    const std::vector<dvec3> points(cage.positions.begin(), cage.positions.end());
    for (const dvec3& p : points) options.bounds.add(p);
    options.camera = frameCamera(points, from, 1);
    return options;
}

/// Smooth, tileable, both signs: `waves` periods each way of the given amplitude in cage units.
inline HeightMap sineMap(int side, double amplitude, int waves = 2) {
    std::vector<float> texels(std::size_t(side) * std::size_t(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double s = (x + 0.5) / side, t = 1 - (y + 0.5) / side, k = 6.283185307179586 * waves;
            texels[std::size_t(y) * std::size_t(side) + std::size_t(x)] = float(std::sin(k * s) * std::cos(k * t));
        }
    return makeHeightMap(side, side, std::move(texels), 0, amplitude, Wrap::repeat);
}

} // namespace relief::test
