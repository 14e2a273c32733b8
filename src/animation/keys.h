// What all point caches share: keys at rising times, read when they are needed.
#pragma once

#include "animation/animation.h"

namespace relief {

/// Reads keys, which are numbered from 0.
class KeyReader {
public:
    virtual ~KeyReader() = default;
    /// The name of a key in messages: "walk.pc2: frame 101".
    [[nodiscard]] virtual std::string name(std::size_t key) const = 0;
    /// Reads one position per cage point, in KeyUse::coordinates; animateKeys checks that they are finite.
    virtual std::vector<vec3> read(std::size_t key) = 0;
};

struct KeyTimes {
    std::vector<double> seconds; ///< one per key, at least one
    bool areFloats = false;  ///< the file rounds them: a time that rounds to a key's is that key's, and frame k finds
                             ///< its own key, not a blend with the one before
    const char* remedy = ""; ///< advice for the message where times are wrong; may be empty
};

struct KeyUse {
    Interpolation interpolation = Interpolation::linear;
    Coordinates coordinates; ///< of the positions that are read
};

/// Chooses the coordinates of keys whose first one has these bounds in the world: those of the cage, with an origin
/// nearer to the key where the key is far away from it.
Coordinates keyCoordinates(const Coordinates& cage, const Bounds& firstKey);

/// Makes an animation of keys. It keeps two keys, so that consecutive frames read each key once. Throws Failure::input
/// unless all times are finite and rise.
std::unique_ptr<Animation> animateKeys(std::unique_ptr<KeyReader> reader, KeyTimes times, const KeyUse& use);

/// Throws Failure::input, naming `key` and the point, for positions that are not finite.
void checkFinite(const std::vector<vec3>& positions, const std::string& key);

/// Throws Failure::usage for a number of frames per second outside 0.001..1000000.
void checkFps(double fps);

/// Opens a sequence of cages: `cage.{frame:4}.obj`. Throws as readPointCache.
std::unique_ptr<Animation> readCageSequence(const std::string& pattern, const Cage& cage, const CacheOptions& options);

} // namespace relief
