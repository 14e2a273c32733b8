// Geometry images (Gu, Gortler and Hoppe 2002): a surface cut open to a disk, spread over a square and sampled on a
// grid. Neighbours in the picture are neighbours on the surface, so that no indices are stored; along the border the
// picture says which samples are the same.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "base/base.h"
#include "mesh/mesh.h"

namespace relief {

// --- the image ----------------------------------------------------------------------------------------------------

/// How the border of the square is sewn: it is a closed chain of paths, which runs counterclockwise from the lower left
/// corner of the picture. Lengths are in segments of the coarsest mip.
struct Sewing {
    struct Path {
        int segments = 0;
        int mate = 0; ///< the path that it is sewn to, which runs the other way; itself: a boundary of the surface
    };
    int sideSegments = 0; ///< along one side of the square at the coarsest mip
    int first = 0;        ///< where the first path starts: the segments from the lower left corner
    std::vector<Path> paths;
};

/// Points and normals of a surface at (s,t) = (i, size - 1 - j) / (size - 1) in column i and row j.
struct GeometryImage {
    int size = 0;                         ///< columns and rows
    std::vector<vec3> positions, normals; ///< size * size, row by row from the top
    Sewing sewing;
    Coordinates coordinates; ///< of the positions

    /// Mip k has every 2^k-th sample along both axes, so that its points lie on the surface and its border is sewn as
    /// that of the picture is. All of them end with the coarsest, of Sewing::sideSegments segments per side.
    [[nodiscard]] int mipCount() const;
    [[nodiscard]] int sizeAt(int mip) const { return ((size - 1) >> mip) + 1; }
};

/// The largest image and source that are accepted.
inline constexpr int kLargestGeometryImage = 4097;
inline constexpr std::uint64_t kMostSourceTriangles = 2'000'000;

// --- making -------------------------------------------------------------------------------------------------------

struct GeometryImageOptions {
    int size = 257; ///< columns and rows: 17 to kLargestGeometryImage; those of the form 2^k m + 1 have mips
    ShowProgress progress = ShowProgress::never;
};

/// What was found while an image was made.
struct GeometryImageReport {
    std::uint64_t triangles = 0;
    int genus = 0, boundaryCount = 0;
    int pathCount = 0;       ///< of the cut, without boundaries
    double cutLength = 0;    ///< in units of the positions
    double stretch = 0;      ///< root mean square stretch L2 of Sander et al. 2001; 1 is the least that there is
    double firstStretch = 0; ///< the same before it is made smaller
};

/// A surface that was cut open and spread over a square: makes images of several sizes.
class SpreadSurface {
public:
    /// Cuts and spreads a mesh whose vertices at equal positions are one; normals may be empty. `name` stands for it in
    /// messages. Throws Failure::input where it has edges of more than two triangles, vertices where parts only meet,
    /// triangles that are wound against each other, more than one part, no area, or too many triangles,
    /// or where its cut is too long for the size, and Failure::usage for a size that is none.
    SpreadSurface(const DenseMesh& mesh, const std::string& name, const GeometryImageOptions& options);
    ~SpreadSurface();
    SpreadSurface(SpreadSurface&&) noexcept;
    SpreadSurface& operator=(SpreadSurface&&) noexcept;

    /// Samples the surface at a multiple of sideSegments() segments per side. Throws Failure::usage for another size,
    /// and Failure::input where the triangles of a mip cannot be sewn.
    /// `settle` is called with the position and the normal of each sample, and may move both to the surface that the
    /// mesh only approximates. Samples of both sides of a cut are settled together; ends of paths are settled once per
    /// path, so that it must give the same for the same point. The normal need not be of unit length.
    using Settle = std::function<void(dvec3& position, dvec3& normal)>;
    [[nodiscard]] GeometryImage sample(int size, const Settle& settle = {}) const;
    /// Segments along one side of the coarsest image that sews: (options.size - 1) / 2^k.
    [[nodiscard]] int sideSegments() const;
    [[nodiscard]] const GeometryImageReport& report() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// --- as a mesh ----------------------------------------------------------------------------------------------------

/// The triangles of one mip: two per quad of the grid, along its shorter diagonal. The other one is taken where the
/// triangles then look along the normals, and where the sewn border would make two edges between the same vertices.
struct SewnGrid {
    std::vector<std::uint32_t> vertices; ///< per sample of the mip: its vertex; those that are sewn have the same one
    std::vector<std::uint32_t> samples;  ///< per vertex: the first sample of the picture that is this vertex
    std::vector<std::uint32_t> corners;  ///< three samples of the mip per triangle, counterclockwise
};
SewnGrid sewGrid(const GeometryImage& image, int mip);

/// The mesh of one mip, with one vertex per point. Throws Failure::usage for a mip that the image does not have.
DenseMesh toMesh(const GeometryImage& image, int mip = 0);

/// What is wrong with a mesh as a surface; all 0 where it is a manifold without boundary.
struct MeshFaults {
    std::uint64_t openEdges = 0;           ///< edges of one triangle
    std::uint64_t otherEdges = 0;          ///< edges of more than two triangles, or of two that run along it one way
    std::uint64_t degenerateTriangles = 0; ///< with a vertex twice
};
MeshFaults findFaults(std::span<const std::uint32_t> indices);
/// Counts the triangles that look against the sum of the normals at their corners.
std::uint64_t countTurned(const DenseMesh& mesh);

// --- files --------------------------------------------------------------------------------------------------------

/// True for the header of a picture that says that it is a geometry image.
bool isGeometryImage(const ImageInfo& info);
/// Whether an .exr file is a geometry image; false for other extensions. Throws as readImageInfo does.
bool isGeometryImageFile(const std::string& path);

/// Reads what a header says of the size, sewing and coordinates; no points. Throws Failure::input where that is
/// missing or impossible. `name` stands for the file in messages.
GeometryImage readGeometryImageInfo(const ImageInfo& info, const std::string& name);

/// Reads a geometry image. Throws Failure::file when reading fails, Failure::input for another picture, numbers that
/// are not finite, and samples that are sewn and differ.
GeometryImage readGeometryImage(const std::string& path);

/// The image as it comes back from a file of such samples, floats or halves: halves are relative to the box around the
/// surface.
GeometryImage roundSamples(const GeometryImage& image, SampleType sample);

/// Writes an .exr with channels X, Y, Z and NX, NY, NZ, of floats or halves, whole or not at all. Throws Failure::usage
/// for another extension, Failure::file when writing fails.
void writeGeometryImage(const std::string& path, const GeometryImage& source, SampleType sample = SampleType::real);

} // namespace relief
