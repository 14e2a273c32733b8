// The octopus' head and mantle: rings around a leaning spine, with gaps where eyes, siphon and arms are set in.
#pragma once

#include "grid.h"

namespace relief::meshes {

constexpr int kColumns = 24; ///< three per arm: a web column, then two under which the arm begins

/// A ring of the body: its centre, lean backwards in degrees, radii across and front to back, and how far the ridges
/// that become arms stand out and up (the valleys between them fall back as much).
struct BodyRing {
    double x, y, z, lean, across, deep, ridge, lift;
};

/// From the lower edge of the arms' roots over the web and the head to the shoulder of the mantle, where the cap
/// begins.
inline const std::vector<BodyRing>& bodyRings() {
    static const std::vector<BodyRing> rings{
        {0.00, 0.06, 0.00, 0, 1.04, 1.02, 0.07, 0.00},   // under the arms
        {0.00, 0.42, 0.00, 0, 1.12, 1.10, 0.10, 0.10},   // above the arms, edge of the web
        {0.00, 0.57, 0.00, 0, 0.92, 0.90, 0.06, 0.08},   //
        {0.00, 0.75, 0.00, 2, 0.76, 0.75, 0.035, 0.05},  //
        {0.00, 0.94, 0.00, 4, 0.665, 0.66, 0.015, 0.02}, //
        {0.00, 1.10, -0.01, 6, 0.63, 0.63, 0.00, 0.00},  // lower edge of the eyes
        {0.00, 1.28, -0.03, 10, 0.61, 0.61, 0.00, 0.00}, // their middle
        {0.00, 1.46, -0.06, 14, 0.59, 0.60, 0.00, 0.00}, // their upper edge
        {0.01, 1.61, -0.10, 18, 0.60, 0.62, 0.00, 0.00}, // neck
        {0.03, 1.78, -0.17, 22, 0.72, 0.74, 0.00, 0.00}, //
        {0.06, 2.02, -0.29, 26, 0.90, 0.90, 0.00, 0.00}, // mantle
        {0.10, 2.33, -0.46, 30, 0.99, 1.00, 0.00, 0.00}, //
        {0.14, 2.66, -0.66, 34, 0.95, 0.98, 0.00, 0.00}, //
        {0.18, 2.94, -0.85, 38, 0.76, 0.80, 0.00, 0.00}, // shoulder
    };
    return rings;
}
constexpr int kEyeRow = 6; ///< the ring through the eyes' middles
constexpr double kEyeColumns[2] = {4, 21};

/// Azimuth of column j, degrees from the front (+Z) towards +X; column 0.5 is the front, arms are centred on 2, 5, 8,
/// ...
inline double columnAzimuth(double j) { return 15 * j - 7.5; }

/// The point of a ring at a column, `shrink` times as far from its centre.
inline dvec3 ringPoint(const BodyRing& ring, double column, double shrink = 1) {
    double azimuth = radians(columnAzimuth(column)), lean = radians(ring.lean);
    double wave = std::cos(radians(120 * (column - 2))), factor = (1 + ring.ridge * wave) * shrink;
    double x = std::sin(azimuth) * ring.across * factor, f = std::cos(azimuth) * ring.deep * factor;
    return {ring.x + x, ring.y + ring.lift * wave + f * std::sin(lean), ring.z + f * std::cos(lean)};
}

/// An eye's frame: its axis looks out of the head and a little up.
struct Eye {
    dvec3 center, axis, right, up;
};

inline Eye octopusEye(int index) {
    double azimuth = radians(columnAzimuth(kEyeColumns[index])), lift = radians(16);
    dvec3 axis(std::sin(azimuth) * std::cos(lift), std::sin(lift), std::cos(azimuth) * std::cos(lift));
    dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), axis));
    return {ringPoint(bodyRings()[kEyeRow], kEyeColumns[index]), axis, right, glm::cross(axis, right)};
}

/// The funnel leaves the neck between two rings, two columns wide.
constexpr int kSiphonRow = 7, kSiphonColumn = 6;
struct Siphon {
    dvec3 root, out, bend; ///< its axis: root + t out + t^2 bend, t = 0..0.3 at the mouth
};
inline Siphon octopusSiphon() {
    double azimuth = radians(columnAzimuth(kSiphonColumn + 1));
    dvec3 below = ringPoint(bodyRings()[kSiphonRow], kSiphonColumn + 1);
    dvec3 above = ringPoint(bodyRings()[kSiphonRow + 1], kSiphonColumn + 1);
    return {0.5 * (below + above), {std::sin(azimuth), 0, std::cos(azimuth)}, dvec3(0, -1, 2)};
}

/// A turn around an eye: radius, height above the eye's centre along its axis, and how far its upper half hangs down.
struct EyeRing {
    double radius, height, droop;
};
inline constexpr EyeRing kEyeRings[] = {
    {0.280, 0.070, 0.00}, // foot of the mound, on the body
    {0.250, 0.160, 0.00}, // wall
    {0.220, 0.205, 0.10}, // outer lip of the lid
    {0.188, 0.215, 0.26}, // inner lip
    {0.172, 0.165, 0.14}, // the fold where lid and eyeball meet
    {0.155, 0.205, 0.00}, // eyeball
    {0.100, 0.265, 0.00}, //
};
constexpr double kEyeTop = 0.290;

inline dvec3 eyeRingPoint(const Eye& eye, const EyeRing& ring, double degrees) {
    double x = std::cos(radians(degrees)), y = std::sin(radians(degrees)), lid = ring.droop * std::max(0.0, y);
    return eye.center + ring.radius * (x * eye.right + y * (1 - lid) * eye.up) + (ring.height + 0.25 * lid) * eye.axis;
}

/// Skin near an eye swells outward, so that the eyes sit on turrets.
inline dvec3 swellAroundEyes(dvec3 p) {
    for (int i = 0; i < 2; ++i) {
        Eye eye = octopusEye(i);
        double distance = glm::length(p - eye.center);
        p += eye.axis * 0.12 * std::exp(-distance * distance / (0.32 * 0.32));
    }
    return p;
}

} // namespace relief::meshes
