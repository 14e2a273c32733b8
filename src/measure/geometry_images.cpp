#include "measure/geometry_images.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace relief {

GeometryImageStudy::GeometryImageStudy(CompressionStudy& study, double triangleCount, int largestSize) : study_(study) {
    // Every method starts from the same surface: this one spreads a mesh of it in some seconds, and takes its samples
    // from the surface itself.
    Compression compression = study.uncompressed();
    const double perRate = double(study.reference().indices.size()) / 3 / std::pow(study.referenceRate(), 2);
    compression.rate = std::max(1, int(std::sqrt(triangleCount / perRate)));
    try {
        surface_.emplace(study.makeMesh(compression), study.scene().name, GeometryImageOptions{.size = largestSize});
    } catch (const Error& error) {
        if (error.failure != Failure::input) throw;
        complaint_ = error.what();
        return;
    }
    const int side = surface_->sideSegments();
    for (int times = 1; times * side < largestSize; times *= 2)
        for (const int quarters : {4, 5, 6, 7})
            if (times * quarters % 4 == 0 && times * quarters / 4 * side < largestSize)
                sizes_.push_back(times * quarters / 4 * side + 1);
}

const MeasuredImage& GeometryImageStudy::measure(int size) {
    const auto found = measured_.find(size);
    if (found != measured_.end()) return found->second;
    MeasuredImage measured{
        .image = surface_->sample(size,
                                  [this](dvec3& position, dvec3& normal) { study_.moveToReference(position, normal); }),
        .error = {}};
    measured.error = study_.computeError(toMesh(measured.image));
    return measured_.emplace(size, std::move(measured)).first->second;
}

const MeasuredImage* GeometryImageStudy::findSmallest(double tolerance) {
    // Errors fall as images grow.
    const auto isBeyond = [&](int size) { return measure(size).error.rms > tolerance; };
    const auto found = std::ranges::partition_point(sizes_, isBeyond);
    return found == sizes_.end() ? nullptr : &measure(*found);
}

std::uint64_t geometryImageBytes(int size) { return 2 * sizeof(vec3) * std::uint64_t(size) * std::uint64_t(size); }

std::uint64_t measureImageFile(const GeometryImage& image) {
    const ScratchFolder folder;
    writeGeometryImage(folder / "image.exr", image);
    return std::filesystem::file_size(folder / "image.exr");
}

} // namespace relief
