// Internal: what suites share. Models and renderers are made and called in drawing.cpp and pictures.cpp, and where a
// suite measures just that.
#pragma once

#include "base/clock.h"
#include "measure/measure.h"

namespace relief {

/// A temporary folder, removed with its files at the end of the scope and by an interrupt.
class ScratchFolder {
public:
    /// Throws Failure::file where no folder can be made.
    ScratchFolder();
    [[nodiscard]] std::string operator/(const std::string& name) const { return folder_.path() + "/" + name; }

private:
    Temporary folder_;
};

/// The bytes of a height map in a file, and the metric of that kind of file.
struct MapFile {
    Metric metric;
    std::uint64_t bytes = 0;
};
/// Writes the map in every lossless form that suits the format: EXR for floats, PNG for integers, blocks as they are.
/// Throws Failure::file where that fails.
std::vector<MapFile> measureMapFiles(const HeightMap& map, MapFormat format);
/// The bytes of the cage as OBJ text.
std::uint64_t measureCageFile(const Cage& cage);

/// What a suite works with, and the results that it adds to.
struct SuiteContext {
    Device& device;
    const MeasureOptions& options;
    Results& results;
    Progress& progress;

    [[nodiscard]] int pictureSide() const { return options.isQuick ? 512 : 1024; } ///< pixels
    [[nodiscard]] int roundCount() const { return options.isQuick ? 3 : 5; }
};

/// Computes the diagonal of the bounding box of the cage's points, cage units.
double computeDiagonal(const Cage& cage);

// --- drawing.cpp: surfaces and meshes on the device, and how long frames of them take

/// Four views, a quarter of a turn around the object apart.
std::vector<Camera> makeCameraPath(std::span<const dvec3> points);

/// Options of a frame of a scene without shadows, seen from the first view.
RenderOptions makeRenderOptions(const Bounds& bounds, const Camera& camera);

/// A scene on the device, with its views.
struct SceneOnDevice {
    SceneOnDevice(Device& device, const TestScene& scene);

    Surface surface;
    SurfaceModel model;
    std::vector<Camera> views; ///< makeCameraPath()
    Bounds bounds;             ///< of the displaced surface

    /// Segments per edge that make about that many triangles, at least 1.
    [[nodiscard]] int chooseRate(double triangleCount) const;
    [[nodiscard]] RenderOptions renderOptions(int rate) const;
};

/// Makes equal rates for all edges. Heights are read from level 0 of the map, so that geometry is compared as it is.
EdgeRates makeUniformRates(const SurfaceModel& model, int rate);
/// Dices a surface at a rate into a mesh in host memory.
DenseMesh makeDenseMesh(Device& device, const SurfaceModel& model, int rate);
/// Uploads such a mesh as a model of its own.
MeshModel uploadDenseMesh(Device& device, const DenseMesh& mesh);

/// A way to draw a scene, and the times of its frames.
struct TimedDrawing {
    Method method;
    Instance instance;
    RenderOptions options;
    std::function<void(int round)> updatePose = [](int) {}; ///< its time is part of the frame's
    std::vector<double> frameTimes, poseTimes, rateTimes, diceTimes, colorTimes, lightTimes; ///< ms, one per round
    std::vector<double> shadowTimes, occlusionTimes, otherLightsTimes;
    FrameStats stats; ///< of the first frame, with pipeline counts

    /// Adds times, counts, and the bytes that the model of bytes computes of them.
    void addTo(Row& row) const;
};
/// Draws one warm-up round, in which shaders are compiled and invocations counted, then `roundCount` timed rounds; each
/// round draws everything once. With 0 rounds the warm-up is timed itself: for large frames whose shaders are compiled.
/// Frame k sees view k modulo the views.
void timeDrawings(Renderer& renderer, std::span<const Camera> views, int roundCount, std::span<TimedDrawing> drawings);

// --- suites, in the order in which they run

void measureMemory(SuiteContext& context, const TestScene& scene);
void measureStartup(SuiteContext& context, const TestScene& scene);
void measureFrame(SuiteContext& context, const TestScene& scene);
void measureScaling(SuiteContext& context, const TestScene& scene);
void measureAnimate(SuiteContext& context, const TestScene& scene);
void measureBandwidth(SuiteContext& context, const TestScene& scene);
void measureDetail(SuiteContext& context, const TestScene& scene);
void measureLight(SuiteContext& context, const TestScene& scene);

} // namespace relief
