// What all caches share: keys at rising times, read when they are needed.
#pragma once

#include "animation/animation.h"

namespace relief {

/// Where keys come from; they count from 0.
class KeyReader {
public:
    virtual ~KeyReader() = default;
    /// What messages call a key: "walk.pc2: frame 101".
    [[nodiscard]] virtual std::string name(std::size_t key) const = 0;
    /// One position a cage point; animateKeys checks that they are finite.
    virtual std::vector<vec3> read(std::size_t key) = 0; ///< in KeyUse::coordinates
};

struct KeyTimes {
    std::vector<double> seconds; ///< one a key, at least one
    bool areFloats = false;  ///< the file rounds them: a time that rounds to a key's is that key's, and frame k finds
                             ///< its own key, not a blend with the one before
    const char* remedy = ""; ///< what helps where they are wrong
};

struct KeyUse {
    Interpolation interpolation = Interpolation::linear;
    Coordinates coordinates; ///< of the positions that are read
};

/// The coordinates of keys whose first one has these bounds in the world: the cage's, with an origin nearer to the key
/// where that lies elsewhere.
Coordinates keyCoordinates(const Coordinates& cage, const Bounds& firstKey);

/// Keys in use are kept, so that frames in a row read each key once. Throws Failure::input unless all times are finite
/// and rise.
std::unique_ptr<Animation> animateKeys(std::unique_ptr<KeyReader> reader, KeyTimes times, const KeyUse& use);

/// Throws Failure::input, naming `key` and the point.
void checkFinite(const std::vector<vec3>& positions, const std::string& key);

/// Throws Failure::usage for a number of frames a second that makes no sense.
void checkFps(double fps);

/// The animation of `cage.{frame:4}.obj`.
std::unique_ptr<Animation> readCageSequence(const std::string& pattern, const Cage& cage, const CacheOptions& options);

} // namespace relief
