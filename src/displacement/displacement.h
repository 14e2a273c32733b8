// Height maps and the displaced surface: load, convention, lookup, double-precision reference.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "base/base.h"
#include "shared/maps.h"
#include "surface/surface.h"

namespace relief {

/// Normals of a displaced surface: of the limit surface below it, without the change of the normal along the surface,
/// or with it (shared/displacement.h).
enum class NormalKind { limit, firstOrder, full };

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
    std::optional<double> mid;   ///< stored value that means no displacement; default 0, 0.5 for unsigned integers
    std::optional<double> scale; ///< cage units for one unit of stored height; default 1
    std::string channel;         ///< name or number from 0, as findChannel reads it; "": the first
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
    [[nodiscard]] double heightBound() const;
    [[nodiscard]] std::uint64_t byteCount() const { return texels.size() * sizeof(float); }
};

/// What the texels of one channel are, counted before anything is stored of them. Voids are texels that hold the number
/// of the file's GDAL_NODATA; of samples with a unit also -9999, -32767, -32768, -99999, -2147483648 and numbers beyond
/// +-1e30, each where it stands apart: farther from all other heights than these span.
class HeightCensus {
public:
    explicit HeightCensus(const ImageInfo& info);
    void add(float texel);
    void finish(); ///< after the last one

    [[nodiscard]] bool isVoid(float texel) const;
    [[nodiscard]] std::uint64_t voidCount() const;
    /// "-9999 by its GDAL_NODATA"; "" without voids.
    [[nodiscard]] std::string voidReason() const;
    /// Of all that is finite and no void; lowest > highest where there is nothing.
    [[nodiscard]] float lowest() const { return lowest_; }
    [[nodiscard]] float highest() const { return highest_; }
    /// NaN and infinities that are no voids; the first one's number in the order of `add`.
    [[nodiscard]] std::uint64_t notFiniteCount() const { return notFiniteCount_; }
    [[nodiscard]] std::uint64_t firstNotFinite() const { return firstNotFinite_; }

private:
    static constexpr std::array<float, 5> kCustomary = {-9999, -32767, -32768, -99999, -2147483648.0f};
    static constexpr std::size_t kNoCustom = kCustomary.size(), kHugeLow = kNoCustom + 1, kHugeHigh = kNoCustom + 2;
    struct Custom {
        std::uint64_t count = 0;
        float lowest = INFINITY, highest = -INFINITY;
        bool isVoid = false;
    };
    [[nodiscard]] bool isNoData(float texel) const;
    [[nodiscard]] std::size_t customOf(float texel) const;

    bool takesCustomary_;
    std::optional<float> noData_; ///< as texels
    double fileSays_ = 0;
    float slack_ = 0;
    std::uint64_t count_ = 0, noDataCount_ = 0, notFiniteCount_ = 0, firstNotFinite_ = 0;
    std::array<Custom, kCustomary.size() + 2> custom_;
    float lowest_ = INFINITY, highest_ = -INFINITY;
};

/// Reads one channel as raw data. Voids are filled smoothly from the heights around them. Warns about 8-bit sources
/// (stairs), unsigned integer sources without a scale, voids, and a channel that is not named where the file has
/// layers. Throws as readImage does, and Failure::input for a missing channel, a texel that is not finite or voids
/// alone.
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
