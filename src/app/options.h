// The options that verbs share, with the same words in each, and what they turn into.
#pragma once

#include <memory>
#include <optional>
#include <set>

#include <CLI/CLI.hpp>

#include "frame/frame.h"
#include "pose/pose.h"

namespace relief::app {

struct Output {
    bool isJson = false, isQuiet = false, isVerbose = false;
    ShowProgress progress = ShowProgress::automatic;

    [[nodiscard]] Warn warn() const; ///< silent with -q; a line that was printed is not printed again
    std::shared_ptr<std::set<std::string>> warned = std::make_shared<std::set<std::string>>();
};

/// What moves the cage.
struct PoseArgs {
    std::string cache, skin, clip, deform;
    bool bindsNearest = false, countsCacheFrames = false;
    std::string interpolation = "linear";
    double fps = 24;
    std::optional<double> time; ///< seconds; default 0
    bool staysAtRest = false;   ///< the cage is moved later, on the device

    [[nodiscard]] bool isStill() const { return cache.empty() && skin.empty() && deform.empty(); }
};

struct Loaded;

struct SurfaceArgs {
    std::string cage;
    std::string scheme; ///< "": catmark, or none for a mesh of triangles
    int isolation = 6;
    std::string weld; ///< distance; "": vertices stay as they are
    std::string height;
    std::optional<double> scale, mid;
    std::string channel;
    std::string wrap; ///< "": repeat, with a warning where that shows
    std::string mapFormat = "auto";
    PoseArgs pose;
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
    std::string heightSpace = "absolute";
    CameraArgs camera;
    std::string show = "shaded";
    std::string albedo, environment;
    std::vector<std::string> layers;
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
void addTime(CLI::App& app, PoseArgs& args);              ///< for verbs that take one pose
void addHeightSpace(CLI::App& app, std::string& word);
void addPath(CLI::App& app, std::string& word, const std::string& defaultWords);
void addTriangles(CLI::App& app, TriangleArgs& args); ///< all but the path, which not every verb can choose
void addNormal(CLI::App& app, std::string& word);
void addCamera(CLI::App& app, CameraArgs& args);
void addDevice(CLI::App& app, std::string& name);
void addPicture(CLI::App& app, PictureArgs& args);
/// What a picture shows: path, camera (see enter) and light are the same for all frames.
RenderOptions renderOptions(const PictureArgs& args, const Device& device, const std::vector<dvec3>& points);
Material materialOf(const PictureArgs& picture);
Finish finishOf(const PictureArgs& args);
/// Throws Failure::usage unless pictures are .png or .exr, and .exr where layers are asked for.
void checkPicturePath(const std::string& path, const PictureArgs& args);
/// Whether motion is asked for: then the pose of the frame before is needed too.
bool wantsMotion(const PictureArgs& args);
/// An albedo map and an environment, as they were asked for.
struct Shading {
    std::optional<Image> albedo;
    std::optional<Environment> environment;
};
Shading loadShading(const PictureArgs& args, const SurfaceArgs& surface, const Cage& cage, const Warn& warn);

NormalKind normalKind(const std::string& word);
/// "": tessellation where the device has it, else grid.
Path pathOf(const std::string& word, const Device& device);
TriangleOptions triangleOptions(const TriangleArgs& args, const Device& device);
/// Heights in the cage's own unit. Where they are much larger than the cage, that becomes one in between, so that
/// squares of both are within the range of floats.
void suitHeights(Loaded& loaded, const Warn& warn);
/// From the world's units and places to those of the object: points for cameraOf are in these too.
void enter(const Coordinates& coordinates, CameraArgs& args);
Camera cameraOf(const CameraArgs& args, std::span<const dvec3> points);

double secondsNow();

/// A cage with everything made of it, in memory.
struct Loaded {
    Cage cage;
    std::unique_ptr<Animation> animation; ///< null for cages that stand still
    std::vector<vec3> restPositions;      ///< of the cage, where --time has moved it
    std::optional<DenseMesh> dense;       ///< instead of a surface, where no scheme applies
    Surface surface;
    std::optional<HeightMap> height; ///< as the device reads it
    MapEncoding heightEncoding;      ///< how the device stores it
    SurfaceOptions options;
    double loadSeconds = 0, surfaceSeconds = 0;

    [[nodiscard]] const HeightMap* heightMap() const { return height ? &*height : nullptr; }
    /// Of what is drawn: of the cage's pose, or of all poses where it stays at rest.
    [[nodiscard]] const Coordinates& coordinates() const {
        return animation && restPositions.empty() ? animation->coordinates() : cage.coordinates;
    }
};
/// The map of --height, or nothing. Warns where it repeats unasked, and of a cage without texture coordinates.
std::optional<EncodedMap> loadHeights(const SurfaceArgs& args, const Cage& cage, const Warn& warn);
/// Warns where the cage's texture coordinates leave the unit square and --wrap does not say what the map is there.
void warnOutsideMap(const SurfaceArgs& args, const Cage& cage, const std::string& map, const Warn& warn);
/// What moves the cage, or null.
std::unique_ptr<Animation> animationOf(const PoseArgs& args, const Cage& cage, const Output& output);
/// Moves the cage to the pose of --time, its normals with it.
void takePose(Loaded& loaded, const PoseArgs& args, const std::string& path);
/// Plain polygons that move: posed by the processor.
class MovingPolygons {
public:
    /// The animation outlives it.
    MovingPolygons(Cage rest, const Animation& animation);
    /// Vertices and triangles have the same order at all times.
    [[nodiscard]] DenseMesh at(double seconds) const;

private:
    Cage rest_;
    const Animation* animation_;
};
/// The cage is in the pose of PoseArgs::time, unless it stays at rest. `albedo`: a map besides that of the heights
/// that needs texture coordinates.
Loaded load(const SurfaceArgs& args, const Output& output, const std::string& albedo = "");
/// Points for framing: a coarse reference is enough.
std::vector<dvec3> outlineOf(const Loaded& loaded);
/// Outlines of poses spread over the keys, whichever frames are rendered: a frame looks the same in every range.
std::vector<dvec3> outlineOfAll(const Loaded& loaded);
/// Fixes where the camera looks and from how far: so that it holds all points, from all sides of a turn.
void holdCamera(CameraArgs& camera, std::span<const dvec3> points, bool isTurn);
/// Heights that stretch with a posed cage are the device's to make: null where heights are absolute or the cage at
/// rest.
std::unique_ptr<Poser> stretchHeights(Device& device, SurfaceModel* model, const Loaded& loaded,
                                      const std::string& heightSpace);
HeightSpace heightSpaceOf(const std::string& word);

/// Throws when the validation layer (RELIEF_VALIDATE=1) complained.
void checkValidation(const Device& device);

} // namespace relief::app
