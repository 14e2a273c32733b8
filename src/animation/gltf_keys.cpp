#include "animation/gltf_keys.h"

#include <algorithm>
#include <limits>

namespace relief {
namespace {

/// Parts of a key of a cubic spline, in the order of the file.
enum Part { kInTangent, kValue, kOutTangent };

/// A time between two keys: the first of them, and how far the time is from it.
struct Moment {
    std::size_t key = 0;
    double t = 0;        ///< 0..1
    double distance = 0; ///< seconds between the keys; 0: the first key alone holds
};

Moment momentAt(const GltfChannel& channel, double seconds) {
    const std::vector<float>& times = channel.times;
    const auto next = std::upper_bound(times.begin(), times.end(), seconds);
    if (next == times.begin()) return {};
    const auto key = std::size_t(next - times.begin()) - 1;
    if (next == times.end() || channel.interpolation == GltfInterpolation::step) return {.key = key};
    const double distance = double(*next) - times[key];
    return {.key = key, .t = (seconds - times[key]) / distance, .distance = distance};
}

double numberOf(const GltfChannel& channel, std::size_t key, Part part, std::size_t i) {
    const bool isCubic = channel.interpolation == GltfInterpolation::cubicSpline;
    return channel.values[(isCubic ? 3 * key + part : key) * channel.width + i];
}

/// Interpolates one number of the value (glTF 2.0, appendix C.3 to C.5); tangents are per second.
double interpolated(const GltfChannel& channel, const Moment& at, std::size_t i) {
    const double v0 = numberOf(channel, at.key, kValue, i);
    if (at.distance == 0) return v0;
    const double v1 = numberOf(channel, at.key + 1, kValue, i), t = at.t;
    if (channel.interpolation == GltfInterpolation::linear) return (1 - t) * v0 + t * v1;
    const double b0 = at.distance * numberOf(channel, at.key, kOutTangent, i);
    const double a1 = at.distance * numberOf(channel, at.key + 1, kInTangent, i);
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * v0 + (t3 - 2 * t2 + t) * b0 + (-2 * t3 + 3 * t2) * v1 + (t3 - t2) * a1;
}

dvec3 vectorAt(const GltfChannel& channel, const Moment& at) {
    return {interpolated(channel, at, 0), interpolated(channel, at, 1), interpolated(channel, at, 2)};
}

/// Normalises a rotation; no rotation where a spline passes through zero.
glm::dquat unit(const glm::dquat& q) { return glm::length(q) > 0 ? glm::normalize(q) : glm::dquat(1, 0, 0, 0); }

glm::dquat rotationOf(const GltfChannel& channel, std::size_t key) {
    const auto part = [&](std::size_t i) { return numberOf(channel, key, kValue, i); };
    return unit({part(3), part(0), part(1), part(2)});
}

/// Rotations between two keys are interpolated at constant speed, the short way round (appendix C.4).
glm::dquat rotationAt(const GltfChannel& channel, const Moment& at) {
    if (channel.interpolation == GltfInterpolation::cubicSpline)
        return unit({interpolated(channel, at, 3), interpolated(channel, at, 0), interpolated(channel, at, 1),
                     interpolated(channel, at, 2)});
    const glm::dquat from = rotationOf(channel, at.key);
    return at.distance == 0 ? from : unit(glm::slerp(from, rotationOf(channel, at.key + 1), at.t));
}

} // namespace

void applyClip(const GltfClip& clip, double seconds, GltfMotion& motion) {
    for (const GltfChannel& channel : clip.channels) {
        const Moment at = momentAt(channel, seconds);
        GltfTransform& transform = motion.transforms[channel.node];
        switch (channel.path) {
        case GltfPath::translation: transform.translation = vectorAt(channel, at); break;
        case GltfPath::rotation: transform.rotation = rotationAt(channel, at); break;
        case GltfPath::scale: transform.scale = vectorAt(channel, at); break;
        case GltfPath::weights:
            for (std::size_t i = 0; i < channel.width; ++i)
                motion.weights[channel.node][i] = interpolated(channel, at, i);
            break;
        }
    }
}

dvec2 keyRangeOf(const GltfClip& clip) {
    dvec2 range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (const GltfChannel& channel : clip.channels) {
        range.x = std::min(range.x, double(channel.times.front()));
        range.y = std::max(range.y, double(channel.times.back()));
    }
    return range.x < range.y ? range : dvec2(0);
}

} // namespace relief
