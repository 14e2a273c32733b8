// What a command line asks for, as plain values, and the same loaded: object, camera, light.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "pose/pose.h"
#include "scene/layer_desc.h"
#include "scene/light_desc.h"
#include "scene/words.h"

namespace relief {

// --- what is asked for --------------------------------------------------------------------------------------------

/// A length: cage units, or a share of the diagonal of the cage's bounding box.
struct Distance {
    double value = 0;
    bool isShare = false;

    [[nodiscard]] double cageUnits(double diagonal) const { return isShare ? value * diagonal : value; }
};

/// A height map as HeightOptions describes it, or a height function; both empty where nothing displaces the surface.
struct HeightDesc {
    std::string path;
    std::string function;                ///< readHeightFunction
    std::optional<double> functionBound; ///< largest absolute value of the function, in place of its own kBound
    std::optional<double> mid, scale;
    std::string channel;
    std::optional<Wrap> wrap; ///< default: repeat, with a warning where texture coordinates leave 0..1
    std::optional<MapFormat> format;
    std::optional<VectorOptions> vectors; ///< `path` is a vector map of this space, order and flips
    std::vector<LayerDesc> layers;        ///< added to the map at `path`
    HeightSpace space = HeightSpace::absolute;
    Detail detail = Detail::displacement; ///< for verbs that draw pictures
};

/// What moves the cage. Paths and deformers are empty where they are not asked for.
struct MotionDesc {
    std::string cachePath; ///< point cache
    CacheOptions cache;    ///< its fps is that of an animation's frames too, whatever moves them
    std::string skinPath;  ///< glTF file; not together with a cache
    SkinOptions skin;
    std::string deformers;      ///< expression of deform(); after the cache or the skin
    std::optional<double> time; ///< seconds: the pose of a single picture or mesh; default 0

    [[nodiscard]] bool isStill() const { return cachePath.empty() && skinPath.empty() && deformers.empty(); }
};

struct ObjectDesc {
    std::string cage;                                  ///< path
    std::shared_ptr<const struct GeometryImage> image; ///< a geometry image that the path holds, where it has been read
    std::optional<Subdivision> subdivision;            ///< default: none for a mesh of triangles, else catmark
    std::optional<int> isolation;                      ///< default: neededIsolation()
    EndCapKind endCaps = EndCapKind::exact;
    std::optional<Distance> weld; ///< joins boundary vertices at most so far apart; default: vertices stay as they are
    std::optional<int> mip;       ///< of a geometry image; default 0
    std::uint32_t uvSet = 0;      ///< texture coordinates of glTF files: TEXCOORD_n
    MapPlacement placement;       ///< of all maps: it is applied to the texture coordinates of the cage
    HeightDesc height;
    MaterialDesc material;
    MotionDesc motion;
};

struct SceneDesc {
    ObjectDesc object;
    CameraOptions camera;                                    ///< in the world
    ivec2 size{RendererDesc().width, RendererDesc().height}; ///< pixels of the picture
    LightingDesc lighting;
    ShadingDesc shading;
};

/// All files that are named: outputs must not replace them. Names are empty where nothing is asked for.
std::vector<std::string> listFiles(const ObjectDesc& object);
std::vector<std::string> listFiles(const SceneDesc& scene);

// --- loaded -------------------------------------------------------------------------------------------------------

/// A cage with everything that is made of it, in host memory.
struct LoadedObject {
    Cage cage;
    std::unique_ptr<Animation> animation; ///< null for a cage that nothing moves
    std::vector<vec3> restPositions;      ///< of the cage, where load() has posed it; else empty
    std::optional<DenseMesh> dense;       ///< instead of a surface, where the polygons are drawn themselves
    std::vector<vec3> denseRest;          ///< positions of `dense` at rest, where there is a height function
    SurfaceOptions options;
    Surface surface;
    std::optional<HeightMap> height; ///< as the device reads it
    Detail detail = Detail::displacement;
    MapEncoding heightEncoding;              ///< how the device stores it
    std::optional<FunctionHeights> function; ///< instead of `height`; measureFunction() fills in its bounds
    double time = 0;                         ///< seconds, of the pose
    std::optional<Image> albedo;
    Wrap wrap = Wrap::repeat; ///< of the albedo
    PictureTiles albedoTiles;
    std::optional<vec3> textureColor; ///< linear, multiplies an albedo that the cage's own file names
    std::optional<NormalMap> normalMap;
    bool needsTangents = false; ///< normals are bent or turned along texture coordinates, by heights or a normal map
    double loadSeconds = 0, surfaceSeconds = 0; ///< what reading files and building the surface took

    /// The heights that move the surface, or null.
    [[nodiscard]] const HeightMap* heightMap() const {
        return height && (detail == Detail::displacement || detail == Detail::both) ? &*height : nullptr;
    }
    /// The function that moves the surface, or bends its normals, or both; or null.
    [[nodiscard]] const FunctionHeights* functionHeights() const {
        return function && detail != Detail::none ? &*function : nullptr;
    }
    /// The heights that bend its normals, or null.
    [[nodiscard]] const HeightMap* bumpMap() const {
        return height && (detail == Detail::bump || detail == Detail::both) ? &*height : nullptr;
    }
    /// Coordinates of what is drawn: those of the cage in its pose, or of all poses where it is loaded at rest.
    [[nodiscard]] const Coordinates& coordinates() const;
};

struct LoadedScene {
    LoadedObject object;
    std::optional<Environment> environment; ///< default: the built-in studio
    std::string environmentNote;            ///< what its picture was taken for, where no shape was asked for; or empty
    std::optional<Image> matcap;            ///< that is asked for
};

/// Whether a cage that moves is loaded in the pose of MotionDesc::time, or at rest to be posed on the device.
enum class CageState { posed, atRest };

/// Chooses the surface of a cage: none where its polygons are drawn themselves.
std::optional<SurfaceOptions> chooseSurface(const ObjectDesc& desc, const Cage& cage);

/// Reads the files of an object and builds its surface. Warns of faces that only approximate the limit surface.
/// Throws Failure::file and Failure::input as the readers of the files do, naming the file; Failure::usage where
/// heights or a time are asked for and the object has no surface or no motion, or welding leaves no face.
LoadedObject load(const ObjectDesc& desc, CageState state, const Warn& warn);

/// Loads the object and the environment of a scene. Warns of subdivision tags on polygons that are drawn themselves.
LoadedScene load(const SceneDesc& desc, CageState state, const Warn& warn);
/// The scene with the coarsest mip of a geometry image whose quads are a pixel long at most; a mip that is named stays.
SceneDesc withFittingMip(const SceneDesc& desc);

/// Frees what the device holds by now (tables, maps, textures, dense polygons), not the cage and its motion.
void freeHostCopies(LoadedScene& scene);

/// Joins boundary vertices of a cage that nothing moves. Throws Failure::usage when no face is left.
Cage weldCage(Cage cage, const std::optional<Distance>& distance);

/// Checks a cage some of whose faces lack texture coordinates. Throws Failure::input when one of `maps`, which need
/// them, is not empty, else warns.
void checkTexCoords(const Cage& cage, const std::vector<std::string>& maps, const Warn& warn);

// --- motion -------------------------------------------------------------------------------------------------------

/// What moves the cage; null where nothing is asked for. Throws as readPointCache, readSkin and deform do.
std::unique_ptr<Animation> loadAnimation(const MotionDesc& desc, const Cage& cage, const Warn& warn);

/// Polygons that are drawn themselves and move: posed on the host, because their normals are.
class MovingPolygons {
public:
    /// The animation has to outlive it. `hasTangents`: meshes are split as Tangents need it.
    MovingPolygons(Cage rest, const Animation& animation, bool hasTangents);
    /// The mesh at a time. Vertices and triangles have the same order at all times.
    [[nodiscard]] DenseMesh makeMesh(double seconds) const;

private:
    Cage rest_;
    const Animation* animation_;
    bool hasTangents_;
};

// --- on the device ------------------------------------------------------------------------------------------------

/// The surface of an object, or the polygons that are drawn themselves, on the device.
Model makeModel(Device& device, const LoadedObject& object);
/// Throws Failure::internal for polygons that are drawn themselves.
SurfaceModel makeSurfaceModel(Device& device, const LoadedObject& object);

/// Where heights depend on the rest pose of a cage that load() has posed (they stretch with it, or a function gives
/// them), they are the device's to compute: poses the model there. Does nothing elsewhere.
void keepRestPose(Device& device, SurfaceModel& model, const LoadedObject& object, HeightSpace space);

// --- height functions ---------------------------------------------------------------------------------------------

/// Evaluates the object's height function, if it has one, at points all over its surface at rest and at the times given
/// in seconds. Sets its bound (the stated one, or a quarter more than the largest height that was found, with a
/// warning) and the ranges of heights on faces. Throws Failure::input for a value that is not finite or larger than the
/// function states, Failure::device for a function whose loops do not end, each with the face and (u,v); Failure::usage
/// for heights too large for the cage.
/// `steadyTimes` are those that a measured bound and the ranges come from: times that do not depend on which frames of
/// an animation are drawn, for each of its frames is the same whatever the others are. Empty: `times`.
void measureFunction(Device& device, LoadedObject& object, const HeightDesc& desc, std::span<const double> times,
                     const Warn& warn, std::span<const double> steadyTimes = {});

// --- camera and light ---------------------------------------------------------------------------------------------

/// Points that outline the displaced surface of a cage, by a coarse reference surface. Cage coordinates.
std::vector<dvec3> computeOutline(const Cage& cage, Scheme scheme, const HeightMap* map);
/// Points that outline an object as it is loaded; with a height function after measureFunction().
std::vector<dvec3> computeOutline(const LoadedObject& object);
/// Points that outline the smooth surface of a cage, without heights, at one time of its animation; null: as it stands.
std::vector<dvec3> computeOutlineAt(const Cage& cage, Scheme scheme, const Animation* animation, double seconds);
/// Points that outline poses spread evenly over the keys of an animation, whichever of its frames are rendered.
std::vector<dvec3> computeOutlineOfAll(const LoadedObject& object);

/// A camera of the world in the coordinates of an object.
CameraOptions toLocal(const Coordinates& coordinates, const CameraOptions& world);

/// The camera of a scene; `points` outline the object, in its coordinates as the camera is then.
Camera makeCamera(const SceneDesc& scene, const Coordinates& coordinates, std::span<const dvec3> points);

/// Completes options with a point to look at and a distance from which all points are seen, for a turntable from all
/// its sides. Options and points are in the object's coordinates.
CameraOptions holdAllPoints(const CameraOptions& options, std::span<const dvec3> points, double aspect, bool isTurn);

/// The camera of options whose point to look at and distance are set, its depths fitted to the box around the object.
Camera placeCamera(const CameraOptions& options, const Bounds& bounds);

/// `azimuth`: the camera's, degrees; the default key light follows it. `environment`: null for the built-in studio.
Lighting makeLighting(const LightingDesc& desc, double azimuth, const GpuEnvironment* environment);
/// Upload the environment and the matcap of a scene; empty where it has none of its own.
std::optional<GpuEnvironment> makeEnvironment(Device& device, const LoadedScene& loaded);
std::optional<GpuMatcap> makeMatcap(Device& device, const LoadedScene& loaded);
/// The floor of a scene in the object's own coordinates: so deep under the lowest point of its cage.
WaterFloor makeWaterFloor(const WaterFloor& desc, const LoadedObject& object);
Material makeMaterial(const MaterialDesc& desc, const std::optional<vec3>& textureColor = {}); ///< LoadedObject's

// --- files --------------------------------------------------------------------------------------------------------

/// Whether `path` names a format that writePicture writes: .png or .exr.
bool isPicturePath(const std::string& path);

// --- devices ------------------------------------------------------------------------------------------------------
/// A way to make triangles, and why it suits a device.
struct PathChoice {
    Path path = Path::grid;
    std::string reason; ///< "it has tessellation shaders"
};
/// What pictures are drawn by where no path is asked for.
PathChoice choosePath(const DeviceTraits& traits);
/// Paths whose triangles a Capturer can read back.
std::vector<Path> listCapturablePaths(const DeviceTraits& traits);
/// How shaders read tables and maps: "texel buffers of up to 134217728 elements".
std::string describeTableReads(const DeviceTraits& traits);
/// One line per feature that a device lacks, with what relief cannot do there because of that.
std::vector<std::string> listLimits(const DeviceTraits& traits);

} // namespace relief
