// Formulas after Barr, "Global and Local Deformations of Solid Primitives", SIGGRAPH 1984, whose names of sections are
// quoted; here relative to the centre of a box, and for any axis.
#include "animation/deformers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

double sideOf(const Bounds& box, int axis) { return box.upper[axis] - box.lower[axis]; }

/// Turns p about the axis through the centre, counter-clockwise seen from its tip.
dvec3 turned(dvec3 p, const dvec3& center, int axis, double angle) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const dvec2 d(p[i] - center[i], p[j] - center[j]);
    const double C = std::cos(angle), S = std::sin(angle);
    p[i] = center[i] + C * d.x - S * d.y;
    p[j] = center[j] + S * d.x + C * d.y;
    return p;
}

dvec3 scaled(const dvec3& p, const dvec3& center, const dvec3& factors) { return center + factors * (p - center); }

/// "Global axial twists": theta = f(z), here f linear with f = 0 at the centre.
Move twist(const DeformerMoment& moment) {
    const int axis = moment.axis(0);
    const double angle = glm::radians(moment.values[1]), side = sideOf(moment.box, axis);
    if (angle == 0 || side == 0) return {};
    return [=, center = moment.box.center()](const dvec3& p) {
        return turned(p, center, axis, angle * ((p[axis] - center[axis]) / side));
    };
}

/// "Global linear bends": the line through the centre along y becomes an arc of the same length and of curvature k;
/// beyond the box (y outside ymin..ymax) it goes on straight. With y from the centre and z toward the arc's middle:
///   theta = k y^,  Y = -S (z - 1/k) + C (y - y^),  Z = C (z - 1/k) + 1/k + S (y - y^),  y^ = y clamped to the box.
/// S/k = y^ S/theta and (1 - C)/k = y^ (2 sin^2(theta/2))/theta are written so that small k stay exact.
Move bend(const DeformerMoment& moment) {
    const int along = moment.axis(0), toward = moment.axis(2);
    const double angle = glm::radians(moment.values[1]), side = sideOf(moment.box, along);
    if (angle == 0 || side == 0) return {};
    return [=, center = moment.box.center()](dvec3 p) {
        const double y = p[along] - center[along], z = p[toward] - center[toward];
        const double bent = std::clamp(y, -side / 2, side / 2), theta = angle * (bent / side);
        if (theta == 0) return p;
        const double C = std::cos(theta), S = std::sin(theta), half = std::sin(theta / 2);
        p[along] = center[along] + bent * (S / theta) - S * z + C * (y - bent);
        p[toward] = center[toward] + bent * (2 * half * half / theta) + C * z + S * (y - bent);
        return p;
    };
}

/// A travelling sine.
Move wave(const DeformerMoment& moment) {
    const int axis = moment.axis(0), along = moment.axis(4);
    const double unit = moment.box.longestSide();
    const double height = moment.values[1] * unit, length = moment.values[2] * unit;
    const double shift = moment.values[3] * unit * moment.seconds;
    if (height == 0) return {};
    return [=, center = moment.box.center()](dvec3 p) {
        p[axis] += height * std::sin(2 * std::numbers::pi * ((p[along] - center[along] - shift) / length));
        return p;
    };
}

/// "Scaling" with factors whose product is 1: the determinant of the Jacobian, by which volumes grow.
Move squash(const DeformerMoment& moment) {
    const double along = 1 - moment.values[1];
    if (along == 1) return {};
    dvec3 factors(1 / std::sqrt(along));
    factors[moment.axis(0)] = along;
    return [=, center = moment.box.center()](const dvec3& p) { return scaled(p, center, factors); };
}

/// "Global tapering": r = f(z), here linear from 1 at the box's lower end and constant beyond it.
Move taper(const DeformerMoment& moment) {
    const int axis = moment.axis(0);
    const double amount = moment.values[1], lower = moment.box.lower[axis], side = sideOf(moment.box, axis);
    if (amount == 0 || side == 0) return {};
    return [=, center = moment.box.center()](const dvec3& p) {
        dvec3 factors(1 - amount * std::clamp((p[axis] - lower) / side, 0.0, 1.0));
        factors[axis] = 1;
        return scaled(p, center, factors);
    };
}

Move translate(const DeformerMoment& moment) {
    const dvec3 offset(moment.values[0], moment.values[1], moment.values[2]);
    if (offset == dvec3(0)) return {};
    return [step = offset * moment.box.longestSide()](const dvec3& p) { return p + step; };
}

Move rotate(const DeformerMoment& moment) {
    const double angle = glm::radians(moment.values[1]);
    if (angle == 0) return {};
    return [=, axis = moment.axis(0), center = moment.box.center()](const dvec3& p) {
        return turned(p, center, axis, angle);
    };
}

Move scale(const DeformerMoment& moment) {
    const dvec3 factors(moment.values[0], moment.values[1], moment.values[2]);
    if (factors == dvec3(1)) return {};
    return [=, center = moment.box.center()](const dvec3& p) { return scaled(p, center, factors); };
}

ValueKind number(const char* name, const char* standard) { return {.name = name, .standard = standard}; }
ValueKind axis(const char* name, const char* standard) { return {.name = name, .standard = standard, .isAxis = true}; }

} // namespace

const std::vector<DeformerKind>& deformerKinds() {
    static const std::vector<DeformerKind> kinds = {
        {.name = "twist",
         .help = "turns about the axis, by `angle` degrees from one end of the box to the other",
         .values = {axis("axis", "y"), number("angle", "90")},
         .make = twist},
        {.name = "bend",
         .help = "bends what runs along the axis into an arc of `angle` degrees, its ends toward another axis",
         .values = {axis("axis", "y"), number("angle", "90"), axis("toward", "next")},
         .make = bend},
        {.name = "wave",
         .help = "displaces along `axis` by a sine that travels along `along`; lengths in longest sides of the box, "
                 "speed per second",
         .values = {axis("axis", "y"), number("amplitude", "0.05"),
                    ValueKind{.name = "wavelength", .standard = "0.5", .above = 0}, number("speed", "0.25"),
                    axis("along", "next")},
         .speedValue = 3,
         .make = wave},
        {.name = "squash",
         .help = "shorter along the axis by this part, and wider, so that the volume stays; below 0: longer",
         .values = {axis("axis", "y"), ValueKind{.name = "amount", .standard = "0.3", .below = 1}},
         .make = squash},
        {.name = "taper",
         .help = "narrower toward the axis's upper end, there by this part",
         .values = {axis("axis", "y"), number("amount", "0.5")},
         .make = taper},
        {.name = "translate",
         .help = "moves by these multiples of the longest side of the box",
         .values = {number("x", "0"), number("y", "0"), number("z", "0")},
         .make = translate},
        {.name = "rotate",
         .help = "turns about the axis by `angle` degrees",
         .values = {axis("axis", "y"), number("angle", "90")},
         .make = rotate},
        {.name = "scale",
         .help = "grows by these factors",
         .values = {number("x", "1"), number("y", "1"), number("z", "1")},
         .make = scale},
    };
    return kinds;
}

} // namespace relief
