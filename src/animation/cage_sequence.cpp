// Sequences of files with one cage each: the points move, the faces stay the same.
#include "animation/frames.h"
#include "animation/keys.h"

namespace relief {
namespace {

class CageSequence : public KeyReader {
public:
    CageSequence(std::string pattern, std::vector<int> frames, const Cage& cage)
        : pattern_(std::move(pattern)), frames_(std::move(frames)), pointCount_(cage.positions.size()),
          faceSizes_(cage.faceSizes), corners_(cage.corners) {
        // A sequence of another cage is refused at once.
        const Cage first = parse(0, {});
        const Bounds bounds =
            computeBounds(first.positions, [&](const vec3& p) { return first.coordinates.toWorld(dvec3(p)); });
        coordinates_ = keyCoordinates(cage.coordinates, bounds);
    }

    [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }

    [[nodiscard]] std::string name(std::size_t key) const override {
        return fmt::format("{}: frame {}", frameName(pattern_, frames_[key]), frames_[key]);
    }

    std::vector<vec3> read(std::size_t key) override { return parse(key, coordinates_).positions; }

private:
    [[nodiscard]] Cage parse(std::size_t key, const std::optional<Coordinates>& coordinates) const {
        const std::string path = frameName(pattern_, frames_[key]);
        Cage cage = parseObj(
            readFile(path), path, [](const std::string&) {}, coordinates); // tags mean nothing here
        checkTopology(cage, name(key));
        return cage;
    }
    void checkTopology(const Cage& cage, const std::string& key) const;

    std::string pattern_;
    std::vector<int> frames_;
    std::size_t pointCount_;
    std::vector<std::uint32_t> faceSizes_, corners_;
    Coordinates coordinates_; ///< of the cage, for all frames
};

void CageSequence::checkTopology(const Cage& cage, const std::string& key) const {
    constexpr const char* kRule = "all files of a sequence need the faces of the cage";
    if (cage.positions.size() != pointCount_)
        fail(Failure::input, "{}: there are {} points, the cage has {}; {}", key, cage.positions.size(), pointCount_,
             kRule);
    if (cage.faceCount() != faceSizes_.size())
        fail(Failure::input, "{}: there are {} faces, the cage has {}; {}", key, cage.faceCount(), faceSizes_.size(),
             kRule);
    std::size_t corner = 0;
    for (std::size_t face = 0; face < faceSizes_.size(); ++face) {
        if (cage.faceSizes[face] != faceSizes_[face])
            fail(Failure::input, "{}: face {} has {} corners, in the cage {}; {}", key, face, cage.faceSizes[face],
                 faceSizes_[face], kRule);
        for (std::uint32_t k = 0; k < faceSizes_[face]; ++k, ++corner)
            if (cage.corners[corner] != corners_[corner])
                fail(Failure::input, "{}: corner {} of face {} is point {}, in the cage {}; {}", key, k, face,
                     cage.corners[corner], corners_[corner], kRule);
    }
}

} // namespace

std::unique_ptr<Animation> readCageSequence(const std::string& pattern, const Cage& cage, const CacheOptions& options) {
    if (lowerExtension(pattern) != ".obj")
        fail(Failure::input, "{}: unknown kind of sequence '{}'; use .obj", pattern, lowerExtension(pattern));
    const std::vector<int> frames = framesOnDisk(pattern);
    KeyTimes times;
    for (const int frame : frames) times.seconds.push_back(frame / options.fps);
    auto reader = std::make_unique<CageSequence>(pattern, frames, cage);
    const Coordinates coordinates = reader->coordinates();
    return animateKeys(std::move(reader), std::move(times), {options.interpolation, coordinates});
}

} // namespace relief
