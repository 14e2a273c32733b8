// Internal: how far meshes, and surfaces of smaller maps, are from the reference surface of one subject.
#pragma once

#include <tuple>

#include "measure/parts.h"

namespace relief {

struct MeshError {
    double rms = 0, hausdorff = 0; ///< fractions of the diagonal of the cage's bounding box
};

/// A displaced surface in fewer bytes: what can be saved at.
struct Saving {
    int isolation = 6, side = 0; ///< `side`: columns of the map; rows in proportion
    MapFormat format = MapFormat::real;
    int rate = 1;
};
inline bool operator<(const Saving& a, const Saving& b) {
    return std::tie(a.isolation, a.side, a.format, a.rate) < std::tie(b.isolation, b.side, b.format, b.rate);
}

/// What a saving was found to be.
struct Judged {
    MeshError error;
    MeshCounts counts;
    std::uint64_t residentBytes = 0; ///< of surface and map on the device
    Evaluation evaluation;
};

/// The reference is the displaced surface itself at four times `triangles`; surfaces of up to twice as many are judged.
class Contest {
public:
    Contest(Device& device, const Subject& subject, double triangles, std::size_t sampleCount);

    [[nodiscard]] const Subject& subject() const { return subject_; }
    [[nodiscard]] const DenseMesh& reference() const { return referenceMesh_; }
    [[nodiscard]] int referenceRate() const { return referenceRate_; }
    [[nodiscard]] int largestRate() const { return largestRate_; } ///< that is judged
    [[nodiscard]] Saving everything() const;                       ///< nothing saved, at the largest rate
    [[nodiscard]] std::vector<int> sides() const; ///< columns of maps, four steps to a half, smallest first
    [[nodiscard]] int rowsOf(int side) const;     ///< in proportion
    [[nodiscard]] double diagonal() const { return diagonal_; }

    const Surface& surface(int isolation);
    const EncodedMap& map(int side, MapFormat format);
    std::unique_ptr<Model> model(const Saving& saving);
    DenseMesh mesh(const Saving& saving);

    MeshError errorOf(const DenseMesh& mesh) const;
    const MeshError& errorOf(const Saving& saving);
    const Judged& judged(const Saving& saving); ///< measured once
    std::uint64_t surfaceBytes(int isolation);  ///< on the device, without a map
    [[nodiscard]] double heightRms() const; ///< of the map's heights about their mean, as a fraction of the diagonal
    /// Of heights alone, as a fraction of the diagonal: what a format loses.
    double formatError(int side, MapFormat format);

private:
    Device& device_;
    const Subject& subject_;
    Dicer dicer_;
    double diagonal_;
    std::size_t sampleCount_;
    int referenceRate_ = 1, largestRate_ = 1;
    std::map<int, Surface> surfaces_;
    std::map<std::pair<int, MapFormat>, EncodedMap> maps_;
    DenseMesh meshOf(const Model& model, int rate);
    std::map<Saving, Judged> judged_;
    std::map<int, std::uint64_t> surfaceBytes_;
    DenseMesh referenceMesh_;
    std::optional<MeasuredSurface> reference_;
};

} // namespace relief
