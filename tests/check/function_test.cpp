// Height functions on surfaces: the same as a map of the same formula, watertight on every path, exact, and under a
// certificate that finds what is wrong.
#include <cmath>
#include <numbers>
#include <random>

#include "check/check.h"
#include "frame/device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class FunctionHeightsOnDevice : public OnDevice {};

FunctionHeights heightsOf(FunctionText text, const Cage& cage, double scale, float bound, double mid) {
    FunctionHeights heights;
    heights.function = std::make_shared<const HeightFunction>(std::move(text));
    heights.scale = scale;
    heights.mid = mid;
    heights.bound = bound;
    heights.step = float(computeBounds(cage.positions).diagonal() / 8192);
    return heights;
}

FunctionText textOf(const std::string& expression) {
    return {"test.glsl", "float height(vec3 p, vec2 st, float t) { return " + expression + "; }"};
}

/// Depends on everything, and folds nothing.
const std::string kRich = "sin(3.0 * p.x + 2.0 * t) * cos(4.0 * p.y) + 0.5 * sin(5.0 * p.z + 6.2831853 * st.x)";

/// A cage with a function, on the device and as the reference has it.
struct Subject {
    Cage cage;
    SurfaceOptions options;
    Surface surface = buildSurface(cage, options);
    FunctionHeights heights;
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .function = &heights}};

    Subject(Cage of, const FunctionText& text, double scale, float bound, Scheme scheme = Scheme::catmark,
            double mid = 0)
        : cage(std::move(of)), options{.scheme = scheme, .isolation = 3},
          heights(heightsOf(text, cage, scale, bound, mid)) {}

    /// What the certificate makes of the device's points, with the reference's function at `seconds`.
    [[nodiscard]] RegionErrors errors(double seconds, NormalKind normal = NormalKind::full) {
        const std::vector<SampleQuery> queries = sampleEverywhere(surface, 6000).queries;
        const std::vector<SampleResult> results = sampler().sample(model, queries, {.normal = normal});
        const ReferenceSurface reference(cage, options);
        FunctionReference function(device(), heights, reference, seconds);
        const std::vector<FaceHeight> expected = function.heights(queries);
        const FrameComparison with{&reference, nullptr, normal, computeBounds(cage.positions).diagonal(), expected};
        return compareFrames(with, queries, results).regular;
    }
};

// --- exact

TEST_F(FunctionHeightsOnDevice, areThoseOfAMapOfTheSameFormula) {
    const Cage cage = torusWithSeams();
    const std::string formula = fmt::format("0.5 + 0.5 * sin({0} * st.x) * cos({0} * st.y)", 4 * std::numbers::pi);
    const Subject byFunction(cage, textOf(formula), 0.3, 0.15f, Scheme::catmark, 0.5);
    const HeightMap map = sineMap(1024, 0.15);
    const SurfaceModel byMap(device(),
                             {.surface = &byFunction.surface, .cagePositions = cage.positions, .height = &map});
    const std::vector<SampleQuery> queries = sampleEverywhere(byFunction.surface, 4000).queries;
    const std::vector<SampleResult> a = sampler().sample(byFunction.model, queries),
                                    b = sampler().sample(byMap, queries);
    double point = 0, angle = 0, largest = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        point = std::max(point, glm::length(dvec3(a[i].q) - dvec3(b[i].q)));
        angle = std::max(angle, glm::degrees(double(std::acos(std::min(glm::dot(a[i].m, b[i].m), 1.0f)))));
        largest = std::max(largest, std::abs(double(a[i].h)));
    }
    EXPECT_LT(point, 2e-5); // bilinear between 512 texels per period
    EXPECT_LT(angle, 0.1);
    EXPECT_GT(largest, 0.14);
}

TEST_F(FunctionHeightsOnDevice, areExact) {
    for (const char* name : {"golf", "waves", "fractal"})
        for (const bool isLoop : {false, true}) {
            Subject subject(isLoop ? icosahedron() : torusWithSeams(), readHeightFunction(name), 1, 0.2f,
                            isLoop ? Scheme::loop : Scheme::catmark);
            subject.model.setTime(0.7, 0.7);
            for (const NormalKind normal : {NormalKind::full, NormalKind::firstOrder}) {
                const RegionErrors errors = subject.errors(0.7, normal);
                EXPECT_GT(errors.count, 3000u);
                EXPECT_EQ(errors.countMisplaced, 0u) << name << (isLoop ? ", loop" : "");
                EXPECT_LE(errors.countMisturned, errors.count / 500) << name << (isLoop ? ", loop" : "");
            }
        }
}

// The certificate has to find what is wrong with the device's heights, points and slopes.
TEST_F(FunctionHeightsOnDevice, thatAreWrongAreFound) {
    const auto subject = [] { return Subject(torusWithSeams(), textOf(kRich), 0.05, 1); };
    Subject right = subject();
    EXPECT_EQ(right.errors(0).countMisplaced, 0u);
    EXPECT_EQ(right.errors(0).countMisturned, 0u);
    {
        Subject late = subject();
        late.model.setTime(0.1, 0.1);
        EXPECT_GT(late.errors(0).countMisplaced, late.errors(0).count / 5) << "another time";
    }
    {
        Subject high = subject();
        high.model.height->record.scale *= 1.03f;
        EXPECT_GT(high.errors(0).countMisplaced, high.errors(0).count / 5) << "3 % higher";
    }
    {
        Subject scaled = subject();
        scaled.model.tables.heightUnit = 1.01f;
        EXPECT_GT(scaled.errors(0).countMisplaced, scaled.errors(0).count / 20) << "points 1 % off";
    }
    {
        Subject close = subject();
        close.model.tables.heightStep *= 1e-4f;
        EXPECT_EQ(close.errors(0).countMisplaced, 0u);
        EXPECT_GT(close.errors(0).countMisturned, close.errors(0).count / 5) << "slopes between points too close";
    }
}

// --- watertight

void expectWatertight(const SurfaceModel& model, const std::string& what) {
    static Capturer capturer(device());
    std::mt19937 random(5);
    EdgeRates rates;
    rates.rates.resize(model.edges.size());
    for (std::uint32_t edge = 0; edge < rates.rates.size(); ++edge) {
        const std::uint32_t partner = model.edges[edge].partner;
        rates.rates[edge] = partner < edge ? rates.rates[partner] : float(1 + random() % (partner == edge ? 17 : 8));
    }
    for (const Path path : {Path::tessellation, Path::grid, Path::dice}) {
        const CapturedMesh mesh = capturer.capture(model, {.path = path}, rates);
        const Watertightness w = checkWatertight(mesh, boundarySegments(model, rates));
        EXPECT_TRUE(w.isWatertight()) << what << ", path " << int(path) << ": " << w.openEdges << " open edges, "
                                      << w.tJunctions << " T-junctions, " << w.notFinite << " not finite";
        EXPECT_GT(w.triangles, 100u) << what;
    }
}

struct WatertightCage {
    const char* name;
    Cage cage;
    Scheme scheme = Scheme::catmark;
};

TEST_F(FunctionHeightsOnDevice, areWatertightOnEveryPath) {
    const std::vector<WatertightCage> cages = {{"torus with seams", torusWithSeams()},
                                               {"islands", cubeOfIslands()},
                                               {"creases", creasedCube(4.5f)},
                                               {"n-gons", nGonPrism(5)},
                                               {"boundary", hillyGrid()},
                                               {"mixed faces", mixedFaces()},
                                               {"triangles", icosahedron(), Scheme::loop},
                                               {"bilinear", cubeOfIslands(), Scheme::bilinear}};
    for (const WatertightCage& one : cages) {
        Subject subject(one.cage, textOf(kRich), 0.1, 1, one.scheme);
        for (const double seconds : {0.0, 1.3}) {
            subject.model.setTime(seconds, seconds);
            expectWatertight(subject.model, fmt::format("{} at {} s", one.name, seconds));
        }
    }
}

TEST_F(FunctionHeightsOnDevice, thatAreNoNumbersOrPastTheBoundLeaveNoHole) {
    const std::string wild = "p.x > 0.5 ? sqrt(-1.0 - abs(p.y)) : p.x > 0.2 ? 1.0 / (p.y - p.y) : 1e6 * p.z";
    const Subject subject(torusWithSeams(), textOf(wild), 1, 0.1f);
    expectWatertight(subject.model, "wild heights");
    for (const SampleResult& r : sampler().sample(subject.model, sampleEverywhere(subject.surface, 3000).queries)) {
        EXPECT_LE(std::abs(r.h), 0.1f);
        if (r.p.x > 0.501f) {
            EXPECT_EQ(r.h, 0) << "no number";
        }
        EXPECT_TRUE(std::isfinite(r.q.x + r.q.y + r.q.z + r.m.x + r.m.y + r.m.z));
    }
}

// --- time

TEST_F(FunctionHeightsOnDevice, moveWithTime) {
    Subject subject(torusWithSeams(), textOf("sin(t) + 0.0 * p.x"), 0.1, 1);
    const std::vector<SampleQuery> queries{{0, {0.3f, 0.4f}}, {5, {0.5f, 0.5f}}};
    for (const double seconds : {0.0, 0.5, -2.0, 100.0}) {
        subject.model.setTime(seconds, seconds);
        for (const SampleResult& r : sampler().sample(subject.model, queries))
            EXPECT_NEAR(r.h, 0.1 * std::sin(seconds), 1e-5) << seconds;
    }
}

// --- loops

// Mesa's CPU driver ends loops after 65,535 turns of one invocation: heights in the middle of large faces must not be
// cut off by those before them.
TEST_F(FunctionHeightsOnDevice, withManyTurnsAreTheSameInEveryVertex) {
    const FunctionText text{"loops.glsl", "float height(vec3 p, vec2 st, float t) {\n"
                                          "    float sum = 0.0;\n"
                                          "    for (int i = 0; i < 990; ++i) sum += 1.0;\n"
                                          "    return sum;\n}"};
    const Subject subject(hillyGrid(), text, 1e-3, 1);
    Dicer dicer(device());
    EdgeRates rates{.rates = uniformRates(subject.model, 40)};
    const DicedMesh mesh = dicer.dice(subject.model, rates, {});
    std::vector<vec4> texels(2 * std::size_t(mesh.vertexCount));
    downloadBytes(device(), mesh.vertices.buffer, std::as_writable_bytes(std::span(texels)));
    for (std::size_t i = 0; i < texels.size(); i += 2) ASSERT_NEAR(texels[i].w, 0.99f, 1e-5f) << i / 2;
}

// --- seams

TEST_F(FunctionHeightsOnDevice, disagreeAtSeamsOnlyWhereTheyReadTextureCoordinates) {
    const auto seamsOf = [](const std::string& expression) {
        const Subject subject(cubeOfIslands(), textOf(expression), 0.1, 1);
        const ReferenceSurface reference(subject.cage, subject.options);
        FunctionReference function(device(), subject.heights, reference, 0);
        return reportSeams(subject.surface, reference, function);
    };
    const SeamReport byPoint = seamsOf("sin(5.0 * p.x) * p.y"), byTexture = seamsOf("sin(5.0 * st.x)");
    EXPECT_GT(byPoint.seamEdgeCount, 0u);
    EXPECT_EQ(byPoint.seamEdgeCount, byTexture.seamEdgeCount);
    EXPECT_LT(byPoint.max, 1e-6);
    EXPECT_GT(byTexture.max, 0.01);
}

} // namespace
} // namespace relief::test
