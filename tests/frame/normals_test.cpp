// Normals of the displaced surface on the device: against the reference, and against closed forms.
#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class Normals : public OnDevice {};

double degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

const dvec3& normalOf(const DisplacedFrame& frame, NormalKind kind) {
    return kind == NormalKind::limit ? frame.normal : kind == NormalKind::firstOrder ? frame.firstOrder : frame.full;
}

/// Points inside faces, away from end caps where second derivatives jump.
std::vector<SampleQuery> insidePoints(const Surface& surface) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (const vec2 uv : {vec2(0.3f, 0.4f), vec2(0.45f, 0.35f), vec2(0.2f, 0.6f)})
            if (surface.faces[face].root != kNoPatch) queries.push_back({face, uv});
    return queries;
}

TEST_F(Normals, ofAllThreeKindsEqualTheReference) {
    const HeightMap map = sineMap(64, 0.1);
    for (const NamedCage& named : allCages()) {
        const SurfaceOptions options{.isolation = 3};
        const Surface surface = buildSurface(named.cage, options);
        const ReferenceSurface reference(named.cage, options);
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
        const std::vector<SampleQuery> queries = insidePoints(surface);
        for (const NormalKind kind : {NormalKind::limit, NormalKind::firstOrder, NormalKind::full}) {
            const std::vector<SampleResult> results = sampler().sample(model, queries, {.normal = kind});
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const DisplacedFrame frame =
                    displacedFrame(reference, &map, int(queries[i].face), dvec2(queries[i].uv));
                if (!frame.limit.hasTangentPlane()) continue;
                EXPECT_LT(degrees(normalOf(frame, kind), dvec3(results[i].m)), 0.02)
                    << named.name << " kind " << int(kind) << " face " << queries[i].face;
            }
        }
    }
}

/// Samples a cage at a grid of each face and hands every result to `check`.
template <typename Check>
void sampleAll(const Cage& cage, const HeightMap& map, NormalKind kind, const Check& check) {
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    for (const SampleResult& result : sampler().sample(model, insidePoints(surface), {.normal = kind})) check(result);
}

// A flat sheet keeps its shape under subdivision: h(s,t) over it has the normal (-h_x, -h_y, 1) in its own axes.
TEST_F(Normals, ofADisplacedPlaneAreThoseOfAHeightField) {
    const Cage plane = boundaryGrid();
    const HeightMap map = sineMap(512, 0.03, 3);
    for (const NormalKind kind : {NormalKind::firstOrder, NormalKind::full})
        sampleAll(plane, map, kind, [&](const SampleResult& r) {
            // By x = x(s,t): dh/dx follows from the texture's Jacobian and the tangents, both constant on a plane.
            const dvec2 dh(r.gradient.x * r.stu.x + r.gradient.y * r.stu.y,
                           r.gradient.x * r.stv.x + r.gradient.y * r.stv.y);
            const dvec3 pu(r.pu), pv(r.pv), n(r.n);
            const dvec3 expected = glm::normalize(glm::cross(pu + dh.x * n, pv + dh.y * n));
            EXPECT_LT(degrees(expected, dvec3(r.m)), 1e-3);
            // The height and its slopes in closed form; central differences of a sine lose its third derivative's
            // share.
            const double k = 6.283185307179586 * 3, s = r.st.x, t = r.st.y;
            EXPECT_NEAR(r.h, 0.03 * std::sin(k * s) * std::cos(k * t), 2e-5);
            EXPECT_NEAR(r.gradient.x, 0.03 * k * std::cos(k * s) * std::cos(k * t), 1e-3);
            EXPECT_NEAR(r.gradient.y, -0.03 * k * std::sin(k * s) * std::sin(k * t), 1e-3);
        });
}

// An offset of constant height moves every point along its normal and leaves the normal as it was; to first order too.
TEST_F(Normals, ofAConstantOffsetAreThoseOfTheSurface) {
    const HeightMap constant = makeHeightMap(2, 2, {0.1f, 0.1f, 0.1f, 0.1f}, 0, 1, Wrap::repeat);
    for (const NormalKind kind : {NormalKind::firstOrder, NormalKind::full})
        sampleAll(torusWithSeams(), constant, kind, [](const SampleResult& r) {
            EXPECT_LT(degrees(dvec3(r.n), dvec3(r.m)), 0.01);
            EXPECT_NEAR(glm::length(dvec3(r.q) - dvec3(r.p)), 0.1, 1e-6);
        });
}

// On a curved surface the two orders differ by what the curvature term says: the full one is the cross product of the
// derivatives of q, here by differences of the device's own points.
TEST_F(Normals, ofTheFullKindAreThoseOfTheDisplacedPoints) {
    const Cage cage = torusWithSeams();
    const HeightMap map = sineMap(2048, 0.2, 1);
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const ReferenceSurface reference(cage, {.isolation = 2});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    const std::vector<SampleQuery> queries = insidePoints(surface);
    const std::vector<SampleResult> full = sampler().sample(model, queries);
    const std::vector<SampleResult> first = sampler().sample(model, queries, {.normal = NormalKind::firstOrder});
    double fullSum = 0, firstSum = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto q = [&](double du, double dv) {
            return displacedFrame(reference, &map, int(queries[i].face), dvec2(queries[i].uv) + dvec2(du, dv)).q;
        };
        constexpr double kStep = 1e-3;
        const dvec3 m = glm::cross(q(kStep, 0) - q(-kStep, 0), q(0, kStep) - q(0, -kStep));
        fullSum += std::pow(degrees(m, dvec3(full[i].m)), 2);
        firstSum += std::pow(degrees(m, dvec3(first[i].m)), 2);
    }
    const double fullRms = std::sqrt(fullSum / double(queries.size())),
                 firstRms = std::sqrt(firstSum / double(queries.size()));
    RecordProperty("fullRmsDegrees", fmt::format("{}", fullRms));
    EXPECT_LT(fullRms, 0.05);
    EXPECT_GT(firstRms, 20 * fullRms);
}

} // namespace
} // namespace relief::test
