// Vector maps on the device against the height maps that they stand for, and against differences of the reference.
#include <cmath>
#include <numbers>

#include "check/check.h"
#include "displacement/vector_map.h"
#include "meshes.h"
#include "on_device.h"

namespace relief::test {
namespace {

constexpr double kWaveTurn = 2 * std::numbers::pi;

/// Components by texture coordinates, at texel centres.
template <typename Function>
Image componentsOf(int side, const Function& function) {
    Image image{.width = side, .height = side, .channels = 3, .texels = {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const dvec3 c = function((x + 0.5) / side, 1 - (y + 0.5) / side);
            image.texels.insert(image.texels.end(), {float(c.x), float(c.y), float(c.z)});
        }
    return image;
}

double wave(double s, double t) { return 0.12 * std::sin(kWaveTurn * (s + t)) * std::cos(kWaveTurn * (s - 2 * t)); }
dvec3 heightAlone(double s, double t) { return {0, 0, wave(s, t)}; }
dvec3 threeWaves(double s, double t) {
    return {0.1 * std::sin(kWaveTurn * (s + 2 * t)), 0.08 * std::cos(kWaveTurn * (2 * s - t)), wave(s, t)};
}

HeightMap vectorMap(VectorSpace space, dvec3 (*function)(double, double)) {
    return makeVectorMap(componentsOf(256, function), {.space = space, .limits = {}});
}

/// Texture coordinates that bend: T and B turn against the faces.
Cage bentGrid() {
    Cage cage = hillyGrid();
    for (vec2& st : cage.texCoords)
        st = {0.8f * st.x + 0.15f * st.y * st.y, 0.7f * st.y + 0.2f * st.x * st.x - 0.1f * st.x * st.y};
    return cage;
}

struct VectorSubject {
    std::string name;
    Cage cage;
    Scheme scheme = Scheme::catmark;
};
std::vector<VectorSubject> subjects() {
    return {{"torus", torusWithSeams()},
            {"mirrored torus", torusWithMirroredTexture()},
            {"bent grid", bentGrid()},
            {"cube without texture coordinates", cube()},
            {"triangles", triangleTorus(), Scheme::loop}};
}

struct VectorMaps : OnDevice {
    struct Answers {
        std::vector<SampleResult> results;
        std::vector<SampleError> errors;
        FrameErrors summary;
    };
    /// The device's answers at points all over the surface, against the reference.
    static Answers ask(const VectorSubject& subject, const SurfaceSamples& samples, const Surface& surface,
                       const HeightMap& map, NormalKind normal = NormalKind::full) {
        static SurfaceSampler sampler(device());
        const SurfaceOptions options{.scheme = subject.scheme, .isolation = 4};
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = subject.cage.positions, .height = &map});
        const ReferenceSurface reference(subject.cage, options);
        Answers answers{.results = sampler.sample(model, samples.queries, {.normal = normal}), .errors = {}};
        const double diagonal = summarize(subject.cage).bounds.diagonal();
        answers.errors = sampleErrors({&reference, &map, normal, diagonal}, samples.queries, answers.results);
        answers.summary = summarizeErrors(samples.queries, answers.errors);
        return answers;
    }
    static Surface surfaceOf(const VectorSubject& subject) {
        return buildSurface(subject.cage, {.scheme = subject.scheme, .isolation = 4});
    }
};

TEST_F(VectorMaps, thatHoldHeightsAlongTheNormalAreThoseHeights) {
    std::vector<float> heights;
    const Image components = componentsOf(256, heightAlone);
    for (std::size_t i = 2; i < components.texels.size(); i += 3) heights.push_back(components.texels[i]);
    const HeightMap scalar = makeHeightMap(256, 256, heights, 0, 1, Wrap::repeat);
    const HeightMap vectors = vectorMap(VectorSpace::tangent, heightAlone);
    EXPECT_NEAR(vectors.heightBound(), scalar.heightBound(), 1e-6);
    for (const VectorSubject& subject : subjects()) {
        const Surface surface = surfaceOf(subject);
        const SurfaceSamples samples = sampleEverywhere(surface, 900);
        const Answers a = ask(subject, samples, surface, scalar), b = ask(subject, samples, surface, vectors);
        const double size = summarize(subject.cage).bounds.longestSide();
        double farthest = 0, turned = 0, fold = 0;
        std::size_t compared = 0;
        for (std::size_t i = 0; i < a.results.size(); ++i) {
            farthest = std::max(farthest, glm::length(dvec3(a.results[i].q) - dvec3(b.results[i].q)));
            if (!a.errors[i].hasTangentPlane || a.errors[i].isApproximate) continue;
            turned = std::max(turned, degreesBetween(dvec3(a.results[i].m), dvec3(b.results[i].m)));
            if (!b.errors[i].foldFactor) continue; // where texture coordinates are mirrored
            ++compared;
            fold = std::max(fold, std::abs(foldFactor(a.results[i]) - *b.errors[i].foldFactor));
        }
        EXPECT_LE(farthest, 1e-6 * size) << subject.name;
        EXPECT_LE(turned, 0.01) << subject.name;
        EXPECT_LE(fold, 2e-3) << subject.name;
        EXPECT_GT(compared, a.results.size() / 2) << subject.name;
    }
}

TEST_F(VectorMaps, haveTheNormalsOfDifferencesOfThePoints) {
    for (const VectorSubject& subject : subjects()) {
        const Surface surface = surfaceOf(subject);
        const SurfaceSamples samples = sampleEverywhere(surface, 900);
        for (const VectorSpace space : {VectorSpace::tangent, VectorSpace::object}) {
            const HeightMap map = vectorMap(space, threeWaves);
            const std::string words = subject.name + (space == VectorSpace::object ? ", object" : ", tangent");
            // The first-order normal is another one; it is asked of the first cage.
            for (const NormalKind normal : {NormalKind::full, NormalKind::firstOrder}) {
                if (normal == NormalKind::firstOrder && subject.name != "torus") continue;
                const RegionErrors errors = ask(subject, samples, surface, map, normal).summary.regular;
                EXPECT_LE(errors.normal.rms, 0.05) << words;
                EXPECT_EQ(errors.countMisplaced, 0u) << words;
                EXPECT_EQ(errors.countMisturned, 0u) << words;
            }
        }
    }
}

TEST_F(VectorMaps, turnTheSurfaceOverWhereTheyHangOver) {
    // Moved along s by more than a wave is long: the surface folds back on itself.
    const auto shear = [](double s, double) { return dvec3(0.2 * std::sin(kWaveTurn * 4 * s), 0, 0); };
    const HeightMap map = makeVectorMap(componentsOf(256, shear), {.space = VectorSpace::object, .limits = {}});
    VectorSubject flat{"grid", boundaryGrid(1, 1)};
    flat.cage.boundaryRule = BoundaryRule::edgeAndCorner;
    const Surface surface = surfaceOf(flat);
    const SurfaceSamples samples = sampleEverywhere(surface, 4000);
    const Answers answers = ask(flat, samples, surface, map);
    const CurvatureReport report = reportFolds(samples, answers.results, answers.errors);
    // x = s, q_s = 1 + 0.2 * 8 pi cos(8 pi s): negative where cos < -0.199, on 43.6 % of the surface.
    EXPECT_NEAR(report.foldedFraction(), 0.436, 0.02);
    EXPECT_NEAR(report.lowestFactor, 1 - 0.2 * 8 * std::numbers::pi, 0.1);
}

} // namespace
} // namespace relief::test
