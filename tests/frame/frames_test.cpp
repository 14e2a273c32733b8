// The device's own frames against the double-precision reference, over all cages.
#include <cstdlib>
#include <filesystem>
#include <random>

#include "device.h"
#include "maps.h"
#include "meshes.h"
#include "model/records.h"

namespace relief::test {
namespace {

struct Case {
    std::string name;
    Cage cage;
    SurfaceOptions options;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::string sourceFolder() { return std::getenv("RELIEF_SOURCE"); }

std::string dataFolder() {
    const char* data = std::getenv("RELIEF_DATA");
    return data != nullptr ? data : sourceFolder() + "/../shared/data";
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (NamedCage& named : allCages()) {
        const bool isTriangles = named.cage.isAllTriangles();
        all.push_back({named.name + "Catmark", named.cage, {.scheme = Scheme::catmark, .isolation = 4}});
        if (isTriangles) all.push_back({named.name + "Loop", named.cage, {.scheme = Scheme::loop, .isolation = 4}});
        all.push_back({named.name + "Bilinear", named.cage, {.scheme = Scheme::bilinear, .isolation = 1}});
    }
    return all;
}

/// Random points of faces that are drawn, with corners, edges and centres among them.
std::vector<SampleQuery> randomQueries(const Surface& surface, int count) {
    std::mt19937 random(7);
    std::uniform_int_distribution<std::uint32_t> faces(0, std::uint32_t(surface.faces.size() - 1));
    std::uniform_real_distribution<float> unit(0, 1);
    std::uniform_int_distribution<int> eighths(0, 8);
    std::vector<SampleQuery> queries;
    while (queries.size() < std::size_t(count)) {
        SampleQuery q{faces(random), {unit(random), unit(random)}};
        if (queries.size() % 4 == 0) q.uv = vec2(eighths(random), eighths(random)) / 8.0f;
        if (surface.sideCount == 3 && q.uv.x + q.uv.y > 1) q.uv = 1.0f - q.uv;
        if (surface.faces[q.face].root != kNoPatch) queries.push_back(q);
    }
    return queries;
}

double worst(const dvec3& a, const vec3& b) {
    const dvec3 d = glm::abs(a - dvec3(b));
    return std::isfinite(d.x + d.y + d.z) ? std::max({d.x, d.y, d.z}) : 1e300;
}

double degrees(const dvec3& a, const vec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, dvec3(b))), glm::dot(a, dvec3(b))));
}

struct Errors {
    double p = 0, first = 0, second = 0, st = 0, jacobian = 0, h = 0, q = 0, normal = 0;
};

/// The leaf patch at (face,u,v): derivatives of its rounded points grow with the power of its magnification.
struct LeafLocation {
    double magnification = 1;
    vec2 uv;
    std::uint32_t type = 0;

    /// Second derivatives of a Gregory patch have no value at its corners: the blend there depends on the direction.
    [[nodiscard]] bool hasSecondDerivatives() const {
        const bool isGregory = type == kPatchGregory || type == kPatchGregoryTriangle;
        const auto isEnd = [](float x) { return x <= 0 || x >= 1; };
        return !(isGregory && isEnd(uv.x) && isEnd(uv.y));
    }
};

LeafLocation leafOf(const Surface& surface, const SampleQuery& query) {
    LeafLocation leaf{.uv = query.uv};
    vec2& uv = leaf.uv;
    std::uint32_t entry = surface.faces[query.face].root;
    for (; (entry & kLeafBit) == 0; leaf.magnification *= 2) {
        std::uint32_t child = 0;
        if (surface.sideCount == 4) {
            child = (uv.x >= 0.5f ? 1u : 0u) + (uv.y >= 0.5f ? 2u : 0u);
            uv = 2.0f * uv - vec2(child & 1, child >> 1);
        } else {
            child = uv.x >= 0.5f ? 1 : uv.y >= 0.5f ? 2 : uv.x + uv.y > 0.5f ? 3 : 0;
            uv = 2.0f * (child == 3 ? 0.5f - uv : uv - vec2(child == 1 ? 0.5f : 0.0f, child == 2 ? 0.5f : 0.0f));
        }
        entry = surface.tree[entry + child];
    }
    leaf.type = surface.patches[entry & ~kLeafBit].type;
    return leaf;
}

Errors compare(const Case& c, const HeightMap& map, bool isGenericBasis, const MapEncoding& encoding = {}) {
    const Surface surface = buildSurface(c.cage, c.options);
    const ReferenceSurface reference(c.cage, c.options);
    const SurfaceModel model(
        device(), {.surface = &surface, .cagePositions = c.cage.positions, .height = &map, .encoding = &encoding});
    const std::vector<SampleQuery> queries = randomQueries(surface, 600);
    const std::vector<SampleResult> results = sampler().sample(model, queries, {.isGenericBasis = isGenericBasis});
    Bounds bounds;
    for (const vec3& p : c.cage.positions) bounds.add(dvec3(p));
    const double side = bounds.longestSide();

    Errors e;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const SampleResult& r = results[i];
        const DisplacedFrame f = displacedFrame(reference, &map, int(queries[i].face), dvec2(queries[i].uv));
        const TexFrame tex = reference.texture(int(queries[i].face), dvec2(queries[i].uv));
        e.p = std::max(e.p, worst(f.limit.p, r.p) / side);
        // Where the tangents are repaired there is nothing to compare but the absence of NaN.
        if (!f.limit.hasTangentPlane()) {
            EXPECT_NEAR(glm::length(r.m), 1, 1e-5) << c.name << " row " << i;
            continue;
        }
        const LeafLocation leaf = leafOf(surface, queries[i]);
        const double k = leaf.magnification;
        e.first = std::max({e.first, worst(f.limit.pu, r.pu) / side / k, worst(f.limit.pv, r.pv) / side / k});
        if (!leaf.hasSecondDerivatives()) continue;
        for (const double error : {worst(f.limit.puu, r.puu), worst(f.limit.puv, r.puv), worst(f.limit.pvv, r.pvv)})
            e.second = std::max(e.second, error / side / (k * k));
        e.st = std::max(e.st, worst(dvec3(tex.st, 0), vec3(r.st, 0)));
        e.jacobian = std::max({e.jacobian, worst(dvec3(tex.jacobian[0], 0), vec3(r.stu, 0)) / k,
                               worst(dvec3(tex.jacobian[1], 0), vec3(r.stv, 0)) / k});
        e.h = std::max(e.h, std::abs(f.height.h - double(r.h)) / map.heightBound());
        // A normal is as exact as the angle and size of its tangents allow.
        const double sine =
            glm::length(glm::cross(f.limit.pu, f.limit.pv)) / (glm::length(f.limit.pu) * glm::length(f.limit.pv));
        if (sine > 0.1 && glm::length(f.limit.pu) > 0.05 * side && glm::length(f.limit.pv) > 0.05 * side) {
            e.q = std::max(e.q, worst(f.q, r.q) / side);
            e.normal = std::max(e.normal, degrees(f.normal, r.n));
        }
    }
    return e;
}

class Frames : public OnDevice, public ::testing::WithParamInterface<Case> {};

// OpenSubdiv's own tolerances are 5e-5 of the box for points, 5 times that for first and 25 times for second
// derivatives. Single precision against double leaves less: a few units of rounding, magnified with the patch's depth
// for derivatives.
TEST_P(Frames, agreeWithTheReference) {
    const HeightMap map = sineMap(64, 0.05);
    const Errors e = compare(GetParam(), map, false);
    EXPECT_LT(e.p, 1e-6);
    EXPECT_LT(e.first, 1e-5);
    EXPECT_LT(e.second, 2e-5);
    EXPECT_LT(e.st, 2e-6);
    EXPECT_LT(e.jacobian, 1e-5);
    EXPECT_LT(e.h, 2e-4);
    EXPECT_LT(e.q, 2e-5);
    EXPECT_LT(e.normal, 0.01);
    if (std::getenv("RELIEF_PRINT") != nullptr)
        std::cout << fmt::format(
            "{:40} p {:.1e} first {:.1e} second {:.1e} st {:.1e} J {:.1e} h {:.1e} q {:.1e} n {:.1e}\n",
            GetParam().name, e.p, e.first, e.second, e.st, e.jacobian, e.h, e.q, e.normal);
}

INSTANTIATE_TEST_SUITE_P(AllCages, Frames, ::testing::ValuesIn(cases()), [](const auto& info) {
    std::string name = info.param.name;
    std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    return name;
});

class Bases : public OnDevice {};

// Control points too far apart for 16 bits: half of the cage's points follow after many that no face uses.
TEST_F(Bases, areTheSameWithWideIndices) {
    Cage cage = torusWithSeams();
    constexpr std::uint32_t kGap = 70'000;
    const auto half = std::uint32_t(cage.positions.size() / 2);
    cage.positions.insert(cage.positions.begin() + half, kGap, vec3(0));
    for (std::uint32_t& corner : cage.corners)
        if (corner >= half) corner += kGap;
    const Case near{"torus", torusWithSeams(), {.isolation = 3}}, far{"torus of far points", cage, {.isolation = 3}};
    const auto isWide = [](const Case& c) { return recordsOf(buildSurface(c.cage, c.options)).hasWideIndices; };
    EXPECT_FALSE(isWide(near));
    EXPECT_TRUE(isWide(far));
    const HeightMap map = sineMap(64, 0.05);
    const Errors e = compare(far, map, false), narrow = compare(near, map, false);
    EXPECT_EQ(e.p, narrow.p);
    EXPECT_EQ(e.st, narrow.st);
    EXPECT_EQ(e.q, narrow.q);
    EXPECT_LT(e.q, 2e-5);
}

class MapFormats : public OnDevice {};

TEST_F(MapFormats, agreeWithTheReferenceThatReadsTheSame) {
    const Case c{"torus", torusWithSeams(), {.isolation = 3}};
    for (const auto& [word, format, help] : kMapFormats)
        for (const int side : {37, 64}) {
            const EncodedMap map = encode(waves(side, side - 3), format);
            const Errors e = compare(c, map.decoded, false, map.encoding);
            EXPECT_LT(e.h, 2e-5) << word;
            EXPECT_LT(e.q, 2e-5) << word;
            EXPECT_LT(e.normal, 0.01) << word;
        }
}

// On a flat cage heights are all that points have: here of the first mip alone.
TEST_F(MapFormats, haveTheirMipsOnTheDevice) {
    const Cage cage = boundaryGrid(2, 2);
    const Surface surface = buildSurface(cage, {});
    Dicer dicer(device());
    for (const auto& [word, format, help] : kMapFormats) {
        const EncodedMap map = encode(waves(37, 22), format);
        const SurfaceModel model(
            device(),
            {.surface = &surface, .cagePositions = cage.positions, .height = &map.decoded, .encoding = &map.encoding});
        EXPECT_EQ(model.height->words.buffer.bytes, (mapBytes(format, 37, 22) + 7) / 8 * 8) << word; // pairs of words
        const HeightMap mip = levelOf(map, toWords(map.decoded, map.encoding), 1);
        const EdgeRates rates{uniformRates(model, 8), Spacing::equal, std::vector<float>(model.cornerFlags.size(), 1)};
        const DenseMesh mesh = dicer.diceToHost(model, rates, {.wantsTexCoords = true});
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            EXPECT_NEAR(mesh.positions[i].y, sampleHeight(mip, dvec2(mesh.texCoords[i])).h, 2e-5) << word;
    }
}

class FileFrames : public OnDevice, public ::testing::WithParamInterface<const char*> {};

TEST_P(FileFrames, agreeWithTheReferenceAtDefaultIsolation) {
    const std::string name = GetParam();
    const std::string path = name.starts_with("meshes/") ? sourceFolder() + "/" + name : dataFolder() + "/" + name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here (RELIEF_DATA names its folder)";
    const Case c{name, readCage(path, [](const std::string&) {}), {}};
    const Errors e = compare(c, sineMap(256, 0.01), false);
    EXPECT_LT(e.p, 1e-6);
    EXPECT_LT(e.first, 1e-5);
    EXPECT_LT(e.second, 5e-5);
    EXPECT_LT(e.st, 5e-6);
    EXPECT_LT(e.normal, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Files, FileFrames,
                         ::testing::Values("meshes/cube.obj", "meshes/torus.obj", "meshes/ball.obj", "meshes/plane.obj",
                                           "meshes/lantern.obj", "meshes/strawberry.obj", "meshes/octopus.obj",
                                           "bigguy.obj", "monsterfrog.obj", "car.obj"));

// The specialised bicubic, Gregory and bilinear patches against OpenSubdiv's generic basis on the same device.
TEST_F(Bases, specialisedPatchesEqualOpenSubdivsGenericBasis) {
    const HeightMap map = sineMap(64, 0.05);
    for (const NamedCage& named : allCages()) {
        const Surface surface = buildSurface(named.cage, {.isolation = 3});
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
        const std::vector<SampleQuery> queries = randomQueries(surface, 200);
        const std::vector<SampleResult> ours = sampler().sample(model, queries);
        const std::vector<SampleResult> theirs = sampler().sample(model, queries, {.isGenericBasis = true});
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const LeafLocation leaf = leafOf(surface, queries[i]);
            const double k = leaf.magnification;
            EXPECT_LT(worst(dvec3(theirs[i].p), ours[i].p), 5e-6) << named.name;
            EXPECT_LT(worst(dvec3(theirs[i].pu), ours[i].pu), 3e-5 * k) << named.name;
            if (leaf.hasSecondDerivatives()) {
                EXPECT_LT(worst(dvec3(theirs[i].puv), ours[i].puv), 2e-4 * k * k) << named.name;
            }
            EXPECT_LT(worst(dvec3(theirs[i].st, 0), vec3(ours[i].st, 0)), 5e-6) << named.name;
        }
    }
}

} // namespace
} // namespace relief::test
