// The scenes that are built in. Their maps are made by code, so that every run measures the same.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "bake/bake.h"
#include "measure/embedded.h"
#include "measure/suite.h"

namespace relief {
namespace {

/// Random numbers 0..1, the same on every machine (a linear congruential sequence: Knuth, TAOCP 2, 3.2.1).
class Random {
public:
    double operator()() {
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        return double(state_ >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 1;
};

/// A sum of plane waves in all directions, about -1..1: smooth noise whose finest feature is known.
class Waves {
public:
    /// Wavelengths from `shortest` (cage units) to four times that; amplitudes in proportion to them.
    Waves(int count, double shortest) {
        Random random;
        double squares = 0;
        for (int i = 0; i < count; ++i) {
            const double z = 2 * random() - 1, turn = 2 * kPi * random(), stretch = std::pow(4, random());
            const double r = std::sqrt(1 - z * z);
            waves_.push_back({2 * kPi / (shortest * stretch) * dvec3(r * std::cos(turn), r * std::sin(turn), z),
                              2 * kPi * random(), stretch});
            squares += stretch * stretch / 2;
        }
        for (Wave& wave : waves_) wave.height /= 2.5 * std::sqrt(squares); // 2.5 standard deviations are 1
    }
    double operator()(const dvec3& p) const {
        double sum = 0;
        for (const Wave& wave : waves_) sum += wave.height * std::cos(glm::dot(wave.direction, p) + wave.phase);
        return sum;
    }

private:
    static constexpr double kPi = 3.14159265358979323846;
    struct Wave {
        dvec3 direction;
        double phase, height;
    };
    std::vector<Wave> waves_;
};

/// Turns noise into plates with rims of a texel or two: grooves where the noise crosses zero, and plates of two levels
/// on both sides.
float makePlate(float wave) {
    if (std::abs(wave) < 0.06f) return -1;
    if (wave > 0) return wave > 0.35f ? 1 : 0.5f;
    return wave < -0.35f ? -0.2f : 0.2f;
}

/// Paints `height` (-1..1 of a point of the limit surface) onto a square map whose displacement bound is `bound`.
HeightMap paintMap(const Cage& cage, int side, double bound, const std::function<double(const dvec3&)>& height) {
    Atlas atlas(cage, side, side);
    Image image{side, side, 1, std::vector<float>(std::size_t(side) * std::size_t(side))};
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) { *image.at(x, y) = float(height(point.p)); });
    atlas.spread(image);
    return makeHeightMap(side, side, std::move(image.texels), 0, bound, Wrap::clamp);
}

/// The production cage in the folder RELIEF_DATA where it is there, else the octopus.
std::pair<std::string, Cage> readBuiltInCage() {
    const char* folder = std::getenv("RELIEF_DATA");
    const std::string path = std::string(folder != nullptr ? folder : "") + "/bigguy.obj";
    if (folder != nullptr && std::filesystem::exists(path)) return {"bigguy", readCage(path)};
    return {"octopus", parseObj(kOctopusObj, "octopus.obj")};
}

} // namespace

std::vector<TestScene> makeBuiltInScenes(bool isQuick) {
    const auto [name, cage] = readBuiltInCage();
    const double diagonal = computeDiagonal(cage);
    // The shortest wave is about eight edges of a mesh of a million triangles long; a quick run has a sixteenth of
    // them.
    const double coarser = isQuick ? 4 : 1;
    const HeightMap smooth =
        paintMap(cage, isQuick ? 512 : 2048, 0.003 * coarser * diagonal, Waves(24, 0.01 * coarser * diagonal));
    std::vector<float> plates;
    for (const float wave : smooth.texels) plates.push_back(makePlate(wave));
    const HeightMap crisp =
        makeHeightMap(smooth.width, smooth.height, std::move(plates), 0, 0.5 * smooth.scale, smooth.wrap);
    return {{name + ", smooth noise", cage, {}, smooth, {}}, {name + ", crisp plates", cage, {}, crisp, {}}};
}

} // namespace relief
