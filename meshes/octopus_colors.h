// The octopus' albedo: warm mottled red above, pale below, golden eyes with a level bar for a pupil.
#pragma once

#include "octopus_skin.h"

namespace relief::meshes {

inline dvec3 eyeColor(const dvec3& p, const Eye& eye) {
    dvec3 d = p - eye.center;
    double x = glm::dot(d, eye.right), y = glm::dot(d, eye.up), r = std::hypot(x, y);
    double streaks = 0.5 + 0.5 * noise(dvec3(30 * std::atan2(y, x) / kPi, r * 8, 3), 71);
    dvec3 iris = glm::mix(dvec3(0.62, 0.40, 0.10), dvec3(0.95, 0.78, 0.36), streaks * smoothstep(0.17, 0.05, r));
    iris = glm::mix(iris, dvec3(0.20, 0.08, 0.04), smoothstep(0.130, 0.165, r));
    double bar = std::hypot(std::max(0.0, std::abs(x) - 0.065), y * 1.15); // distance from a level line
    return glm::mix(dvec3(0.02, 0.015, 0.02), iris, smoothstep(0.034, 0.042, bar));
}

constexpr dvec3 kRust(0.42, 0.10, 0.06), kCream(0.96, 0.82, 0.66);

/// Orange to rust in clouds, darker between the plates, speckled, with light papillae.
inline dvec3 upperColor(const SkinPoint& skin, double clouds) {
    const dvec3 kRed(0.74, 0.25, 0.12), kOrange(0.90, 0.47, 0.20);
    dvec3 color = glm::mix(kRed, kRust, smoothstep(0.05, 0.45, clouds));
    color = glm::mix(color, kOrange, 0.85 * smoothstep(0.05, -0.35, clouds));
    color = glm::mix(color, kRust * 0.8, 0.45 * skin.groove * (0.3 + 0.7 * skin.calm));
    color = glm::mix(color, kCream, 0.55 * skin.wartTip);
    return glm::mix(color, kRust, 0.35 * smoothstep(0.30, 0.42, noise(skin.p * 34.0, 87)));
}

inline dvec3 lowerColor(const SkinPoint& skin) {
    dvec3 color = glm::mix(kCream, dvec3(0.93, 0.66, 0.52), smoothstep(-0.2, 0.4, fractal(skin.p * 4.0, 2, 89)));
    color = glm::mix(color, dvec3(0.98, 0.87, 0.78), 1 - smoothstep(0.85, 1.1, skin.sucker));
    return glm::mix(color, dvec3(0.62, 0.30, 0.24), 1 - smoothstep(0.22, 0.55, skin.sucker));
}

inline dvec3 skinColor(const SkinPoint& skin) {
    double clouds = fractal(warped(skin.p, 2.5, 0.2, 81) * 1.9, 4, 83);
    double pale = smoothstep(0.25, 0.85, skin.belly + 0.25 * clouds);
    if (pale == 0) return upperColor(skin, clouds);
    if (pale == 1) return lowerColor(skin);
    return glm::mix(upperColor(skin, clouds), lowerColor(skin), pale);
}

inline dvec3 octopusColor(const SkinPoint& skin, const Eye& eye) {
    dvec3 color = skinColor(skin);
    color = glm::mix(color, dvec3(0.16, 0.04, 0.04), 1 - smoothstep(0.070, 0.092, skin.funnel));
    if (skin.eyeAxis > 0.4) return color;
    color = glm::mix(color, dvec3(0.30, 0.07, 0.05), 0.7 * (1 - smoothstep(0.18, 0.30, skin.eyeAxis)));
    return glm::mix(eyeColor(skin.p, eye), color, smoothstep(0.160, 0.172, skin.eyeAxis));
}

inline Painting paintOctopus(const ivec2& size) {
    Cage cage = makeOctopus();
    Atlas atlas(cage, size.x, size.y);
    OctopusSkin octopus(cage, atlas.surface());
    return paintAtlas(atlas, size, [&](const SurfacePoint& point) {
        SkinPoint skin = octopus.at(point);
        return Paint{OctopusSkin::height(skin), octopusColor(skin, octopus.eye(skin.eye))};
    });
}

} // namespace relief::meshes
