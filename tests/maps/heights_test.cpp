#include "maps/fields.h"
#include "maps/transforms.h"

namespace relief::test {
namespace {

constexpr Wrap kBoth[] = {Wrap::repeat, Wrap::clamp};

IntegratedHeights integrate(const NormalMap& map, const IntegrationOptions& options = {}) {
    return integrateNormals(map, options, "map");
}

// --- the transforms -----------------------------------------------------------------------------------------------

double vectorAt(const AxisTransform& axis, Wrap wrap, int k, int i) {
    const double angle = axis.angle(k);
    return wrap == Wrap::repeat ? std::cos(angle * i) + std::sin(angle * i) : std::cos(angle * (i + 0.5));
}

TEST(AxisTransform, isTheProductWithItsVectorsAndBack) {
    for (const Wrap wrap : kBoth)
        for (const int size : {1, 2, 3, 4, 7, 12, 17}) {
            AxisTransform axis(size, wrap);
            std::vector<double> a, b;
            for (int i = 0; i < size; ++i) a.push_back(std::sin(i * i + 1)), b.push_back(std::cos(3 * i));
            std::vector<double> ofA = a, ofB = b;
            axis.forward(ofA, ofB);
            for (int k = 0; k < size; ++k) {
                double productA = 0, productB = 0;
                for (int i = 0; i < size; ++i) {
                    productA += vectorAt(axis, wrap, k, i) * a[std::size_t(i)];
                    productB += vectorAt(axis, wrap, k, i) * b[std::size_t(i)];
                }
                EXPECT_NEAR(ofA[std::size_t(k)], productA, 1e-12) << size;
                EXPECT_NEAR(ofB[std::size_t(k)], productB, 1e-12) << size;
            }
            axis.inverse(ofA, ofB);
            for (int i = 0; i < size; ++i) {
                EXPECT_NEAR(ofA[std::size_t(i)], a[std::size_t(i)], 1e-13) << size;
                EXPECT_NEAR(ofB[std::size_t(i)], b[std::size_t(i)], 1e-13) << size;
            }
        }
}

// --- round trips --------------------------------------------------------------------------------------------------

TEST(HeightsOfNormals, areThoseThatTheNormalsWereMadeOf) {
    for (const Wrap wrap : kBoth) {
        const HeightMap waves = heightsOf(64, 48, wrap, [](double s, double t) {
            return 0.2 * std::sin(2 * kPi * s) * std::cos(4 * kPi * t) + 0.05 * std::cos(6 * kPi * (s + t)) + 3;
        });
        for (const MapSize size : {MapSize(1, 0.75), MapSize(5, 0.5)}) {
            const IntegratedHeights back = integrate(computeNormalMap(waves, size), {.size = size});
            EXPECT_LT(largestDifference(waves, back.heights), 1e-6) << int(wrap) << ' ' << size.x;
            EXPECT_LT(back.residualShare(), 1e-6);
            EXPECT_EQ(back.heights.mid, 0);
            EXPECT_EQ(back.heights.scale, 1);
            EXPECT_EQ(back.heights.wrap, wrap);
        }
    }
}

// Central differences see nothing of waves of two texels along axes that repeat with an even size.
TEST(HeightsOfNormals, areThoseOfNoiseWhereDifferencesSeeAllOfIt) {
    const struct {
        int width, height;
        Wrap wrap;
    } maps[] = {{33, 21, Wrap::repeat}, {33, 21, Wrap::clamp}, {32, 20, Wrap::clamp},
                {1, 16, Wrap::clamp},   {16, 1, Wrap::clamp},  {5, 1, Wrap::repeat}};
    for (const auto& map : maps) {
        const HeightMap noise = noiseHeights(map.width, map.height, map.wrap);
        const MapSize size(2, 1.5);
        const IntegratedHeights back = integrate(computeNormalMap(noise, size), {.size = size});
        EXPECT_LT(largestDifference(noise, back.heights), 3e-6)
            << map.width << ' ' << map.height << ' ' << int(map.wrap);
    }
}

TEST(HeightsOfNormals, haveTheSlopesOfNoiseWhereDifferencesSeeLess) {
    const HeightMap noise = noiseHeights(32, 20, Wrap::repeat);
    const NormalMap normals = computeNormalMap(noise, {1, 1});
    const IntegratedHeights back = integrate(normals);
    EXPECT_LT(back.residualShare(), 1e-6);
    const NormalMap again = computeNormalMap(back.heights, {1, 1});
    for (std::size_t i = 0; i < again.normals.size(); ++i)
        EXPECT_LT(glm::length(again.normals[i] - normals.normals[i]), 1e-5);
}

TEST(HeightsOfNormals, ofASlopeAreAPlaneWhereTheMapEnds) {
    const HeightMap plane = heightsOf(24, 24, Wrap::clamp, [](double s, double t) { return 2 * s - t; });
    const IntegratedHeights back = integrate(computeNormalMap(plane, {1, 1}));
    EXPECT_LT(largestDifference(plane, back.heights), 1e-6);
    EXPECT_GT(back.heights.texels[23], back.heights.texels[0]) << "to the right";
    EXPECT_GT(back.heights.texels[23 * 24], back.heights.texels[0]) << "downwards, against t";
}

// Other programs do not halve slopes at the border.
TEST(HeightsOfNormals, areSmoothWhereTheBorderHasAllOfItsSlope) {
    const int size = 32;
    const auto height = [](double x, double y) { return 0.3 * x - 0.2 * y + 0.05 * std::sin(3 * x + 2 * y); };
    const NormalMap map = normalsOf(size, size, Wrap::clamp, [&](int i, int j) {
        const double x = (i + 0.5) / size, y = 1 - (j + 0.5) / size;
        return dvec2(0.3 + 0.15 * std::cos(3 * x + 2 * y), -0.2 + 0.1 * std::cos(3 * x + 2 * y));
    });
    const HeightMap exact = heightsOf(size, size, Wrap::clamp, height);
    const IntegratedHeights back = integrate(map);
    EXPECT_LT(largestDifference(exact, back.heights), 1e-3);
    EXPECT_LT(back.residualShare(), 2e-3);
}

TEST(HeightsOfNormals, cannotRepeatAMeanSlope) {
    const NormalMap plane = normalsOf(16, 16, Wrap::repeat, [](int, int) { return dvec2(0.5, -0.25); });
    const IntegratedHeights back = integrate(plane);
    EXPECT_NEAR(back.residualShare(), 1, 1e-6);
    EXPECT_NEAR(back.meanSlope.x, 0.5, 1e-6);
    EXPECT_NEAR(back.meanSlope.y, -0.25, 1e-6);
    EXPECT_NEAR(back.slopeRms, std::hypot(0.5, 0.25), 1e-6);
    EXPECT_LT(back.heights.heightBound(), 1e-6);
}

// --- what cannot be integrated ------------------------------------------------------------------------------------

/// The transposed difference of a function of (column, row) along an axis, in the direction of s and t.
template <typename Function>
double transposed(const Function& psi, int size, Wrap wrap, int index) {
    const bool isFirst = index == 0, isLast = index == size - 1;
    if (wrap == Wrap::repeat) return 0.5 * (psi((index + size - 1) % size) - psi((index + 1) % size));
    return 0.5 * ((isFirst ? -psi(0) : psi(index - 1)) - (isLast ? -psi(size - 1) : psi(index + 1)));
}

/// Slopes of which no part is a gradient: (psi_t, -psi_s) by transposed differences.
dvec2 curl(int size, Wrap wrap, int i, int j) {
    const auto psi = [&](int x, int y) {
        return std::sin(2 * kPi * x / size + 0.3) * std::sin(4 * kPi * y / size + 1);
    };
    const double along = transposed([&](int x) { return psi(x, j); }, size, wrap, i);
    const double down = transposed([&](int y) { return psi(i, y); }, size, wrap, j);
    return {-down, -along};
}

TEST(HeightsOfNormals, ofACurlAreNone) {
    for (const Wrap wrap : kBoth) {
        const NormalMap map = normalsOf(32, 32, wrap, [&](int i, int j) { return curl(32, wrap, i, j); });
        const IntegratedHeights back = integrate(map);
        EXPECT_GT(back.slopeRms, 0.05);
        EXPECT_NEAR(back.residualShare(), 1, 1e-6) << int(wrap);
        EXPECT_LT(back.heights.heightBound(), 1e-6);
    }
}

TEST(HeightsOfNormals, sayHowMuchIsCurl) {
    for (const Wrap wrap : kBoth) {
        const HeightMap waves = heightsOf(
            32, 32, wrap, [](double s, double t) { return 0.02 * std::sin(2 * kPi * s) * std::sin(2 * kPi * t); });
        const NormalMap gradient = computeNormalMap(waves, {1, 1});
        const auto sum = [&](int i, int j) {
            const vec3 n = gradient.normals[std::size_t(j * 32 + i)];
            return dvec2(-n.x / n.z, -n.y / n.z) + curl(32, wrap, i, j);
        };
        const NormalMap pure = normalsOf(32, 32, wrap, [&](int i, int j) { return curl(32, wrap, i, j); });
        const double curlRms = integrate(pure).slopeRms, gradientRms = integrate(gradient).slopeRms;
        const IntegratedHeights back = integrate(normalsOf(32, 32, wrap, sum));
        EXPECT_NEAR(back.residualShare(), curlRms / std::hypot(curlRms, gradientRms), 1e-5);
        EXPECT_LT(largestDifference(waves, back.heights), 1e-5) << "the curl changes no height";
    }
}

// --- codes of few bits --------------------------------------------------------------------------------------------

/// Rounds normals as a picture of that many codes does.
NormalMap rounded(NormalMap map, double codes) {
    for (vec3& n : map.normals)
        n = glm::normalize(vec3(glm::round((0.5 * dvec3(n) + 0.5) * codes) / codes) * 2.0f - 1.0f);
    return map;
}

/// Root mean square of the second differences along rows: a pattern of single texels makes it large.
double roughness(const HeightMap& map) {
    double sum = 0;
    for (int j = 0; j < map.height; ++j)
        for (int i = 1; i + 1 < map.width; ++i) {
            const float* at = &map.texels[std::size_t(j * map.width + i)];
            sum += std::pow(double(at[-1]) + at[1] - 2.0 * at[0], 2);
        }
    return std::sqrt(sum / double(map.texels.size()));
}

TEST(HeightsOfNormals, ofEightBitsHaveNoPatternOfTexels) {
    for (const Wrap wrap : kBoth) {
        const HeightMap waves = heightsOf(
            256, 256, wrap, [](double s, double t) { return 0.003 * std::sin(2 * kPi * s) * std::sin(4 * kPi * t); });
        const NormalMap codes = rounded(computeNormalMap(waves, {1, 1}), 255);
        const double rounding = computeSlopeRounding({.sample = "uint8"});
        EXPECT_NEAR(rounding, 2 / 255.0 / std::sqrt(12.0), 1e-12);
        const IntegratedHeights smooth = integrate(codes, {.rounding = rounding}), exact = integrate(codes);
        EXPECT_LT(roughness(smooth.heights), 5 * roughness(waves));
        EXPECT_GT(roughness(exact.heights), 10 * roughness(waves));
        EXPECT_LT(largestDifference(waves, smooth.heights), 0.05);
    }
}

TEST(HeightsOfNormals, ofFloatsAreNotSmoothed) {
    EXPECT_EQ(computeSlopeRounding({.sample = "float"}), 0);
    EXPECT_EQ(computeSlopeRounding({.sample = "double"}), 0);
    EXPECT_GT(computeSlopeRounding({.sample = "half"}), computeSlopeRounding({.sample = "uint16"}));
}

// --- bad input ----------------------------------------------------------------------------------------------------

TEST(HeightsOfNormals, refuseNormalsThatNoHeightHas) {
    NormalMap map = normalsOf(4, 4, Wrap::repeat, [](int, int) { return dvec2(0); });
    map.normals[6] = vec3(1, 0, 0);
    map.normals[9] = vec3(0, 0, -1);
    expectFailure(Failure::input, {"map: 2 of 16 normals", "column 2, row 1"}, [&] { integrate(map); });
    map.space = NormalSpace::object;
    expectFailure(Failure::usage, {"map: ", "tangent space"}, [&] { integrate(map); });
}

} // namespace
} // namespace relief::test
