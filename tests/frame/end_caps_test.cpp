// The device's frames beside extraordinary vertices against the double-precision reference.
#include <random>

#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// Points at 2^-2 to 2^-20 of a face from its corners.
std::vector<SampleQuery> queriesAtCorners(const Surface& surface, std::uint32_t mostFaces) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.5, 1);
    std::vector<SampleQuery> queries;
    const auto stride = std::max<std::uint32_t>(std::uint32_t(surface.faces.size()) / mostFaces, 1);
    for (std::uint32_t face = 0; face < surface.faces.size(); face += stride) {
        if (surface.faces[face].root == kNoPatch) continue;
        for (int corner = 0; corner < surface.sideCount; ++corner) {
            const dvec2 at = sidePoint(surface.sideCount, corner, 0);
            const dvec2 next = sidePoint(surface.sideCount, corner, 1) - at;
            const dvec2 previous =
                sidePoint(surface.sideCount, (corner + surface.sideCount - 1) % surface.sideCount, 0) - at;
            for (int k = 2; k <= 20; k += 3)
                queries.push_back({face, vec2(at + std::ldexp(1.0, -k) * (double(unit(random)) * next +
                                                                          double(unit(random)) * previous))});
        }
    }
    return queries;
}

double relativeError(const dvec3& expected, const vec3& found) {
    return glm::length(expected - dvec3(found)) / glm::length(expected);
}

struct CapErrors {
    double point = 0, tangent = 0, degrees = 0;
};

CapErrors errorsAtCorners(const Cage& cage, const SurfaceOptions& options) {
    const Surface surface = buildSurface(cage, options);
    const ReferenceSurface reference(cage, options);
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    const std::vector<SampleQuery> queries = queriesAtCorners(surface, 200);
    const std::vector<SampleResult> results = sampler().sample(model, queries, {});
    const double size = summarize(cage).bounds.longestSide();
    CapErrors errors;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const SampleResult& r = results[i];
        const LimitFrame f = reference.limit(int(queries[i].face), dvec2(queries[i].uv));
        EXPECT_TRUE(std::isfinite(r.m.x + r.m.y + r.m.z)) << queries[i].face;
        errors.point = std::max(errors.point, glm::length(f.p - dvec3(r.p)) / size);
        if (reference.isApproximate(int(queries[i].face), dvec2(queries[i].uv))) continue;
        errors.tangent = std::max({errors.tangent, relativeError(f.pu, r.pu), relativeError(f.pv, r.pv)});
        // Thin parallelograms magnify the rounding of their sides.
        const double sine = glm::length(glm::cross(f.pu, f.pv)) / (glm::length(f.pu) * glm::length(f.pv));
        if (sine > 0.05) errors.degrees = std::max(errors.degrees, degreesBetween(glm::cross(f.pu, f.pv), dvec3(r.n)));
    }
    return errors;
}

class EndCaps : public OnDevice {};

TEST_F(EndCaps, areExactDownToAMillionthOfAFace) {
    for (const NamedCage& named : allCages()) {
        SCOPED_TRACE(named.name);
        for (const Scheme scheme : {Scheme::catmark, Scheme::loop}) {
            if (scheme == Scheme::loop && !named.cage.isAllTriangles()) continue;
            const CapErrors errors = errorsAtCorners(named.cage, {.scheme = scheme, .isolation = 2});
            EXPECT_LE(errors.point, 1e-6);
            EXPECT_LE(errors.tangent, 1e-5);
            EXPECT_LE(errors.degrees, 0.01);
            if (std::getenv("RELIEF_PRINT") != nullptr)
                std::cout << fmt::format("{:30} p {:.1e} tangent {:.1e} n {:.1e}\n", named.name, errors.point,
                                         errors.tangent, errors.degrees);
        }
    }
}

} // namespace
} // namespace relief::test
