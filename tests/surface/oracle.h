// The independent reference: uniform refinement in double precision with limit masks. It has the limit surface only
// at the vertices of its last level, that is at dyadic (u,v), but there it is exact.
#pragma once

#include <memory>

#include <opensubdiv/far/topologyRefiner.h>

#include "surface/surface.h"

namespace relief {

namespace Far = OpenSubdiv::Far;

class Oracle {
public:
    /// Makes points at multiples of 1 / gridSize, gridSize a power of two.
    Oracle(const Cage& cage, Scheme scheme, int gridSize);

    /// Limit position of the face's grid point (i,j), i and j in 0..gridSize (i + j <= gridSize for triangles).
    [[nodiscard]] dvec3 position(int face, int i, int j) const { return positions_[vertexAt(face, i, j)]; }
    /// Texture coordinates there.
    [[nodiscard]] dvec2 texCoord(int face, int i, int j) const;
    /// Levels of refinement: more than the grid needs where there are n-gons or semi-sharp creases.
    [[nodiscard]] int levels() const { return refiner_->GetMaxLevel(); }
    [[nodiscard]] int faceCount() const { return int(grids_.size()); }
    [[nodiscard]] int gridSize() const { return gridSize_; }

private:
    /// A face's vertices at one level: (side + 1)² entries, row j, column i; unused ones of triangles stay -1.
    struct Grid {
        int side = 1;
        std::vector<int> vertices;

        explicit Grid(int side) : side(side), vertices(std::size_t(side + 1) * (side + 1), -1) {}
        [[nodiscard]] int at(int i, int j) const { return vertices[i + j * (side + 1)]; }
        int& at(int i, int j) { return vertices[i + j * (side + 1)]; }
    };

    void traceFaces();
    void makeGrids();
    [[nodiscard]] Grid startGrid(int cageFace, int corner) const;
    [[nodiscard]] Grid refined(const Grid& coarse, int level, int cageFace) const;
    [[nodiscard]] int faceAround(const Grid& grid, int level, int cageFace, int i, int j) const;
    [[nodiscard]] int vertexAt(int face, int i, int j) const;
    void interpolate(const Cage& cage);
    template <typename V, typename CornersOf>
    [[nodiscard]] V limitAtDart(int vertex, const std::vector<V>& values, const CornersOf& cornersOf) const;

    int sideCount_, gridSize_;
    std::unique_ptr<Far::TopologyRefiner> refiner_;
    std::vector<std::vector<int>> cageFaceOf_; ///< for each level, the cage's face that each face came from
    std::vector<Grid> grids_;                  ///< one for each ptex face, at the last level
    std::vector<int> cageFaces_;               ///< one for each ptex face
    std::vector<dvec3> positions_;             ///< limit positions of the last level's vertices
    std::vector<dvec2> texCoords_;             ///< limit values of the last level's face-varying channel
};

} // namespace relief
