#include "measure/contest.h"

#include <algorithm>
#include <cmath>

namespace relief {

Contest::Contest(Device& device, const Subject& subject, double triangles, std::size_t sampleCount)
    : device_(device), subject_(subject), dicer_(device), diagonal_(diagonalOf(subject.cage)),
      sampleCount_(sampleCount) {
    const double perFace = subject.surface.scheme == Scheme::loop ? 1 : 2;
    const double faces = perFace * double(surface(subject.surface.isolation).faces.size());
    const auto rateFor = [&](double count) { return std::max(1, int(std::lround(std::sqrt(count / faces)))); };
    largestRate_ = std::max(2, rateFor(2 * triangles));
    referenceRate_ = 2 * rateFor(triangles);
    Saving best = everything();
    best.rate = referenceRate_;
    referenceMesh_ = mesh(best);
    reference_.emplace(TriangleView{referenceMesh_.positions, referenceMesh_.indices}, sampleCount);
}

Saving Contest::everything() const {
    return {subject_.surface.isolation, subject_.height.width, MapFormat::real, largestRate_};
}

std::vector<int> Contest::sides() const {
    std::vector<int> sides{subject_.height.width};
    for (int step = 1;; ++step) {
        const int side = int(std::lround(subject_.height.width * std::exp2(-0.25 * step)));
        if (side < 16) break;
        sides.push_back(side);
    }
    std::ranges::reverse(sides);
    return sides;
}

int Contest::rowsOf(int side) const {
    return std::max(1, int(std::lround(double(side) * subject_.height.height / subject_.height.width)));
}

const Surface& Contest::surface(int isolation) {
    const auto found = surfaces_.find(isolation);
    if (found != surfaces_.end()) return found->second;
    SurfaceOptions options = subject_.surface;
    options.isolation = isolation;
    return surfaces_.emplace(isolation, buildSurface(subject_.cage, options)).first->second;
}

const EncodedMap& Contest::map(int side, MapFormat format) {
    const auto found = maps_.find({side, format});
    if (found != maps_.end()) return found->second;
    EncodedMap map = format == MapFormat::real ? EncodedMap{resampled(subject_.height, side, rowsOf(side)), {}}
                                               : encode(this->map(side, MapFormat::real).decoded, format);
    return maps_.emplace(std::pair(side, format), std::move(map)).first->second;
}

std::unique_ptr<Model> Contest::model(const Saving& saving) {
    const EncodedMap& map = this->map(saving.side, saving.format);
    return std::make_unique<Model>(device_, ModelDesc{.surface = &surface(saving.isolation),
                                                      .cagePositions = subject_.cage.positions,
                                                      .height = &map.decoded,
                                                      .encoding = &map.encoding});
}

DenseMesh Contest::meshOf(const Model& model, int rate) {
    return dicer_.diceToHost(model, exactRates(model, rate), {.wantsTexCoords = subject_.cage.hasTexCoords()});
}

DenseMesh Contest::mesh(const Saving& saving) { return meshOf(*model(saving), saving.rate); }

MeshError Contest::errorOf(const DenseMesh& mesh) const {
    const MeasuredSurface measured({mesh.positions, mesh.indices}, sampleCount_);
    const SurfaceDistance distance = measureDistance(measured, *reference_);
    return {.rms = distance.rms() / diagonal_, .hausdorff = distance.hausdorff() / diagonal_};
}

const Judged& Contest::judged(const Saving& saving) {
    const auto found = judged_.find(saving);
    if (found != judged_.end()) return found->second;
    const std::unique_ptr<Model> on = model(saving);
    const DenseMesh made = meshOf(*on, saving.rate);
    const MeshCounts counts{made.positions.size(), made.indices.size() / 3};
    const Evaluation evaluation{on->hasTexCoords(), on->hasWideIndices(), saving.format};
    return judged_.emplace(saving, Judged{errorOf(made), counts, on->byteCount(), evaluation}).first->second;
}

const MeshError& Contest::errorOf(const Saving& saving) { return judged(saving).error; }

std::uint64_t Contest::surfaceBytes(int isolation) {
    std::uint64_t& bytes = surfaceBytes_[isolation];
    if (bytes == 0)
        bytes = Model(device_, {.surface = &surface(isolation), .cagePositions = subject_.cage.positions}).byteCount();
    return bytes;
}

double Contest::heightRms() const {
    const HeightMap& map = subject_.height;
    double sum = 0, squares = 0;
    for (const float texel : map.texels) sum += texel, squares += double(texel) * texel;
    const double mean = sum / double(map.texels.size());
    return std::abs(map.scale) * std::sqrt(std::max(0.0, squares / double(map.texels.size()) - mean * mean)) /
           diagonal_;
}

double Contest::formatError(int side, MapFormat format) {
    const HeightMap &from = map(side, MapFormat::real).decoded, &to = map(side, format).decoded;
    double sum = 0;
    for (std::size_t i = 0; i < from.texels.size(); ++i) sum += std::pow(double(to.texels[i]) - from.texels[i], 2.0);
    return std::abs(from.scale) * std::sqrt(sum / double(from.texels.size())) / diagonal_;
}

} // namespace relief
