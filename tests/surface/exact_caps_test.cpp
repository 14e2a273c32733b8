// The limit surface close to extraordinary vertices against refinement that shares no code with it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "surface/caps.h"
#include "surface/deep_oracle.h"
#include "surface/families.h"

namespace relief {
namespace {

struct Errors {
    double point = 0, tangent = 0, bend = 0, degrees = 0;
    int count = 0, approximate = 0;
};

void add(Errors& errors, const ReferenceSurface& surface, const DeepOracle::Sample& sample, double size) {
    if (surface.isHole(sample.face)) return;
    ++errors.count;
    errors.approximate += surface.isApproximate(sample.face, sample.uv) ? 1 : 0;
    const LimitFrame f = surface.limit(sample.face, sample.uv), &e = sample.frame;
    const auto relative = [](const dvec3& a, const dvec3& b) { return glm::length(a - b) / (glm::length(b) + 1e-12); };
    errors.point = std::max(errors.point, glm::length(f.p - e.p) / size);
    errors.tangent = std::max({errors.tangent, relative(f.pu, e.pu), relative(f.pv, e.pv)});
    errors.degrees = std::max(errors.degrees, degreesBetween(glm::cross(f.pu, f.pv), glm::cross(e.pu, e.pv)));
    if (surface.sideCount() == 3) return;
    const double most = std::max({glm::length(e.puu), glm::length(e.puv), glm::length(e.pvv), size});
    errors.bend = std::max({errors.bend, glm::length(f.puu - e.puu) / most, glm::length(f.puv - e.puv) / most,
                            glm::length(f.pvv - e.pvv) / most});
}

Errors errorsAround(const Family& family, std::uint32_t vertex, int deepest) {
    Errors errors;
    const ReferenceSurface surface(family.cage, {family.scheme, 2});
    DeepOracle oracle(family.cage, family.scheme, vertex);
    for (int level = 1; level <= deepest; ++level) {
        oracle.refine();
        if (level < 4) continue;
        for (const auto& sample : oracle.samples()) add(errors, surface, sample, sizeOf(family.cage));
    }
    return errors;
}

TEST(ExactCaps, Probe) {
    for (const Family& family : allFamilies()) {
        if (family.scheme == Scheme::bilinear) continue;
        Errors worst;
        const auto n = std::min<std::size_t>(family.cage.positions.size(), 12);
        for (std::uint32_t v = 0; v < n; ++v) {
            const Errors e = errorsAround(family, v, 20);
            worst.point = std::max(worst.point, e.point), worst.tangent = std::max(worst.tangent, e.tangent);
            worst.bend = std::max(worst.bend, e.bend), worst.degrees = std::max(worst.degrees, e.degrees);
            worst.count += e.count, worst.approximate += e.approximate;
        }
        std::cout << family.name << ": " << worst.count << " points, " << worst.approximate << " approximate, p "
                  << worst.point << " tangent " << worst.tangent << " bend " << worst.bend << " degrees "
                  << worst.degrees << std::endl;
    }
}

} // namespace
} // namespace relief
