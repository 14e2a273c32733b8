// Normal maps: loading and convention.
#pragma once

#include <string>
#include <vector>

#include "base/base.h"

namespace relief {

/// What a lookup outside [0,1] finds: the map again, or its border.
enum class Wrap { repeat, clamp };

/// What the three numbers of a normal map are components along.
enum class NormalSpace { tangent, object };
inline constexpr Word<NormalSpace> kNormalSpaces[] = {
    {"tangent", NormalSpace::tangent, "along s, along t and along the surface's own normal"},
    {"object", NormalSpace::object, "along the object's x, y and z"},
};

/// Where the second number of a tangent-space map points: along t, which runs up the picture, or against it.
enum class NormalY { up, down };
inline constexpr Word<NormalY> kNormalYs[] = {
    {"up", NormalY::up, "green is up the picture (OpenGL, glTF, Blender)"},
    {"down", NormalY::down, "green is down the picture (DirectX, Unreal)"},
};

/// The unit squares of texture coordinates that a picture covers.
struct PictureTiles {
    ivec2 first{0}; ///< lowest (s,t)
    ivec2 count{1}; ///< squares along both

    [[nodiscard]] bool isOne() const { return first == ivec2(0) && count == ivec2(1); }
};

/// Unit normals, bilinear between texel centres. t points up, row 0 is the top of the picture.
struct NormalMap {
    int width = 0, height = 0;
    std::vector<vec3> normals; ///< width * height, row after row; unit
    /// Tangent: x along s, y along t (upwards, whatever the file has), z outwards.
    NormalSpace space = NormalSpace::tangent;
    Wrap wrap = Wrap::repeat;
    PictureTiles tiles;
    std::uint64_t emptyCount = 0; ///< texels that hold no normal, (0,0,1) here: black, or too short for a direction
    std::uint64_t belowCount = 0; ///< of tangent space: normals with z <= 0
    std::uint64_t firstBelow = 0; ///< number of the first of them

    [[nodiscard]] std::uint64_t byteCount() const { return normals.size() * sizeof(vec3); }
};

struct NormalOptions {
    NormalSpace space = NormalSpace::tangent;
    NormalY y = NormalY::up; ///< of the file; tangent space only
    double scale = 1;        ///< tangent space: factor of x and y before normals become unit (glTF 2.0, section 3.9.3)
    Wrap wrap = Wrap::repeat;
    ImageLimits limits; ///< of loadNormalMap
};

/// Makes unit normals of the first three channels of a picture: 2c - 1 of codes c from 0 to 1, or the numbers
/// themselves where a number is negative. `name` stands for the picture in messages.
/// Warns of texels that hold no normal, of numbers that are taken for components, and of tangent-space normals that
/// point below the surface.
/// Throws Failure::input for fewer than 3 channels and for numbers that are not finite.
NormalMap makeNormalMap(const Image& picture, const std::string& name, const NormalOptions& options,
                        const Warn& warn = warnOnStderr);

/// Reads a normal map as raw data: no number is decoded as a color. Warns as makeNormalMap does, of a file that says
/// that its numbers are sRGB or of a profile (not of a gamma alone, which many programs write), and of layers.
/// Throws as readImage and makeNormalMap do.
NormalMap loadNormalMap(const std::string& path, const NormalOptions& options, const Warn& warn = warnOnStderr);

} // namespace relief
