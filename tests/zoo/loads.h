// What the zoo's cages go through: poses, heights, rates.
#pragma once

#include <map>
#include <random>
#include <tuple>

#include "cages.h"
#include "displacement/vector_map.h"
#include "frame/device.h"

namespace relief::test {

// --- poses -------------------------------------------------------------------------------------------------------

enum class Pose { rest, twist, squash };
inline constexpr Pose kPoses[] = {Pose::rest, Pose::twist, Pose::squash};
inline constexpr const char* kPoseNames[] = {"rest", "twist", "squash"};

/// A screw along Y that leaves no symmetry; or all of it crushed into a sheet, where heights fold it many times.
inline std::vector<vec3> posed(const Cage& cage, Pose pose) {
    std::vector<vec3> positions = cage.positions;
    for (vec3& p : positions) {
        const double angle = 0.9 * p.y + 0.17 * p.x + 0.3;
        const auto c = float(std::cos(angle)), s = float(std::sin(angle));
        if (pose == Pose::twist) p = {c * p.x - s * p.z, 1.13f * p.y + 0.07f * p.x * p.z, s * p.x + c * p.z};
        if (pose == Pose::squash) p = {1.1f * p.x + 0.2f * p.z, 1e-3f * p.y, 0.9f * p.z};
    }
    return positions;
}

// --- pens --------------------------------------------------------------------------------------------------------

/// Cages of one kind side by side in one model: the price of a capture is its shaders, not its triangles.
struct Pen {
    Scheme scheme = Scheme::catmark;
    std::vector<ZooCage> cages;

    /// 4 x 4 cages per layer, far enough apart.
    static vec3 offsetOf(std::size_t number) {
        const vec3 slot(number % 4, number / 4 % 4, number / 16);
        return 9.0f * slot - vec3(13);
    }

    /// Few cages for the price of many: visited less often.
    [[nodiscard]] bool isSmall() const { return cages.size() < 4; }

    [[nodiscard]] Cage joined() const;

    [[nodiscard]] std::vector<vec3> posedTogether(Pose pose) const {
        std::vector<vec3> positions;
        for (std::size_t i = 0; i < cages.size(); ++i)
            for (const vec3& p : posed(cages[i].cage, pose)) positions.push_back(p + offsetOf(i));
        return positions;
    }

    [[nodiscard]] const std::string& nameAt(const vec3& position) const {
        const auto distance = [&](std::size_t i) { return glm::length(position - offsetOf(i)); };
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < cages.size(); ++i)
            if (distance(i) < distance(nearest)) nearest = i;
        return cages[nearest].name;
    }
};

inline Cage Pen::joined() const {
    Cage all = cages.front().cage;
    const auto append = [](auto& to, const auto& from, std::size_t offset) {
        for (const std::uint32_t index : from) to.push_back(std::uint32_t(offset + index));
    };
    for (std::size_t i = 1; i < cages.size(); ++i) {
        const Cage& one = cages[i].cage;
        append(all.corners, one.corners, all.positions.size());
        append(all.texCorners, one.texCorners, all.texCoords.size());
        append(all.creaseEdges, one.creaseEdges, all.positions.size());
        append(all.sharpVertices, one.sharpVertices, all.positions.size());
        append(all.holes, one.holes, all.faceSizes.size());
        append(all.faceSizes, one.faceSizes, 0);
        all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
        all.texCoords.insert(all.texCoords.end(), one.texCoords.begin(), one.texCoords.end());
        all.creaseSharpness.insert(all.creaseSharpness.end(), one.creaseSharpness.begin(), one.creaseSharpness.end());
        all.vertexSharpness.insert(all.vertexSharpness.end(), one.vertexSharpness.begin(), one.vertexSharpness.end());
    }
    all.parts.clear();
    return all;
}

/// Cages share a pen when the rules of their subdivision are the same and all or none have texture coordinates.
inline std::vector<Pen> zooPens() {
    using Kind = std::tuple<Scheme, bool, BoundaryRule, TexBoundaryRule, CreaseMethod>;
    std::map<Kind, Pen> pens;
    for (ZooCage& one : zooCages()) {
        const Cage& c = one.cage;
        Pen& pen = pens[{one.scheme, c.hasTexCoords(), c.boundaryRule, c.texBoundaryRule, c.creaseMethod}];
        pen.scheme = one.scheme;
        pen.cages.push_back(std::move(one));
    }
    std::vector<Pen> all;
    for (auto& [kind, pen] : pens) all.push_back(std::move(pen));
    return all;
}

// --- heights -----------------------------------------------------------------------------------------------------

struct NamedMap {
    std::string name;
    std::optional<HeightMap> map;

    [[nodiscard]] const HeightMap* get() const { return map ? &*map : nullptr; }
};

/// `value(x, y)` at every texel.
template <typename Value>
HeightMap mapOf(int width, int height, Wrap wrap, const Value& value) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) texels.push_back(float(value(x, y)));
    return makeHeightMap(width, height, std::move(texels), 0.1, 0.15, wrap);
}

inline constexpr std::size_t kVectorMaps = 2; ///< the last ones of zooMaps()

/// Three waves or noise in the components.
inline HeightMap zooVectors(VectorSpace space, int side) {
    std::mt19937 random(5);
    Image image{.width = side, .height = side, .channels = 3, .texels = {}};
    for (int i = 0; i < 3 * side * side; ++i)
        image.texels.push_back(space == VectorSpace::object
                                   ? float(random() % 2001) / 1000 - 1
                                   : float(std::sin(0.3 * (i / 3 % side) + i % 3 + 0.1 * (i / 3 / side))));
    return makeVectorMap(image, {.space = space, .scale = 0.12, .limits = {}});
}

/// The one of seams has a level of its own in each of 8 x 8 cells: islands differ wherever they lie.
inline std::vector<NamedMap> zooMaps() {
    std::mt19937 random(3);
    const auto noise = [&](int, int) { return double(random() % 2001) / 1000 - 1; };
    std::vector<double> levels;
    for (int cell = 0; cell < 64; ++cell) levels.push_back(noise(0, 0));
    const auto cells = [&](int x, int y) {
        return levels[std::size_t(y / 8 * 8 + x / 8)] + 0.02 * (x % 8) - 0.03 * (y % 8);
    };
    return {{"no heights", {}},
            {"smooth heights", sineMap(64, 0.15)},
            {"noise", mapOf(48, 31, Wrap::repeat, noise)},
            {"checkerboard", mapOf(32, 32, Wrap::clamp, [](int x, int y) { return (x + y) % 2 == 0 ? 1 : -1; })},
            {"seams that disagree", mapOf(64, 64, Wrap::repeat, cells)},
            {"vectors along T, B and N", zooVectors(VectorSpace::tangent, 64)},
            {"vectors of the object", zooVectors(VectorSpace::object, 32)}};
}

// --- rates -------------------------------------------------------------------------------------------------------

/// Uniform ones come first; then a rate of its own for every edge, real numbers, and two with levels of the map.
inline constexpr int kUniformRates[] = {1, 2, 3, 7, 16, 33};
enum class RateKind {
    uniform1,
    uniform2,
    uniform3,
    uniform7,
    uniform16,
    uniform33,
    random,
    fractional,
    filtered,
    levels
};
inline constexpr int kRateKinds = 10;

inline std::string nameOf(RateKind kind) {
    constexpr const char* kNames[] = {"random rates", "fractional rates", "filtered heights", "random levels"};
    const int number = int(kind);
    return number < 6 ? fmt::format("rate {}", kUniformRates[number]) : kNames[number - 6];
}

/// A rate for every edge, 1 to 33 for a whole one; the halves of a split one have the same, as every rater gives them.
inline std::vector<float> randomRates(const SurfaceModel& model, Spacing spacing, std::mt19937& random) {
    std::vector<float> rates(model.edges.size());
    for (std::uint32_t edge = 0; edge < rates.size(); ++edge) {
        const std::uint32_t partner = model.edges[edge].partner, most = partner == edge ? 33 : 16;
        const float fraction = float(random() % 1000) / 1000;
        rates[edge] = spacing == Spacing::equal ? float(1 + random() % most) : 1 + fraction * float(most - 1);
        if (partner < edge) rates[edge] = rates[partner];
    }
    return rates;
}

inline EdgeRater& rater() {
    static EdgeRater instance(device());
    return instance;
}

inline EdgeRates zooRates(const SurfaceModel& model, RateKind kind, std::uint32_t seed) {
    std::mt19937 random(seed);
    EdgeRates rates;
    if (int(kind) < 6) {
        rates.rates = uniformRates(model, float(kUniformRates[int(kind)]));
    } else if (kind == RateKind::filtered) {
        rates = rater().rates(model, {.path = Path::grid, .rate = 1 + int(random() % 6), .filtersHeights = true}, {});
    } else {
        const bool isFractional = kind == RateKind::fractional || (kind == RateKind::levels && random() % 2 == 0);
        rates.spacing = isFractional ? Spacing::fractional : Spacing::equal;
        rates.rates = randomRates(model, rates.spacing, random);
    }
    // Past the last level of any map as well.
    if (kind == RateKind::levels)
        for (std::size_t corner = 0; corner < model.cornerFlags.size(); ++corner)
            rates.cornerLevels.push_back(float(random() % 900) / 100);
    return rates;
}

// --- paths -------------------------------------------------------------------------------------------------------

inline constexpr const char* kPathNames[] = {"tessellation", "grid", "dice"};

/// The ways that this device can make triangles and hand them back.
inline std::vector<Path> capturedPaths() {
    const DeviceTraits& traits = device().traits();
    std::vector<Path> paths{Path::dice};
    if (traits.hasVertexStores) paths.insert(paths.begin(), Path::grid);
    if (traits.hasTessellation && traits.hasTransformFeedback) paths.insert(paths.begin(), Path::tessellation);
    return paths;
}

inline Capturer& capturer() {
    static Capturer instance(device());
    return instance;
}

} // namespace relief::test
