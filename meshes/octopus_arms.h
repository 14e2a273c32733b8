// The eight arms of the octopus: how each one lies, as cross sections along a curve.
#pragma once

#include "cage_builder.h"

namespace relief::meshes {

/// The arm's heading at `s`, 0 at the body and 1 at the tip. Degrees: yaw left of the direction in which the arm leaves
/// the body, pitch above the horizon (past 90 it bends over backwards), roll counter-clockwise about the arm.
struct ArmKey {
    double s, yaw, pitch, roll;
};

/// From s = start to the tip the arm winds up by so many further degrees, as a logarithmic spiral.
struct ArmCurl {
    double start = 1, yaw = 0, pitch = 0;
};

struct Arm {
    double length, radius;
    std::vector<ArmKey> keys;
    ArmCurl curl;
};

/// A cross section: an orthonormal frame (`side` = up x along, left as seen along the arm) and the limit radius.
struct ArmSection {
    dvec3 center, along, up, side;
    double radius;
};

constexpr int kArmCount = 8;
constexpr int kArmRows = 30; ///< quads along an arm
constexpr int kArmSides = 6; ///< quads around it

/// Azimuth of arm k at the body, degrees from the front (+Z) towards +X.
inline double armAzimuth(int k) { return 22.5 + 45 * k; }

inline const std::array<Arm, kArmCount>& octopusArms() {
    static const std::array<Arm, kArmCount> arms{{
        // Front right: flows forward, then rears and shows its suckers.
        {3.6,
         0.29,
         {{0, 0, -26, 0}, {0.2, -4, -10, 0}, {0.45, 22, 2, 0}, {0.65, 34, 30, 0}, {1, 30, 60, 0}},
         {0.52, -60, 330}},
        // Right: long and low, its tip curls up over itself.
        {3.8,
         0.29,
         {{0, 0, -24, 0}, {0.22, -10, -8, 0}, {0.45, 12, 4, 0}, {0.7, 20, 20, 0}, {1, 25, 40, 0}},
         {0.5, 0, 460}},
        // Right behind: an S on the ground.
        {3.6,
         0.28,
         {{0, 0, -24, 0}, {0.25, 25, -6, 0}, {0.5, -30, 0, 0}, {0.8, 20, 2, 0}, {1, 0, 5, 0}},
         {0.55, 400, 0}},
        // Behind, right: lifts its tip behind the body.
        {3.7,
         0.28,
         {{0, 0, -20, 0}, {0.25, -20, 5, 0}, {0.5, -30, 45, 0}, {0.8, -30, 75, 0}, {1, -30, 80, 0}},
         {0.5, 0, 400}},
        // Behind, left: flat.
        {3.5,
         0.28,
         {{0, 0, -24, 0}, {0.25, -20, -6, 0}, {0.5, -35, 0, 0}, {0.8, 10, 2, 0}, {1, 20, 4, 0}},
         {0.55, -420, 0}},
        // Left behind: a wide bow.
        {3.7,
         0.29,
         {{0, 0, -24, 0}, {0.25, 15, -8, 0}, {0.5, -20, 0, 0}, {0.8, -40, 2, 0}, {1, -50, 4, 0}},
         {0.53, 450, 0}},
        // Left: the lifted one, a tall S that ends in a spiral against the sky.
        {4.2,
         0.30,
         {{0, 0, -12, 0}, {0.15, 0, 16, 0}, {0.4, 5, 70, 0}, {0.62, 5, 84, 0}, {1, 0, 60, 0}},
         {0.48, 0, -520}},
        // Front left: flows forward and winds up on the ground.
        {3.6,
         0.29,
         {{0, 0, -26, 0}, {0.2, 8, -10, 0}, {0.45, -25, 0, 0}, {0.7, -50, 2, -20}, {1, -50, 6, -40}},
         {0.5, 480, 0}},
    }};
    return arms;
}

/// Cubic Hermite through the keys with finite-difference slopes.
inline ArmKey headingAt(const std::vector<ArmKey>& keys, double s) {
    auto vec = [&](std::size_t i) { return dvec3(keys[i].yaw, keys[i].pitch, keys[i].roll); };
    auto slope = [&](std::size_t i) {
        std::size_t a = i ? i - 1 : 0, b = std::min(i + 1, keys.size() - 1);
        return (vec(b) - vec(a)) / (keys[b].s - keys[a].s);
    };
    std::size_t i = 0;
    while (i + 2 < keys.size() && s > keys[i + 1].s) ++i;
    double width = keys[i + 1].s - keys[i].s, t = (s - keys[i].s) / width, t2 = t * t, t3 = t2 * t;
    dvec3 v = (2 * t3 - 3 * t2 + 1) * vec(i) + (t3 - 2 * t2 + t) * width * slope(i) + (3 * t2 - 2 * t3) * vec(i + 1) +
              (t3 - t2) * width * slope(i + 1);
    return {s, v.x, v.y, v.z};
}

/// 0 at the start of the curl, 1 at the tip; curvature grows as the inverse of what is left of the arm.
inline double curlAt(double start, double s) {
    constexpr double kLeftAtTip = 0.1;
    if (s <= start) return 0;
    double left = 1 - (s - start) / (1 - start) * (1 - kLeftAtTip);
    return std::log(left) / std::log(kLeftAtTip);
}

inline double armRadius(const Arm& arm, double s) { return arm.radius * (0.05 + 0.95 * std::pow(1 - s, 1.05)); }

/// The frame at `s` of an arm that leaves the body at `azimuth`; centre and radius are not set.
inline ArmSection frameAt(const Arm& arm, double azimuth, double s) {
    ArmKey key = headingAt(arm.keys, s);
    double curl = curlAt(arm.curl.start, s);
    double yaw = radians(azimuth + key.yaw + curl * arm.curl.yaw), pitch = radians(key.pitch + curl * arm.curl.pitch);
    dvec3 ahead(std::sin(yaw), 0, std::cos(yaw)), left(std::cos(yaw), 0, -std::sin(yaw)), y(0, 1, 0);
    dvec3 along = std::cos(pitch) * ahead + std::sin(pitch) * y, up = std::cos(pitch) * y - std::sin(pitch) * ahead;
    double c = std::cos(radians(key.roll)), r = std::sin(radians(key.roll));
    return {{}, along, c * up + r * left, c * left - r * up, 0};
}

/// Sections 1..kArmRows (section 0 is the loop on the body, centred at `start`), closer together where the arm is thin.
inline std::vector<ArmSection> sweepArm(const Arm& arm, double azimuth, const dvec3& start) {
    constexpr int kSteps = 2000;
    auto density = [&](double s) { return 1 / (armRadius(arm, s) + 0.03); };
    double total = 0;
    for (int i = 0; i < kSteps; ++i) total += density((i + 0.5) / kSteps);
    std::vector<ArmSection> sections;
    dvec3 center = start;
    double passed = 0;
    for (int i = 0; i < kSteps; ++i) {
        double s = (i + 0.5) / kSteps;
        ArmSection section = frameAt(arm, azimuth, s);
        center += section.along * (arm.length / kSteps);
        passed += density(s);
        if (passed < total * double(sections.size() + 1) / kArmRows - 1e-9) continue;
        section.center = center;
        section.radius = armRadius(arm, s);
        sections.push_back(section);
    }
    return sections;
}

} // namespace relief::meshes
