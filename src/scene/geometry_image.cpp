// Geometry images as objects: their triangles are polygons that are drawn themselves, and the square of the image is
// the unit square of their texture coordinates.
#include "geometry_image/geometry_image.h"

#include <algorithm>
#include <cmath>

#include "scene/loading.h"

namespace relief {

Cage readGeometryImageCage(const ObjectDesc& desc) {
    std::optional<GeometryImage> read;
    if (!desc.image) read = readGeometryImage(desc.cage);
    const GeometryImage& image = desc.image ? *desc.image : *read;
    const int mip = desc.mip.value_or(0);
    if (mip >= image.mipCount())
        fail(Failure::usage, "{}: --mip {} is none of its mips, which are 0 to {}", desc.cage, mip,
             image.mipCount() - 1);
    const SewnGrid grid = sewGrid(image, mip);
    Cage cage;
    cage.coordinates = image.coordinates;
    cage.faceSizes.assign(grid.corners.size() / 3, 3);
    for (const std::uint32_t sample : grid.samples) {
        cage.positions.push_back(image.positions[sample]);
        cage.normals.push_back(image.normals[sample]);
    }
    const auto size = std::uint32_t(image.sizeAt(mip));
    for (std::uint32_t sample = 0; sample < size * size; ++sample)
        cage.texCoords.push_back(vec2(sample % size, size - 1 - sample / size) / float(size - 1));
    for (const std::uint32_t corner : grid.corners) cage.corners.push_back(grid.vertices[corner]);
    cage.normalCorners = cage.corners;
    cage.texCorners = grid.corners;
    return cage;
}

SceneDesc withFittingMip(const SceneDesc& desc) {
    if (desc.object.mip || !isGeometryImageFile(desc.object.cage)) return desc;
    const auto read = std::make_shared<const GeometryImage>(readGeometryImage(desc.object.cage));
    const GeometryImage& image = *read;
    std::vector<dvec3> points;
    for (const vec3& p : image.positions) points.emplace_back(p);
    const View view = viewOf(makeCamera(desc, image.coordinates, points), desc.size.y);
    // The mean length on the screen of the sides of quads along rows.
    double pixels = 0;
    const auto size = std::size_t(image.size);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (i % size == size - 1) continue;
        const double distance = std::max(double(view.nearDistance), glm::length(points[i] - dvec3(view.eye)));
        pixels += glm::length(points[i + 1] - points[i]) / distance * double(view.pixelsAtUnitDistance);
    }
    pixels /= double(size * (size - 1));
    SceneDesc fitted = desc;
    fitted.object.image = read;
    const double mip = std::floor(std::log2(std::max(1.0, 1 / std::max(pixels, 1e-9))));
    fitted.object.mip = std::min(int(mip), image.mipCount() - 1);
    return fitted;
}

} // namespace relief
