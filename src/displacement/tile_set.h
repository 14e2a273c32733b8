// Internal: sets of tiles while they are made.
#pragma once

#include "displacement/displacement.h"

namespace relief {

/// Makes room for the texels of all tiles of a set, and finds the size of the largest one.
void allocateTiles(HeightMap& set);

/// Copies the texels of a tile, without an apron, into its place.
void copyTile(std::span<const float> texels, HeightMap& set, const MapTile& tile);

/// Fills in aprons, and the edges and corners of faces, by what the tiles hold, and finds the range of values.
void finishTiles(HeightMap& set);

/// roundTo() of all tiles.
void roundTiles(HeightMap& set, const MapEncoding& encoding);

// --- loading ------------------------------------------------------------------------------------------------------

/// Throws Failure::device for a set of so many components whose texels, once more while aprons are filled, and words of
/// the device take more memory than there is. Of the set only the places and sizes of tiles are read.
void checkSetMemory(const std::string& path, const HeightMap& set, MapFormat format, int components = 1);

/// What loadHeightMap() does with one file.
EncodedMap loadTileSet(const std::string& path, const HeightOptions& options, const Warn& warn);
EncodedMap loadFaceMap(const std::string& path, const HeightOptions& options, const ImageInfo& info);

/// Parts of loadHeightMap().
ChannelIndex chooseChannel(const ImageInfo& info, const std::string& path, const std::string& word, const Warn& warn);
void warnAbout(const ImageInfo& info, const std::string& path, const HeightOptions& options, const Warn& warn);
HeightMap loadTexels(const std::string& path, const HeightOptions& options, const ImageInfo& info, const Warn& warn);

} // namespace relief
