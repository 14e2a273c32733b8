// Maps of several tiles: one per unit square of texture coordinates (UDIM), or one per face of a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"
#include "shared/maps.h"
#include "surface/surface.h"

namespace relief {

/// How a map is looked up (shared/maps.h).
enum class Addressing : std::uint32_t {
    texture = kMapOfTexture, ///< one map over the unit square of texture coordinates
    tiles = kMapOfTiles,     ///< a tile per unit square; where there is none there is no displacement
    faces = kMapOfFaces,     ///< a tile per face over its (u,v), which needs no texture coordinates
};

/// A tile of a map. Rows of a unit square go down, from t = 1; those of a face go up, from v = 0. Around its texels
/// lies an apron: what lookups meet beyond its border.
struct MapTile {
    ivec2 place{0};        ///< lowest (s,t) of the unit square; of a face its number and 0
    ivec2 size{0};         ///< texels; of a face nodes along u and v, 2^segments + 1
    ivec2 segments{0};     ///< of a face: log2 of the segments along u and v
    std::size_t first = 0; ///< of its texels in HeightMap::texels, the apron's corner
};

/// How wide the apron of a tile is: texels or nodes.
inline int apronOf(Addressing addressing) {
    return addressing == Addressing::texture ? 0 : addressing == Addressing::tiles ? kTileApron : kFaceApron;
}

/// Where a height is looked up: a map's addressing says by which of these.
struct MapPlace {
    int face = 0;
    dvec2 uv{0}, st{0};
};

// --- sets of unit squares -----------------------------------------------------------------------------------------

/// How the name of a file numbers the tiles of a set.
struct TilePattern {
    enum class Numbers { udim, fromZero, fromOne };
    std::string before, after; ///< what stands in the path before and after the number
    Numbers numbers = Numbers::udim;
};

/// Finds the number in the name of a file: <UDIM> or %(UDIM)d for 1001 + u + 10 v, <uvtile> for u0_v0 and so on,
/// <UVTILE> the same from u1_v1 on. Empty for names of single files.
/// Throws Failure::usage for a name with two of them.
std::optional<TilePattern> findTilePattern(const std::string& path);

/// A file of a set.
struct TileFile {
    ivec2 place{0}; ///< MapTile::place
    std::string path;
};

/// Lists the files of a set, row after row from the lowest (s,t) on.
/// Throws Failure::file where there is none, and Failure::input for two files with one number, for numbers that are no
/// tile (below 1001), and for a file whose name is the pattern itself.
std::vector<TileFile> listTiles(const std::string& path);

/// The name that a pattern gives the tile at a place: "1001".
std::string nameTile(const TilePattern& pattern, const ivec2& place);

/// The tile over a unit square, or null.
const MapTile* findTileAt(std::span<const MapTile> tiles, const ivec2& place);

/// The tile that a point of a set belongs to, or null. On the border of a missing tile it is the tile beside it
/// (shaders/map_parts.glsl).
const MapTile* findTile(std::span<const MapTile> tiles, const dvec2& st);

// --- maps per face ------------------------------------------------------------------------------------------------

/// A stretch of a side of a face, and the side of another face that it lies on.
struct FaceLink {
    std::uint32_t face = kNoPatch;  ///< the other one; kNoPatch: there is none
    std::uint32_t side = 0;         ///< of the other one
    float ownStart = 0, ownEnd = 0; ///< along the own side
    float start = 0, end = 0;       ///< along the other side
    bool isOwner = false;           ///< heights along the edge are those of the other face
    bool continues = false;         ///< it is the only other face there: heights go on in it
};

/// Who shares edges and corners with whom, for maps whose edges and corners belong to their owners.
struct FaceLinks {
    std::vector<FaceLink> links;         ///< two per side, eight per face; the second one of split sides alone
    std::vector<Incidence> cornerOwners; ///< four per face
    std::vector<bool> isOneSided;        ///< four per face: no face continues the sides of an extraordinary corner
};
/// Throws Failure::usage for faces with three sides.
FaceLinks linkFaces(const Surface& surface);

/// A number of the topology of a cage: of its faces and their vertices.
std::uint64_t hashTopology(const Cage& cage);

} // namespace relief
