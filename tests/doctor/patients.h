// Small cages and maps that the doctor examines, and what is expected of its findings.
#pragma once

#include <numbers>
#include <random>

#include "bake/bake.h"
#include "doctor/doctor.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {

inline constexpr double kTurn = 2 * std::numbers::pi;

struct Patient {
    Cage cage;
    SurfaceOptions options;
    Surface surface;
    ReferenceSurface reference;
    SurfaceLayout layout;

    explicit Patient(Cage of, Scheme scheme = Scheme::catmark)
        : cage(std::move(of)), options{.scheme = scheme}, surface(buildSurface(cage, options)),
          reference(cage, options), layout(makeLayout(surface, reference)) {}
    [[nodiscard]] DoctorSubject subject() const { return {&surface, &reference, &layout, 1}; }
};

inline const Patient& torusPatient() {
    static const Patient patient(torusWithSeams());
    return patient;
}
inline const Patient& cubePatient() {
    static const Patient patient(cubeOfIslands());
    return patient;
}

// --- maps ---------------------------------------------------------------------------------------------------------

template <typename Function>
Image mapOf(int width, int height, const Function& function) {
    Image image{.width = width, .height = height, .channels = 1, .texels = {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.texels.push_back(float(function((x + 0.5) / width, 1 - (y + 0.5) / height)));
    return image;
}

/// Waves that repeat, -0.05 to 0.05.
inline double waves(double s, double t) {
    return 0.03 * std::sin(kTurn * (2 * s + t)) + 0.02 * std::cos(kTurn * (s - 3 * t) + 1);
}
/// Bumps of up to 0.1 on a flat ground.
inline double bumps(double s, double t) {
    return 0.2 * std::max(0.0, std::sin(kTurn * 2 * s) * std::sin(kTurn * 2 * t) - 0.5);
}

/// Heights by the position on the cube: both sides of each seam agree.
inline Image bakedOnCube(int side, double (*heightAt)(const dvec3&)) {
    Atlas atlas(cubePatient().cage, side, side);
    Image image{.width = side, .height = side, .channels = 1, .texels = {}};
    image.texels.resize(std::size_t(side) * std::size_t(side), 0);
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) { *image.at(x, y) = float(heightAt(point.p)); });
    atlas.spread(image);
    return image;
}
inline double swellAt(const dvec3& p) {
    return 0.05 * std::sin(2 * p.x + 1.5 * p.y) + 0.04 * std::cos(2.5 * p.z - p.y);
}
inline double knobAt(const dvec3& p) {
    return 0.1 * std::max(0.0, std::sin(4 * p.x) * std::sin(4 * p.y) * std::sin(4 * p.z));
}

template <typename Change>
Image changed(Image image, const Change& change) {
    for (float& texel : image.texels) texel = float(change(double(texel)));
    return image;
}
/// Values -0.1 to 0.1 as 0 to 1.
inline Image centred(const Image& image) {
    return changed(image, [](double h) { return 0.5 + 5 * h; });
}
inline Image inSteps(const Image& image, int steps, int of) {
    return changed(image, [&](double x) { return double(of) * std::lround(x * steps) / 65535; });
}
/// Row and column by functions of (x, y).
template <typename Where>
Image moved(const Image& image, const Where& where) {
    Image result = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const ivec2 from = where(x, y);
            *result.at(x, y) = *image.at(from.x, from.y);
        }
    return result;
}

// --- examination ----------------------------------------------------------------------------------------------------

struct DoctorOnMaps : testing::Test {
    TemporaryFolder folder;
    int count = 0;

    [[nodiscard]] std::string write(const Image& image, SampleType sample, const std::string& extension) {
        const std::string path = folder / (std::to_string(count++) + extension);
        writeImage(path, image, sample);
        return path;
    }
    [[nodiscard]] std::string writeFloat(const Image& image) { return write(image, SampleType::real, ".exr"); }
    [[nodiscard]] std::string write16(const Image& image) { return write(image, SampleType::uint16, ".png"); }

    static Examination examine(const Patient& patient, const std::string& path, std::optional<double> mid = {},
                               double scale = 1) {
        return examineMap(path, {.height = {.mid = mid, .scale = scale, .limits = {}}}, patient.subject());
    }
    /// A fault of this kind is found, and no other fault.
    static void expectFound(FindingKind kind, const Examination& examination, bool isFault = true) {
        const char* word = wordOf(kFindingKinds, kind);
        bool isFound = false;
        for (const Finding& finding : examination.findings) {
            isFound = isFound || (finding.kind == kind && finding.isFault == isFault);
            EXPECT_TRUE(finding.kind == kind || !finding.isFault)
                << word << " was planted, and this is found: " << finding.text;
            EXPECT_FALSE(finding.text.empty() || finding.advice.empty());
        }
        EXPECT_TRUE(isFound) << word;
    }
    static void expectSilent(const Examination& examination) {
        for (const Finding& finding : examination.findings)
            ADD_FAILURE() << wordOf(kFindingKinds, finding.kind) << ": " << finding.text;
        EXPECT_TRUE(examination.isHealthy());
        EXPECT_GT(examination.bound, 0.005);
    }
    static const Finding& only(const Examination& examination) {
        EXPECT_EQ(examination.findings.size(), 1u);
        return examination.findings.front();
    }
};

} // namespace relief::test
