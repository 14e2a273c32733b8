// Internal: geometry images of a scene's surface, as one more way to store it.
#pragma once

#include "geometry_image/geometry_image.h"
#include "measure/compression.h"

namespace relief {

/// A geometry image of floats, and what was found of it.
struct MeasuredImage {
    GeometryImage image;
    MeshError error;
};

/// Spreads the surface of a scene over a square, once, and samples it at several sizes.
class GeometryImageStudy {
public:
    /// The surface is spread as a mesh of at most `triangleCount` triangles; images have up to `largestSize` samples
    /// per side.
    GeometryImageStudy(CompressionStudy& study, double triangleCount, int largestSize);

    /// Finds the smallest image whose RMS distance is within the tolerance; null where there is none.
    const MeasuredImage* findSmallest(double tolerance);
    /// Why the surface cannot be spread; empty where it is.
    [[nodiscard]] const std::string& complaint() const { return complaint_; }

private:
    const MeasuredImage& measure(int size);

    CompressionStudy& study_;
    std::optional<SpreadSurface> surface_;
    std::vector<int> sizes_; ///< rising
    std::map<int, MeasuredImage> measured_;
    std::string complaint_;
};

/// Bytes of an image's positions and normals as floats; it has no indices.
std::uint64_t geometryImageBytes(int size);
/// Writes an image and returns the size of the file.
std::uint64_t measureImageFile(const GeometryImage& image);

} // namespace relief
