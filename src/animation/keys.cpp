#include "animation/keys.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relief {
namespace {

vec3 blend(const vec3& a, const vec3& b, double share) { return dvec3(a) + share * (dvec3(b) - dvec3(a)); }

class KeyedAnimation : public Animation {
public:
    KeyedAnimation(std::unique_ptr<KeyReader> reader, KeyTimes times, const KeyUse& use)
        : Animation(use.coordinates), reader_(std::move(reader)), times_(std::move(times)),
          interpolation_(use.interpolation) {}

    [[nodiscard]] Pose pose(double seconds) const override;
    [[nodiscard]] dvec2 keyRange() const override;

private:
    [[nodiscard]] double snapped(double seconds) const;
    [[nodiscard]] const std::vector<vec3>& positions(std::size_t key) const;

    struct KeptKey {
        std::size_t key = SIZE_MAX;
        std::vector<vec3> positions;
    };
    std::unique_ptr<KeyReader> reader_;
    KeyTimes times_;
    Interpolation interpolation_;
    mutable std::array<KeptKey, 2> kept_; ///< key k in k % 2: two neighbours are there together
};

double KeyedAnimation::snapped(double seconds) const {
    const std::vector<double>& all = times_.seconds;
    const double clamped = std::clamp(seconds, all.front(), all.back());
    const auto rounded = double(float(clamped));
    return times_.areFloats && std::binary_search(all.begin(), all.end(), rounded) ? rounded : clamped;
}

const std::vector<vec3>& KeyedAnimation::positions(std::size_t key) const {
    KeptKey& kept = kept_[key % 2];
    if (kept.key == key) return kept.positions;
    std::vector<vec3> positions = reader_->read(key);
    checkFinite(positions, reader_->name(key));
    kept = {key, std::move(positions)};
    return kept.positions;
}

Pose KeyedAnimation::pose(double seconds) const {
    if (std::isnan(seconds)) fail(Failure::usage, "the time is not a number; give seconds");
    const std::vector<double>& all = times_.seconds;
    const double time = snapped(seconds);
    const auto key = std::size_t(std::upper_bound(all.begin(), all.end(), time) - all.begin()) - 1;
    Pose pose{.positions = positions(key), .joints = {}, .morphWeights = {}};
    if (interpolation_ == Interpolation::step || time == all[key]) return pose;

    const double share = (time - all[key]) / (all[key + 1] - all[key]);
    const std::vector<vec3>& next = positions(key + 1);
    for (std::size_t i = 0; i < next.size(); ++i) pose.positions[i] = blend(pose.positions[i], next[i], share);
    return pose;
}

dvec2 KeyedAnimation::keyRange() const {
    if (times_.seconds.size() == 1) return dvec2(0);
    return {times_.seconds.front(), times_.seconds.back()};
}

void checkTimes(const KeyTimes& times, const KeyReader& reader) {
    const std::vector<double>& seconds = times.seconds;
    const std::string remedy = *times.remedy == 0 ? "" : fmt::format("; {}", times.remedy);
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        if (!std::isfinite(seconds[i]))
            fail(Failure::input, "{} is at {} seconds; a finite number is needed{}", reader.name(i), seconds[i],
                 remedy);
        if (i > 0 && seconds[i] <= seconds[i - 1])
            fail(Failure::input, "{} is at {} seconds, the frame before it at {}; times must rise{}", reader.name(i),
                 seconds[i], seconds[i - 1], remedy);
    }
}

} // namespace

void checkFinite(const std::vector<vec3>& positions, const std::string& key) {
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(positions[i][k]))
                fail(Failure::input, "{}: point {} is not finite ({} {} {})", key, i, positions[i].x, positions[i].y,
                     positions[i].z);
}

Coordinates keyCoordinates(const Coordinates& cage, const Bounds& firstKey) {
    constexpr double kFar = 64; // of its sizes away a key has lost 6 of the 24 bits of a float
    const Bounds local{.lower = cage.toLocal(firstKey.lower), .upper = cage.toLocal(firstKey.upper)};
    Coordinates coordinates = cage;
    if (glm::length(local.center()) > kFar * local.diagonal())
        coordinates.origin += cage.unit * coordinatesFor(local).origin;
    return coordinates;
}

void checkFps(double fps) {
    if (!(fps >= 1e-3 && fps <= 1e6)) fail(Failure::usage, "{} frames per second; 0.001 to 1000000 are possible", fps);
}

std::unique_ptr<Animation> animateKeys(std::unique_ptr<KeyReader> reader, KeyTimes times, const KeyUse& use) {
    checkTimes(times, *reader);
    return std::make_unique<KeyedAnimation>(std::move(reader), std::move(times), use);
}

} // namespace relief
