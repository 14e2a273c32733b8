// Internal: what suites share.
#pragma once

#include "measure/measure.h"

namespace relief {

/// A folder that is gone at the end of the scope, and after an interrupt.
class ScratchFolder {
public:
    ScratchFolder();
    [[nodiscard]] std::string operator/(const std::string& name) const { return folder_.path() + "/" + name; }

private:
    Temporary folder_;
};

/// A height map in a file.
struct MapFile {
    std::string codec;
    std::uint64_t bytes = 0;
};
/// In every lossless form that suits the format: EXR for floats, PNG for integers, blocks as they are.
std::vector<MapFile> mapFiles(const HeightMap& map, MapFormat format);
std::uint64_t cageFileBytes(const Cage& cage); ///< as OBJ

/// What a suite works with and adds to.
struct Bench {
    Device& device;
    const MeasureOptions& options;
    Results& results;
    Progress& progress;

    [[nodiscard]] int pictureSide() const { return options.isQuick ? 512 : 1024; }
    [[nodiscard]] int roundCount() const { return options.isQuick ? 3 : 5; }
};

double diagonalOf(const Cage& cage);
double millisecondsOf(const std::function<void()>& work);

/// A subject on the device, with what is asked of it again and again.
struct OnDevice {
    OnDevice(Device& device, const Subject& subject);

    Surface surface;
    SurfaceModel model;
    std::vector<Camera> views; ///< the camera's path: frame k sees view k mod 4
    Bounds bounds;

    /// Segments a cage edge that make about so many triangles.
    [[nodiscard]] int rateFor(double triangles) const;
    [[nodiscard]] RenderOptions renderOptions(int rate) const;
};

/// Rates with heights from the map itself, without mips: geometry is compared as it is.
EdgeRates exactRates(const SurfaceModel& model, int rate);

inline constexpr const char* kDense = "dense mesh, raw";
/// The triangles of a surface at a rate, and the same on the device.
DenseMesh denseMeshOf(Device& device, const SurfaceModel& model, int rate);
std::unique_ptr<MeshModel> denseModel(Device& device, const DenseMesh& mesh);

/// The views from which everything is drawn: a turn around the object in four steps.
std::vector<Camera> cameraPath(std::span<const dvec3> points);

/// A contestant that is drawn: frames of the warm-up do not count.
struct Drawn {
    std::string name;
    Instance instance;
    RenderOptions options;
    std::function<void(int round)> pose = [](int) {}; ///< what moves it; a part of its frame
    std::vector<double> wall, poses, rates, dice, color, light;
    FrameStats last; ///< with pipeline counts

    /// Adds times and counts, and what the model of bytes says of a dense mesh or a surface.
    void tell(Row& row) const;
};
/// Rounds that draw every contestant once, after one that is not measured; 0: that one alone, and it is measured, for
/// shaders that are compiled already.
void drawRounds(Renderer& renderer, std::span<const Camera> views, int roundCount, std::span<Drawn> all);

// --- suites, in the order in which they run; those of the device take the first subject

void measureBandwidth(Bench& bench, const Subject& subject);
void measureFrame(Bench& bench, const Subject& subject);
void measureAnimate(Bench& bench, const Subject& subject);
void measureMemory(Bench& bench, const Subject& subject);
void measureScaling(Bench& bench, const Subject& subject);
void measureStartup(Bench& bench, const Subject& subject);

} // namespace relief
