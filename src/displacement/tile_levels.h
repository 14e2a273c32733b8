// For other modules: the levels of the tiles of a set, with the aprons that the device keeps around them
// (shared/maps.h).
#pragma once

#include <functional>

#include "displacement/displacement.h"

namespace relief {

/// A level of a tile as it is stored, apron included: row after row.
struct StoredLevel {
    ivec2 size{0};
    std::vector<float> texels;
};

/// The levels of all tiles of a set, computed once.
class TileLevels {
public:
    /// The set has to outlive it. Of unit squares it computes no more than `mostLevels`.
    explicit TileLevels(const HeightMap& set, std::uint32_t mostLevels = kMostMapLevels);
    /// The level of a tile, with what lookups meet beyond its border.
    [[nodiscard]] StoredLevel stored(std::size_t tile, std::uint32_t level) const;
    /// Writes what lies beyond the border of a unit square around `texels`, its level 0 as it is stored. What lies
    /// within is not written, and nothing else is read: all tiles may be filled at once.
    void fillApron(std::size_t tile, std::span<float> texels) const;

private:
    /// A level without its apron.
    struct Grid {
        ivec2 size{0};
        int stride = 0;         ///< from row to row
        std::vector<float> own; ///< its texels, or empty where they are the set's
        const float* texels = nullptr;

        explicit Grid(const ivec2& gridSize, std::vector<float> values)
            : size(gridSize), stride(gridSize.x), own(std::move(values)), texels(own.data()) {}
        Grid(const ivec2& gridSize, int rowStride, const float* ofSet)
            : size(gridSize), stride(rowStride), texels(ofSet) {}
        [[nodiscard]] float at(int x, int y) const { return texels[std::ptrdiff_t(y) * stride + x]; }
        [[nodiscard]] double bilinear(double x, double y) const; ///< texels have whole coordinates; clamped
    };
    using Grids = std::vector<Grid>; ///< per level

    void addUnitSquare(std::size_t tile, std::uint32_t mostLevels);
    void addFaces();
    [[nodiscard]] StoredLevel storedUnitSquare(std::size_t tile, std::uint32_t level) const;
    [[nodiscard]] double beyondUnitSquare(std::size_t tile, std::uint32_t level, int column, int row) const;

    // Maps per face.
    [[nodiscard]] const Grid& gridNear(std::uint32_t face, double segments, std::uint32_t side, bool along) const;
    [[nodiscard]] StoredLevel storedFace(std::size_t tile, std::uint32_t level) const;
    [[nodiscard]] double acrossSide(std::size_t tile, std::uint32_t level, std::uint32_t side, int node) const;
    void shareEdges(std::uint32_t level);
    void shareSide(std::size_t tile, std::uint32_t level, std::uint32_t side);

    const HeightMap& set_;
    std::vector<Grids> tiles_;
};

/// Whether all tiles of a set have as many texels.
bool hasOneSize(const HeightMap& set);

/// Levels that a tile has, and how large one is stored.
std::uint32_t countLevels(const HeightMap& set, const MapTile& tile);
ivec2 storedSize(const HeightMap& set, const MapTile& tile, std::uint32_t level);

/// The grid of unit squares around a set: its tiles and one row and column more on each side.
struct TileGrid {
    ivec2 first{0}, count{0};
};
TileGrid gridOf(const HeightMap& set);

} // namespace relief
