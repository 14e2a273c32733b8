// Height maps and the displaced surface: load, convention, lookup, double-precision reference.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "base/base.h"
#include "shared/maps.h"
#include "surface/surface.h"

namespace relief {

/// What a lookup outside [0,1] finds: the map again, or its border.
enum class Wrap { repeat, clamp };

/// How the texels of a height map are kept on the device. Integers and blocks span a range.
enum class MapFormat : std::uint32_t {
    real = kMapReal,       ///< 32-bit floats
    half = kMapHalf,       ///< 16-bit floats
    unorm16 = kMapUnorm16, ///< 16-bit integers
    unorm8 = kMapUnorm8,   ///< 8-bit integers
    bc4 = kMapBc4,         ///< 4 bits a texel: blocks of 4 x 4 texels
};
std::string nameOf(MapFormat format);
/// The smallest format that holds every value of such a file.
MapFormat fileFormat(const ImageInfo& info);

struct HeightOptions {
    std::optional<double> mid;   ///< stored value that means no displacement; default 0.5 integer files, 0 float files
    std::optional<double> scale; ///< cage units for one unit of stored height; default 1
    int channel = 0;             ///< 0-based channel of the file
    Wrap wrap = Wrap::repeat;
    std::optional<MapFormat> format; ///< default: the smallest that keeps what the file says
    ImageLimits limits;
};

/// h(s,t) = scale * (texel - mid), bilinear between texel centres; t points up, row 0 is the top of the picture.
struct HeightMap {
    int width = 0, height = 0;
    std::vector<float> texels; ///< stored values as read, width * height
    double mid = 0, scale = 1;
    Wrap wrap = Wrap::repeat;
    float lowest = 0, highest = 0; ///< range of the stored values

    MapFormat format = MapFormat::real; ///< `texels` are what a reader of it finds
    float base = 0, range = 1;          ///< integers and blocks: a stored value is base + range * (0..1)
    std::vector<std::uint8_t> blocks;   ///< bc4: 8 bytes each, row after row

    /// Largest |h| in cage units.
    [[nodiscard]] double reach() const;
    [[nodiscard]] std::uint64_t byteCount() const { return texels.size() * sizeof(float); }
};

/// Reads one channel as raw data. Warns about 8-bit sources (stairs) and integer sources without a scale.
/// Throws as readImage does, and Failure::input for a missing channel or a texel that is not finite.
HeightMap loadHeightMap(const std::string& path, const HeightOptions& options, const Warn& warn = warnOnStderr);

/// The map in another format: its texels are rounded to what that keeps, over their own range.
HeightMap inFormat(const HeightMap& map, MapFormat format);

/// The words of a map as the device holds them (shared/maps.h), with its mips: each texel the mean of four of the level
/// before, or of what there is.
struct MapWords {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> firsts; ///< first word of each level
    float roundOff = 0;                ///< largest difference of a mip's texel from the mean that it stands for
};
MapWords wordsOf(const HeightMap& map);
/// Bytes of them, without making them.
std::uint64_t mapBytes(MapFormat format, int width, int height);
/// h = scale * (number - mid) of the numbers that the words hold.
struct WordScale {
    double mid = 0, scale = 1;
};
WordScale wordScale(const HeightMap& map);

/// 16 values 0..1, row after row, as 8 bytes (Khronos Data Format Specification 1.3, section 20.3, "BC4 unsigned").
std::array<std::uint8_t, 8> encodeBc4(std::span<const float, 16> values);
std::array<float, 16> decodeBc4(std::span<const std::uint8_t, 8> block);

/// A map from values in memory (row 0 on top); checks the size and that all values are finite.
HeightMap makeHeightMap(int width, int height, std::vector<float> texels, double mid, double scale, Wrap wrap);

struct HeightSample {
    double h = 0;          ///< cage units
    double hs = 0, ht = 0; ///< central differences over one texel, cage units per unit of s and t
};

/// The lookup in double precision. DESIGN: h_s = (h(s+d,t) - h(s-d,t)) / 2d with d one texel (Marschner, CS 569 notes).
HeightSample sampleHeight(const HeightMap& map, const dvec2& st);

/// A point of the displaced surface with its three normals, in double precision (the oracle for the shaders).
struct DisplacedFrame {
    LimitFrame limit;
    dvec2 st{0};
    HeightSample height;
    dvec3 normal{0};     ///< unit limit normal n
    dvec3 q{0};          ///< p + h n
    dvec3 firstOrder{0}; ///< unit first-order normal (Blinn 1978)
    dvec3 full{0};       ///< unit full normal (Lee, Moreton, Hoppe 2000)
};

/// Evaluates the displaced surface at (face,u,v); without a map the height is zero. With `rest`, the same surface in
/// another pose, heights grow with the square root of the area gained since then (shared/displacement.h).
DisplacedFrame displacedFrame(const ReferenceSurface& surface, const HeightMap* map, int face, const dvec2& uv,
                              const ReferenceSurface* rest = nullptr);

} // namespace relief
