// Internal: a displaced surface in fewer bytes, and how far such surfaces, and meshes, are from the surface as it is.
#pragma once

#include <tuple>

#include "distance/distance.h"
#include "measure/suite.h"

namespace relief {

/// Distances to the reference, both ways, as fractions of the diagonal of the cage's bounding box.
struct MeshError {
    double rms = 0, hausdorff = 0;
};

/// What is made smaller of a surface and its map.
struct Compression {
    int isolation = 6;  ///< depth of the refinement around extraordinary vertices
    int mapColumns = 0; ///< rows in proportion
    MapFormat format = MapFormat::real;
    int rate = 1; ///< segments per edge
};
inline bool operator<(const Compression& a, const Compression& b) {
    return std::tie(a.isolation, a.mapColumns, a.format, a.rate) <
           std::tie(b.isolation, b.mapColumns, b.format, b.rate);
}

/// What was found of a compression.
struct Evaluated {
    MeshError error;
    MeshCounts counts;
    std::uint64_t residentBytes = 0; ///< of surface and map on the device
    PatchEvaluation evaluation;
};

/// Makes and evaluates compressions of one scene. Everything is made and measured once, then kept.
class CompressionStudy {
public:
    /// The reference is the displaced surface at four times `triangleCount`; rates go up to twice that many triangles.
    /// Distances are taken at `sampleCount` points of each surface.
    CompressionStudy(Device& device, const TestScene& scene, double triangleCount, std::size_t sampleCount);

    [[nodiscard]] const TestScene& scene() const { return scene_; }
    [[nodiscard]] const DenseMesh& reference() const { return referenceMesh_; }
    [[nodiscard]] int referenceRate() const { return referenceRate_; }
    [[nodiscard]] int largestRate() const { return largestRate_; }
    [[nodiscard]] Compression uncompressed() const; ///< at the largest rate
    /// Lists columns of maps from 16 up to the scene's own, in steps of the fourth root of two.
    [[nodiscard]] std::vector<int> listMapColumns() const;
    [[nodiscard]] int computeMapRows(int columns) const;

    /// Makes the resampled map in a format.
    const EncodedMap& map(int columns, MapFormat format);
    SurfaceModel makeModel(const Compression& compression);
    DenseMesh makeMesh(const Compression& compression);

    [[nodiscard]] MeshError computeError(const DenseMesh& mesh) const;
    /// Moves a point to the nearest one of the reference and gives it the normal there, unless that looks the other
    /// way.
    void moveToReference(dvec3& position, dvec3& normal) const;
    const Evaluated& evaluate(const Compression& compression);
    /// Bytes on the device of the surface without a map.
    std::uint64_t surfaceBytes(int isolation);
    /// Standard deviation of the map's heights, as a fraction of the diagonal.
    [[nodiscard]] double computeHeightDeviation() const;
    /// RMS difference of heights that a format makes, as a fraction of the diagonal.
    double computeFormatError(int columns, MapFormat format);

private:
    const Surface& surface(int isolation);
    DenseMesh makeMesh(const SurfaceModel& model, int rate);

    Device& device_;
    const TestScene& scene_;
    Dicer dicer_;
    double diagonal_;
    std::size_t sampleCount_;
    int referenceRate_ = 1, largestRate_ = 1;
    std::map<int, Surface> surfaces_; ///< by isolation
    std::map<std::pair<int, MapFormat>, EncodedMap> maps_;
    std::map<Compression, Evaluated> evaluated_;
    std::map<int, std::uint64_t> surfaceBytes_; ///< by isolation
    DenseMesh referenceMesh_;
    std::optional<MeasuredSurface> reference_;
};

} // namespace relief
