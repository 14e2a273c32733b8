// The options that verbs share, with the same words in each, and what they turn into.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "frame/frame.h"

namespace relief::app {

struct Output {
    bool isJson = false, isQuiet = false, isVerbose = false;
    ShowProgress progress = ShowProgress::automatic;

    [[nodiscard]] Warn warn() const; ///< silent with -q
};

struct SurfaceArgs {
    std::string cage;
    std::string scheme; ///< "": catmark, or none for a mesh of triangles
    int isolation = 6;
    std::string height;
    std::optional<double> scale, mid;
    int channel = 0;
    std::string wrap = "repeat";
};

struct TriangleArgs {
    std::string path; ///< "": what suits the verb
    std::optional<int> rate;
    double edgePixels = 2;
    std::string spacing = "equal", normal = "full";
    std::optional<std::uint64_t> memory;
};

struct CameraArgs {
    std::vector<int> size{1024, 1024};
    CameraOptions options;
    std::vector<double> lookAt;
    double distance = 0; ///< 0: frames the object
};

struct PictureArgs {
    TriangleArgs triangles;
    CameraArgs camera;
    std::string show = "shaded";
    std::string albedo, environment;
    std::vector<double> light, color;
    double roughness = 0.4;
    bool hasNoShadows = false;
    std::vector<double> background;
    bool isTransparent = false;
    std::string device;
};

void addOutput(CLI::App& app, Output& output);
void addProgress(CLI::App& app, ShowProgress& progress);
void addSurface(CLI::App& app, SurfaceArgs& args);
void addSurfaceOptions(CLI::App& app, SurfaceArgs& args); ///< the same without the cage itself
void addPath(CLI::App& app, std::string& word, const std::string& defaultWords);
void addTriangles(CLI::App& app, TriangleArgs& args); ///< all but the path, which not every verb can choose
void addNormal(CLI::App& app, std::string& word);
void addCamera(CLI::App& app, CameraArgs& args);
void addDevice(CLI::App& app, std::string& name);
void addPicture(CLI::App& app, PictureArgs& args);

NormalKind normalKind(const std::string& word);
/// "": tessellation where the device has it, else grid.
Path pathOf(const std::string& word, const Device& device);
TriangleOptions triangleOptions(const TriangleArgs& args, const Device& device);
Camera cameraOf(const CameraArgs& args, std::span<const dvec3> points);

double secondsNow();

/// A cage with everything made of it, in memory.
struct Loaded {
    Cage cage;
    std::optional<DenseMesh> dense; ///< instead of a surface, where no scheme applies
    Surface surface;
    std::optional<HeightMap> height;
    SurfaceOptions options;
    double loadSeconds = 0, surfaceSeconds = 0;

    [[nodiscard]] const HeightMap* heightMap() const { return height ? &*height : nullptr; }
};
Loaded load(const SurfaceArgs& args, const Output& output);
/// Points for framing: a coarse reference is enough.
std::vector<dvec3> outlineOf(const Loaded& loaded);

/// Throws when the validation layer (RELIEF_VALIDATE=1) complained.
void checkValidation(const Device& device);

} // namespace relief::app
