// The strawberry's maps: seeds in pits along a spiral, cushions of flesh between them, veined sepals.
#pragma once

#include "painting.h"
#include "stamps.h"
#include "strawberry.h"

namespace relief::meshes {

class StrawberrySkin {
public:
    StrawberrySkin(const Cage& cage, const ReferenceSurface& surface) : cage_(cage) { sowSeeds(surface); }
    [[nodiscard]] Paint at(const SurfacePoint& point) const;

private:
    void sowSeeds(const ReferenceSurface& surface);
    [[nodiscard]] Paint fruit(const dvec3& p) const;
    [[nodiscard]] static Paint leaf(const dvec3& p, double along, double across, bool isUpper);
    [[nodiscard]] static Paint stem(const dvec3& p);

    const Cage& cage_;
    Stamps seeds_{0.12, 1.6};
};

/// Every next seed stands a golden angle further round; rows are found so that all get the same share of the skin.
inline void StrawberrySkin::sowSeeds(const ReferenceSurface& surface) {
    constexpr int kSeeds = 230, kSteps = 400, kLastRow = 8;
    std::vector<double> area{0};
    auto at = [&](double row, double column) {
        int face = std::min(int(row), kLastRow - 1) * kBerryColumns + int(column);
        return surface.limit(face, {column - std::floor(column), row - std::min(int(row), kLastRow - 1)});
    };
    for (int i = 0; i < kSteps; ++i) {
        LimitFrame frame = at((i + 0.5) * kLastRow / kSteps, 0.5);
        area.push_back(area.back() + glm::length(glm::cross(frame.pu, frame.pv)));
    }
    Random random(23);
    for (int i = 0; i < kSeeds; ++i) {
        double share = area.back() * (i + 0.5) / kSeeds;
        double row = double(std::lower_bound(area.begin(), area.end(), share) - area.begin()) * kLastRow / kSteps;
        double column = std::fmod(i * 0.381966 * kBerryColumns, double(kBerryColumns));
        LimitFrame frame = at(std::min(row, kLastRow - 0.01), column);
        dvec3 down = -glm::normalize(frame.pv);
        seeds_.add({frame.p, 0.105 * random(0.92, 1.06), down, random(), 0});
    }
    for (int i = 0; i < 5; ++i) // the very tip
        seeds_.add({{0.17 * std::sin(i * 1.2566), -1.30, 0.17 * std::cos(i * 1.2566)}, 0.1, {0, 0, 1}, random(), 0});
}

inline Paint StrawberrySkin::fruit(const dvec3& p) const {
    double pit = 0, kernel = 0, luck = 0;
    seeds_.forEachNear(p, [&](const Stamp& seed, double x) {
        dvec3 d = (p - seed.center) / seed.radius;
        double along = glm::dot(d, seed.axis), across = std::sqrt(std::max(0.0, glm::dot(d, d) - along * along));
        double oval = std::hypot(along / 0.44, across / (0.27 - 0.10 * along)); // pointed below
        pit = std::max(pit, bump(x / 0.95));
        if (oval < 1) kernel = std::sqrt(1 - oval * oval), luck = seed.luck;
    });
    double shoulder = smoothstep(0.35, 0.72, p.y), bare = 1 - smoothstep(0.66, 0.73, p.y);
    double lumps = 0.05 * fractal(p * 1.6, 2, 61) + 0.0025 * fractal(p * 40.0, 2, 63);
    double height = lumps + bare * (0.030 - 0.058 * pit + 0.034 * kernel);
    dvec3 color =
        glm::mix(dvec3(0.78, 0.05, 0.05), dvec3(0.62, 0.02, 0.04), smoothstep(-0.3, 0.3, fractal(p * 2.5, 3, 65)));
    color = glm::mix(color, dvec3(0.90, 0.36, 0.22), 0.75 * shoulder * shoulder);
    color = glm::mix(color, dvec3(0.48, 0.01, 0.03), 0.45 * bare * pit);
    dvec3 seed = glm::mix(dvec3(0.90, 0.70, 0.30), dvec3(0.80, 0.50, 0.16), luck);
    return {height, glm::mix(color, seed, bare * smoothstep(0.05, 0.35, kernel))};
}

/// A midrib, side veins that run forward, a rough green; paler below.
inline Paint StrawberrySkin::leaf(const dvec3& p, double along, double across, bool isUpper) {
    double rib = std::exp(-std::pow(across / 0.10, 2)), phase = 2.2 * along - 1.3 * std::abs(across);
    double vein = std::exp(-std::pow((phase - std::round(phase)) / 0.12, 2)) * smoothstep(0.05, 0.2, std::abs(across));
    double sign = isUpper ? -1 : 1, fade = smoothstep(0.2, 1.2, along) * smoothstep(5.2, 4.4, along);
    double height = fade * (sign * (0.016 * rib + 0.009 * vein) + 0.010 * fractal(p * 9.0, 3, 67));
    double fresh = 0.5 + 0.5 * fractal(p * 5.0, 3, 69);
    dvec3 color = glm::mix(dvec3(0.16, 0.34, 0.09), dvec3(0.36, 0.54, 0.16), fresh);
    color = glm::mix(color, dvec3(0.58, 0.70, 0.34), 0.5 * std::max(rib, 0.7 * vein) * fade);
    return {height, isUpper ? color : glm::mix(color, dvec3(0.62, 0.72, 0.48), 0.45)};
}

inline Paint StrawberrySkin::stem(const dvec3& p) {
    double grain = fractal(p * dvec3(26, 6, 26), 3, 71);
    return {0.006 * grain, glm::mix(dvec3(0.38, 0.50, 0.18), dvec3(0.56, 0.62, 0.30), 0.5 + grain)};
}

inline Paint StrawberrySkin::at(const SurfacePoint& point) const {
    const CagePart* part = &cage_.parts.front();
    for (const CagePart& candidate : cage_.parts)
        if (point.face >= int(candidate.firstFace)) part = &candidate;
    if (part->name == "fruit" || part->name == "tip" || part->name == "top") {
        Paint paint = fruit(point.p);
        double green = smoothstep(0.66, 0.72, point.p.y);
        return {paint.height * (1 - green), glm::mix(paint.albedo, stem(point.p).albedo, green)};
    }
    if (part->name == "stem") {
        Paint paint = stem(point.p);
        return {paint.height * smoothstep(0.72, 0.85, point.p.y), paint.albedo};
    }
    int local = point.face - int(part->firstFace), column = local % 6;
    double turn = column + point.uv.x; // 0 and 6 above the midrib, 3 below it
    double across = std::min({turn, std::abs(turn - 3), 6 - turn}) / 1.5;
    int row = local / 6;
    double along = row >= kSepalRows ? kSepalRows : row + point.uv.y;
    return leaf(point.p, along, across, column < 1 || column > 4 || std::abs(turn - 3) > 1.5);
}

inline Painting paintStrawberry(const ivec2& size) {
    Cage cage = makeStrawberry();
    Atlas atlas(cage, size.x, size.y);
    StrawberrySkin skin(cage, atlas.surface());
    return paintAtlas(atlas, size, [&](const SurfacePoint& point) { return skin.at(point); });
}

} // namespace relief::meshes
