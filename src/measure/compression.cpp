#include "measure/compression.h"

#include <algorithm>
#include <cmath>

namespace relief {

CompressionStudy::CompressionStudy(Device& device, const TestScene& scene, double triangleCount,
                                   std::size_t sampleCount)
    : device_(device), scene_(scene), dicer_(device), diagonal_(computeDiagonal(scene.cage)),
      sampleCount_(sampleCount) {
    const double trianglesOfRate1 =
        (scene.surface.scheme == Scheme::loop ? 1 : 2) * double(surface(scene.surface.isolation).faces.size());
    const auto chooseRate = [&](double count) {
        return std::max(1, int(std::lround(std::sqrt(count / trianglesOfRate1))));
    };
    largestRate_ = std::max(2, chooseRate(2 * triangleCount));
    referenceRate_ = 2 * chooseRate(triangleCount);
    Compression reference = uncompressed();
    reference.rate = referenceRate_;
    referenceMesh_ = makeMesh(reference);
    reference_.emplace(TriangleView{referenceMesh_.positions, referenceMesh_.indices}, sampleCount);
}

Compression CompressionStudy::uncompressed() const {
    return {scene_.surface.isolation, scene_.height.width, MapFormat::real, largestRate_};
}

std::vector<int> CompressionStudy::listMapColumns() const {
    std::vector<int> all{scene_.height.width};
    for (int step = 1;; ++step) {
        const int columns = int(std::lround(scene_.height.width * std::exp2(-0.25 * step)));
        if (columns < 16) break;
        all.push_back(columns);
    }
    std::ranges::reverse(all);
    return all;
}

int CompressionStudy::computeMapRows(int columns) const {
    return std::max(1, int(std::lround(double(columns) * scene_.height.height / scene_.height.width)));
}

const Surface& CompressionStudy::surface(int isolation) {
    const auto found = surfaces_.find(isolation);
    if (found != surfaces_.end()) return found->second;
    SurfaceOptions options = scene_.surface;
    options.isolation = isolation;
    return surfaces_.emplace(isolation, buildSurface(scene_.cage, options)).first->second;
}

const EncodedMap& CompressionStudy::map(int columns, MapFormat format) {
    const auto found = maps_.find({columns, format});
    if (found != maps_.end()) return found->second;
    EncodedMap made = format == MapFormat::real
                          ? EncodedMap{resampleMap(scene_.height, columns, computeMapRows(columns)), {}}
                          : encode(map(columns, MapFormat::real).decoded, format);
    RELIEF_CHECK(made.decoded.width == columns);
    return maps_.emplace(std::pair(columns, format), std::move(made)).first->second;
}

SurfaceModel CompressionStudy::makeModel(const Compression& compression) {
    const EncodedMap& heights = map(compression.mapColumns, compression.format);
    return SurfaceModel(device_, {.surface = &surface(compression.isolation),
                                  .cagePositions = scene_.cage.positions,
                                  .height = &heights.decoded,
                                  .encoding = &heights.encoding});
}

DenseMesh CompressionStudy::makeMesh(const SurfaceModel& model, int rate) {
    return dicer_.diceToHost(model, makeUniformRates(model, rate), {.wantsTexCoords = scene_.cage.hasTexCoords()});
}

DenseMesh CompressionStudy::makeMesh(const Compression& compression) {
    return makeMesh(makeModel(compression), compression.rate);
}

MeshError CompressionStudy::computeError(const DenseMesh& mesh) const {
    RELIEF_CHECK(diagonal_ > 0);
    const MeasuredSurface measured({mesh.positions, mesh.indices}, sampleCount_);
    const SurfaceDistance distance = measureDistance(measured, *reference_);
    return {.rms = distance.rms() / diagonal_, .hausdorff = distance.hausdorff() / diagonal_};
}

void CompressionStudy::moveToReference(dvec3& position, dvec3& normal) const {
    moveToNearest(referenceMesh_, *reference_, position, normal);
}

const Evaluated& CompressionStudy::evaluate(const Compression& compression) {
    const auto found = evaluated_.find(compression);
    if (found != evaluated_.end()) return found->second;
    const SurfaceModel model = makeModel(compression);
    const DenseMesh mesh = makeMesh(model, compression.rate);
    const Evaluated evaluated{.error = computeError(mesh),
                              .counts = {mesh.positions.size(), mesh.indices.size() / 3},
                              .residentBytes = model.byteCount,
                              .evaluation = {model.hasTexCoords, model.hasWideIndices, compression.format}};
    return evaluated_.emplace(compression, evaluated).first->second;
}

std::uint64_t CompressionStudy::surfaceBytes(int isolation) {
    std::uint64_t& bytes = surfaceBytes_[isolation];
    if (bytes == 0)
        bytes =
            SurfaceModel(device_, {.surface = &surface(isolation), .cagePositions = scene_.cage.positions}).byteCount;
    return bytes;
}

double CompressionStudy::computeHeightDeviation() const {
    const HeightMap& map = scene_.height;
    double sum = 0, squares = 0;
    for (const float texel : map.texels) sum += texel, squares += double(texel) * texel;
    const double count = double(map.texels.size()), mean = sum / count;
    return std::abs(map.scale) * std::sqrt(std::max(0.0, squares / count - mean * mean)) / diagonal_;
}

double CompressionStudy::computeFormatError(int columns, MapFormat format) {
    const HeightMap &from = map(columns, MapFormat::real).decoded, &to = map(columns, format).decoded;
    RELIEF_CHECK(from.texels.size() == to.texels.size());
    double sum = 0;
    for (std::size_t i = 0; i < from.texels.size(); ++i) sum += std::pow(double(to.texels[i]) - from.texels[i], 2.0);
    return std::abs(from.scale) * std::sqrt(sum / double(from.texels.size())) / diagonal_;
}

} // namespace relief
