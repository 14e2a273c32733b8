// Maps for the ball, painted by direction from its middle: orange, moon and globe.
#pragma once

#include "painting.h"
#include "simple_cages.h"
#include "stamps.h"

namespace relief::meshes {

inline Painting paintBall(const ivec2& size, const std::function<Paint(const dvec3& direction)>& painter) {
    Cage cage = makeBall();
    Atlas atlas(cage, size.x, size.y);
    return paintAtlas(atlas, size, [&](const SurfacePoint& point) { return painter(glm::normalize(point.p)); });
}

/// Point i of n, evenly spread over the sphere along a spiral.
inline dvec3 spiralPoint(double i, double n) {
    double y = 1 - 2 * (i + 0.5) / n, turn = i * kPi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - y * y);
    return {r * std::sin(turn), y, r * std::cos(turn)};
}

/// Peel with pores of three sizes, a dimple with creases and the button of the stem at the top.
inline Painting paintOrange(const ivec2& size) {
    // Pores, spread evenly but not regularly; small ones are the most frequent.
    constexpr int kPores = 7500;
    Stamps pores(0.05);
    Random random(3);
    for (int i = 0; i < kPores; ++i) {
        dvec3 jitter = random.inBox();
        double luck = random();
        pores.add({glm::normalize(spiralPoint(i, kPores) + 0.012 * jitter), 0.012 + 0.014 * luck * luck, {}, luck, 0});
    }
    return paintBall(size, [&](const dvec3& d) {
        // Heights: lumps and pores, the dimple with creases around the stem, and its button.
        double pit = 0;
        pores.forEachNear(d, [&](const Stamp& pore, double x) { pit += (0.5 + 0.5 * pore.luck) * bump(x); });
        double fromTop = std::acos(glm::clamp(d.y, -1.0, 1.0)), turn = std::atan2(d.x, d.z);
        double creases = std::pow(0.5 + 0.5 * std::cos(7 * turn + 3 * noise(d * 4.0, 7)), 2.0);
        double navel = std::exp(-std::pow(fromTop / 0.20, 2)), button = smoothstep(0.085, 0.06, fromTop);
        double lumps = 0.016 * fractal(d * 2.2, 3, 5) + 0.006 * fractal(d * 13.0, 2, 9);
        double height = lumps - 0.010 * pit * (1 - button) - 0.035 * d.y * d.y;
        height += navel * (-0.055 - 0.022 * creases * smoothstep(0.05, 0.12, fromTop));
        height += button * (0.035 + 0.012 * fractal(d * 40.0, 2, 15));
        // Colors: darker in pores, greener towards the stem.
        double tint = fractal(d * 1.6, 3, 11);
        dvec3 color = glm::mix(dvec3(0.94, 0.50, 0.06), dvec3(0.97, 0.62, 0.12), smoothstep(-0.3, 0.3, tint));
        color = glm::mix(color, dvec3(0.84, 0.36, 0.03), 0.5 * std::min(1.0, pit));
        color = glm::mix(color, dvec3(0.66, 0.60, 0.14), 0.6 * std::exp(-std::pow(fromTop / 0.16, 2)));
        return Paint{height, glm::mix(color, dvec3(0.36, 0.38, 0.16), button)};
    });
}

/// Craters as on the Moon: the smaller the more; old ones are worn down, the youngest have rays.
class MoonCraters {
public:
    MoonCraters() {
        Random random(19);
        for (const auto& [count, low, high] : {Band{11, 0.18, 0.32}, Band{75, 0.08, 0.18}, Band{420, 0.035, 0.08},
                                               Band{2200, 0.016, 0.035}, Band{7000, 0.008, 0.016}})
            for (int i = 0; i < count; ++i) strew(low, high, random);
    }
    [[nodiscard]] double height(const dvec3& d) const {
        double sum = 0;
        craters_.forEachNear(d, [&](const Stamp& crater, double x) { sum += crater.radius * profile(crater, x, d); });
        return sum;
    }
    /// 0 away from rays, 1 in the bright middle of a young crater.
    [[nodiscard]] double rays(const dvec3& d) const {
        double sum = 0;
        for (const Stamp& crater : young_) {
            double x = glm::distance(d, crater.center) / crater.radius;
            if (x > 11) continue;
            dvec3 side = glm::normalize(glm::cross(crater.center, dvec3(0.3, 1, 0.2)));
            double turn = std::atan2(glm::dot(d, side), glm::dot(d, glm::cross(side, crater.center)));
            dvec3 around(2.6 * std::cos(turn), 2.6 * std::sin(turn), 0.10 * x + 9 * crater.luck);
            double streak = smoothstep(0.02, 0.55, noise(around, 27) + 0.5 * noise(around * 3.0, 28));
            double fade = 1 - smoothstep(2.0, 11.0, x);
            sum += (1 - smoothstep(1.1, 2.2, x)) * 0.7 + streak * fade * fade;
        }
        return std::min(1.0, sum);
    }

private:
    struct Band {
        int count;
        double low, high;
    };
    /// Small sizes are likelier within a band; a few are young.
    void strew(double low, double high, Random& random) {
        dvec3 d = random.inBox();
        while (glm::length(d) > 1 || glm::length(d) < 0.1) d = random.inBox(); // no denser towards the box's corners
        double t = random(), luck = random();
        Stamp crater{glm::normalize(d), low * std::pow(high / low, t * t), {}, luck, 0};
        craters_.add(crater);
        if (luck > 0.955 && crater.radius > 0.035 && crater.radius < 0.14 && young_.size() < 7)
            young_.push_back(crater);
    }
    /// Bowl, raised rim and apron; large ones have a flat floor and a central peak. x: distance over the radius.
    static double profile(const Stamp& crater, double x, const dvec3& d) {
        double fresh = 0.35 + 0.65 * crater.luck * crater.luck, wide = smoothstep(0.06, 0.20, crater.radius);
        if (crater.radius > 0.03) // ragged rims
            x += 0.07 * noise(d * (2.5 / crater.radius), 31) * smoothstep(0.5, 1.0, x);
        double bowl = std::max(x * x - 1, glm::mix(-1.0, -0.55, wide)) * glm::mix(0.36, 0.20, wide);
        double inside = x < 1 ? bowl : 0, w = x < 1 ? 0.20 : 0.34, rim = (x - 1) / w;
        double crest = glm::mix(0.10, 0.07, wide) * std::exp(-rim * rim), peak = 0.10 * wide * bump(x / 0.28);
        return fresh * (inside + crest + peak);
    }
    Stamps craters_{0.08, 1.9};
    std::vector<Stamp> young_;
};

inline Painting paintMoon(const ivec2& size) {
    MoonCraters craters;
    return paintBall(size, [&](const dvec3& d) {
        double basin = fractal(warped(d, 1.4, 0.25, 47) * 1.15, 4, 45), mare = smoothstep(0.04, 0.20, basin);
        double rough = 0.014 * fractal(d * 6.0, 3, 49) + 0.004 * fractal(d * 45.0, 3, 51);
        double height = craters.height(d) * (1 - 0.55 * mare) + rough * (1 - 0.7 * mare) - 0.030 * mare;
        double shade = 0.60 + 0.10 * fractal(d * 5.0, 4, 53) + 0.9 * height - 0.17 * mare;
        shade = glm::mix(shade, 0.92, 0.55 * craters.rays(d));
        return Paint{height, dvec3(1.0, 0.975, 0.94) * shade};
    });
}

/// A globe with land above sea: -1 at the bottom of the sea, 0 on its shores.
inline double globeElevation(const dvec3& d, int octaves) {
    const double continents = fractal(warped(d, 1.3, 0.35, 61) * 1.05, octaves, 63) - 0.06;
    const double ridge = 1 - std::abs(fractal(warped(d, 2.5, 0.2, 65) * 2.6, std::max(1, octaves - 1), 67)) * 3.2;
    return continents + 0.22 * std::max(0.0, ridge) * smoothstep(0.05, 0.3, continents);
}

/// The globe's heights as far as triangles carry them, and its colors by height and latitude.
inline Painting paintGlobe(const ivec2& size) {
    return paintBall(size, [](const dvec3& d) {
        const double fine = globeElevation(d, 8), land = smoothstep(-0.004, 0.006, fine);
        dvec3 sea = glm::mix(dvec3(0.10, 0.34, 0.46), dvec3(0.03, 0.10, 0.24), smoothstep(0.0, -0.18, fine));
        const double dry = smoothstep(-0.15, 0.25, fractal(d * 2.3, 4, 69) + 0.35 - 1.1 * std::abs(d.y - 0.1));
        dvec3 ground = glm::mix(dvec3(0.16, 0.30, 0.10), dvec3(0.62, 0.50, 0.28), dry);
        ground = glm::mix(ground, dvec3(0.40, 0.33, 0.26), smoothstep(0.16, 0.34, fine));
        const double cold = std::abs(d.y) + 0.55 * std::max(0.0, fine) + 0.05 * fractal(d * 9.0, 3, 71);
        ground = glm::mix(ground, dvec3(0.93, 0.94, 0.96), smoothstep(0.80, 0.88, cold));
        sea = glm::mix(sea, dvec3(0.86, 0.90, 0.94), smoothstep(0.92, 0.96, cold)); // ice
        return Paint{0.16 * std::max(0.0, globeElevation(d, 5)), glm::mix(sea, ground, land)};
    });
}

/// What the globe's normal map shows: all octaves of the land, and swell on the sea.
inline Painting paintGlobeDetail(const ivec2& size) {
    return paintBall(size, [](const dvec3& d) {
        const double fine = globeElevation(d, 9), coarse = globeElevation(d, 5);
        const double swell = 0.0006 * fractal(d * 60.0, 2, 73) * smoothstep(0.0, -0.02, fine);
        return Paint{0.16 * (std::max(0.0, fine) - std::max(0.0, coarse)) + swell, dvec3(1)};
    });
}

} // namespace relief::meshes
