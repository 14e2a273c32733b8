// Height maps: values and what they mean, encodings for the device, loading.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "base/base.h"
#include "displacement/height_census.h"
#include "displacement/map_tiles.h"
#include "displacement/normal_map.h"
#include "shared/maps.h"
#include "surface/surface.h"

namespace relief {

// --- height maps --------------------------------------------------------------------------------------------------

struct VectorMap; // displacement/vector_map.h

/// Values and what they mean: h(s,t) = scale * (texel - mid), bilinear between texel centres. t points up, row 0 is the
/// top of the picture.
struct HeightMap {
    int width = 0, height = 0;
    std::vector<float> texels; ///< stored values, width * height, row after row
    double mid = 0;            ///< stored value that means no displacement
    double scale = 1;          ///< cage units per unit of stored value
    Wrap wrap = Wrap::repeat;
    float lowest = 0, highest = 0; ///< range of the stored values
    /// Not null: the surface is displaced by these vectors, and the texels are their lengths in cage units.
    std::shared_ptr<const VectorMap> vectors{};

    Addressing addressing = Addressing::texture;
    std::vector<MapTile> tiles; ///< of sets, by rows of unit squares or by faces; texels are those of all tiles then,
                                ///< and width and height those of the largest one
    std::shared_ptr<const FaceLinks> links; ///< of a map per face, once fitToFaces() has fitted it to a surface
    std::uint64_t topology = 0;             ///< hashTopology() of the cage that a map per face was made for

    /// Largest |h| in cage units.
    [[nodiscard]] double heightBound() const;
    [[nodiscard]] std::uint64_t byteCount() const { return texels.size() * sizeof(float); }
};

/// Makes a set of maps over unit squares of texture coordinates, in any order: they share mid and scale. `places` are
/// MapTile::place.
HeightMap makeTileSet(std::span<const HeightMap> maps, std::span<const ivec2> places);

/// Makes a map per face: `segments` per face are MapTile::segments, and `heightAt` is called for each of its nodes.
/// Heights on edges and in corners are those of their owners. Throws as linkFaces does.
HeightMap makeFaceMap(const Surface& surface, std::span<const ivec2> segments,
                      const std::function<double(int face, const dvec2& uv)>& heightAt);

/// Gives the edges and corners of a map per face the heights of their owners, and its tiles what faces across their
/// sides show. Throws Failure::input for another number of faces, and as linkFaces does.
void fitToFaces(HeightMap& map, const Surface& surface);

/// Makes a map of values in memory.
/// Throws Failure::input for a size that does not fit `texels` and for values that are not finite, Failure::usage for a
/// mid or scale that is not finite.
HeightMap makeHeightMap(int width, int height, std::vector<float> texels, double mid, double scale, Wrap wrap);

struct HeightSample {
    double h = 0;          ///< cage units
    double hs = 0, ht = 0; ///< central differences over one texel, cage units per unit of s and t
};

/// Looks the map up in double precision: h_s = (h(s+d,t) - h(s-d,t)) / 2d with d one texel, h_t likewise (Marschner,
/// CS 569 notes).
/// Of a map per face these are the height and its derivatives by u and v.
HeightSample sampleHeight(const HeightMap& map, const MapPlace& place);
/// Looks up a map over texture coordinates.
HeightSample sampleHeight(const HeightMap& map, const dvec2& st);

/// Makes one map of a set of tiles, over all unit squares that it spans: each as many texels as the largest tile, or as
/// many as keep it 16384 texels a side at most. Without a tile there is no height.
struct JoinedMap {
    HeightMap map; ///< over its own unit square
    PictureTiles tiles;
};
JoinedMap joinTiles(const HeightMap& set);

/// The slopes of a height map at each of its texels and those of its mips, down to a single texel: central differences
/// over one texel of the level, so that bilinear lookups of them are those of sampleHeight().
struct SlopeMap {
    int width = 0, height = 0;
    std::uint32_t levelCount = 0;
    float unit = 1; ///< the largest of level 0, cage units per unit of s and t
    std::vector<std::uint32_t>
        texels; ///< h_s / unit and h_t / unit as two halves, level after level, rows from the top
};
SlopeMap computeSlopes(const HeightMap& map);

// --- encodings ----------------------------------------------------------------------------------------------------

/// How the texels of a height map are stored on the device. Integers and blocks span a range of values.
enum class MapFormat : std::uint32_t {
    real = kMapReal,
    half = kMapHalf,
    unorm16 = kMapUnorm16,
    unorm8 = kMapUnorm8,
    bc4 = kMapBc4,
};
inline constexpr Word<MapFormat> kMapFormats[] = {
    {"float", MapFormat::real, "32-bit floats"},
    {"half", MapFormat::half, "16-bit floats"},
    {"unorm16", MapFormat::unorm16, "16-bit integers over the map's range"},
    {"unorm8", MapFormat::unorm8, "8-bit integers over the map's range"},
    {"bc4", MapFormat::bc4, "blocks of 4 x 4 texels, 4 bits per texel"},
};

/// The smallest format that holds every value of such a file.
MapFormat fileFormat(const ImageInfo& info);

/// How a map's values are stored; the default stores them as they are.
struct MapEncoding {
    MapFormat format = MapFormat::real;
    float base = 0, range = 1;        ///< integers and blocks: a value is base + range * (0..1)
    std::vector<std::uint8_t> blocks; ///< bc4: 8 bytes each, row after row
};

/// A map and how the device stores it.
struct EncodedMap {
    HeightMap decoded; ///< what a reader of the encoding finds: the values that the device displaces by
    MapEncoding encoding;
};

/// Rounds a map to what a format holds, over the map's own range.
/// Throws Failure::input for values beyond the range of half floats.
EncodedMap encode(const HeightMap& map, MapFormat format);

/// A map in the words of shared/maps.h, with its mip levels: each texel is the mean of four of the level before, or of
/// what there is. Texels that are not in BC4 blocks are in rows: the device gets them in blocks where it reads blocks.
struct MapWords {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> firsts; ///< first word of each level, of sets of each level of each tile
    std::vector<ivec2> sizes;          ///< of what is stored of each level, aprons included
    double mid = 0, scale = 0;         ///< h = scale * (number - mid) of the numbers that the words hold
    float roundOff = 0;                ///< largest difference of a mip's texel from the mean that it stands for
};
MapWords toWords(const HeightMap& decoded, const MapEncoding& encoding = {});

/// Bytes of a map's words, computed without making them.
std::uint64_t mapBytes(MapFormat format, int width, int height);
std::uint64_t mapBytes(MapFormat format, const HeightMap& map);

/// Encodes 16 values 0..1, row after row, as 8 bytes (Khronos Data Format Specification 1.3, section 20.3, "BC4
/// unsigned").
std::array<std::uint8_t, 8> encodeBc4(std::span<const float, 16> values);
std::array<float, 16> decodeBc4(std::span<const std::uint8_t, 8> block);

// --- loading ------------------------------------------------------------------------------------------------------

struct HeightOptions {
    std::optional<double> mid;   ///< default 0, 0.5 for unsigned integers
    std::optional<double> scale; ///< default 1
    std::string channel;         ///< name or number from 0, as findChannel reads it; "": the first
    Wrap wrap = Wrap::repeat;
    std::optional<MapFormat> format; ///< default: fileFormat
    ImageLimits limits;
};

/// Reads one channel of an image as raw data; of all files of a set where `path` is a TilePattern; or a map per face,
/// which fitToFaces() fits to its surface, and encode() stores, afterwards. Voids (HeightCensus) are filled smoothly
/// from the heights around them. Warns of 8-bit sources (stairs), of unsigned integer sources without a scale, of
/// voids, and of a channel that is not named where the file has layers. Throws as readImage does, and Failure::input
/// for a missing channel, a texel that is not finite, a map of voids only and a set whose files differ in their
/// channels, and as listTiles; Failure::device for a set larger than memory.
EncodedMap loadHeightMap(const std::string& path, const HeightOptions& options, const Warn& warn = warnOnStderr);

/// Whether a file holds a map per face: saveFaceMap() has written it.
bool isFaceMap(const ImageInfo& info);

/// What is known of a map per face without its texels.
struct FaceMapInfo {
    std::vector<ivec2> segments; ///< per face: MapTile::segments
    std::uint64_t topology = 0;  ///< hashTopology() of its cage
};
/// Throws Failure::input for a header that is none. `name` stands for the file in messages.
FaceMapInfo readFaceMapInfo(const ImageInfo& info, const std::string& name);

/// Writes a map per face as one .exr of packed tiles, with its layout and HeightMap::topology in the header: heights in
/// cage units, floats, or halves where these hold all of them. Throws as writeImage does.
void saveFaceMap(const std::string& path, const HeightMap& map);

} // namespace relief
