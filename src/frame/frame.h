// One picture = an ordered list of passes over instances: rates, shadow, surface, light, read-back.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <variant>

#include "frame/lighting.h"
#include "triangles/triangles.h"

namespace relief {

// --- camera and instances -----------------------------------------------------------------------------------------

/// Angles in degrees: azimuth 0 looks along -Z and grows to the right around Y, elevation up.
struct CameraOptions {
    double azimuth = 30, elevation = 20;
    double fieldOfView = 30;        ///< vertical
    std::optional<double> distance; ///< from the point looked at, cage units; default frames the object
    std::optional<dvec3> lookAt;    ///< default: the centre of the object
};

struct Camera {
    dvec3 eye{0}, target{0};
    double fieldOfView = 30, nearDistance = 0.1, farDistance = 10;
};

/// Makes the surface of a cage with little refinement: precise enough for outline(), and quick.
ReferenceSurface makeCoarseSurface(const Cage& cage, Scheme scheme);

/// Points that outline a displaced surface: a few per face, for framing. Uses the reference evaluator.
/// `bound`: of heights that are no map's; points on both sides at that distance outline the surface then.
std::vector<dvec3> outline(const ReferenceSurface& surface, const HeightMap* map, double bound = 0);

/// A camera that holds all `points` with a small margin.
Camera frameCamera(std::span<const dvec3> points, const CameraOptions& options, double aspect);

/// Near and far planes for an object in a box: the camera's own are for the points that it was framed by.
void fitDepth(Camera& camera, const Bounds& bounds);

/// What rates are measured from, for a picture of that many rows.
View viewOf(const Camera& camera, int height);

/// Unit vector from the origin towards an azimuth and elevation in degrees.
dvec3 directionAt(double azimuth, double elevation);

/// A surface or a mesh that stands somewhere in the world. The model has to outlive the picture's rendering.
struct Instance {
    const SurfaceModel* surface = nullptr; ///< one of the two
    const MeshModel* mesh = nullptr;
    Material material;
    mat4 toWorld{1}; ///< a rotation, a uniform scale above 0 and a translation

    Instance(const SurfaceModel& surface, Material material = {}, const mat4& toWorld = mat4(1))
        : surface(&surface), material(material), toWorld(toWorld) {}
    Instance(const MeshModel& mesh, Material material = {}, const mat4& toWorld = mat4(1))
        : mesh(&mesh), material(material), toWorld(toWorld) {}
    Instance(const Model& model, Material material = {}, const mat4& toWorld = mat4(1))
        : surface(std::get_if<SurfaceModel>(&model)), mesh(std::get_if<MeshModel>(&model)), material(material),
          toWorld(toWorld) {}
};

/// Instances that one picture can hold.
inline constexpr std::size_t kMostInstances = 256;

// --- pictures -----------------------------------------------------------------------------------------------------

/// What a pixel sees at its centre besides light.
enum class Layer {
    depth,  ///< distance along the view, cage units
    normal, ///< of the displaced surface, unit, turned to the eye
    face,   ///< of the cage; -1 where nothing is seen
    uv,     ///< texture coordinates
    height, ///< cage units
    motion, ///< pixels since the frame before, x right and y down
};

/// How color maps, normal maps and slopes of heights are looked up for a pixel.
enum class Filter {
    nearest,     ///< the texel at its centre
    bilinear,    ///< between four texels around its centre
    mipmap,      ///< between the two mip levels whose texels are about as large as it
    anisotropic, ///< several such lookups along the longest axis of what it covers
};

/// What makes samples of triangles.
enum class Raster {
    automatic, ///< what is faster for the picture on its device
    hardware,  ///< the device's fixed function
    compute,   ///< compute shaders, on devices with DeviceTraits::hasLongAtomics, for meshes
};

enum class Show { shaded, normal, height, rate, faces, wireframe, texCoords, error };

struct RenderOptions : TriangleOptions {
    Show show = Show::shaded;
    Shading shading = Shading::physical;
    PhongCoefficients phong;           ///< of Shading::phong and Shading::table
    bool tableAtVertices = false;      ///< Shading::table: n.l and v.r are those of vertices, interpolated
    WaterFloor waterFloor;             ///< of Shading::water
    const GpuMatcap* matcap = nullptr; ///< null: a ball of the first instance's material, in the picture's light
    Camera camera;
    Lighting lighting;
    Bounds bounds; ///< of all instances in the world: what the shadow map covers
    Raster raster = Raster::automatic;
    Filter filter = Filter::mipmap;
    float anisotropy = 8; ///< anisotropic: most lookups per pixel, at most DeviceTraits::maxAnisotropy
    std::vector<Layer> layers;
    double unit = 1; ///< cage units per unit of the model: layers hold depths and heights in cage units
    std::optional<Camera> rateCamera;   ///< what rates are measured from, for looking at them from elsewhere
    std::optional<Camera> cameraBefore; ///< for motion: the camera of the frame before, where it moves
    bool countsPipeline = false;        ///< of pictures that the fixed function draws
    /// Triangles per piece of a diced surface, where each piece becomes samples before the next one is diced
    /// (src/README.md, "The compute rasterizer"). Default: 2^20, or 2^22 where samples name triangles.
    std::optional<std::uint64_t> pieceTriangles;
    std::optional<std::uint32_t> meshTrianglesInFlight; ///< see DeviceTraits; default what suits the device
};

struct FrameStats {
    std::uint64_t triangleCount = 0, faceCount = 0; ///< of the whole object
    std::uint64_t hiddenFaceCount = 0;              ///< out of view or facing away: only in the shadow map
    std::uint64_t vertexCount = 0;                  ///< distinct samples of the surface: what a dense mesh would store
    std::uint32_t drawCount = 0, maxRate = 0;
    Raster raster = Raster::hardware; ///< that made the samples
    /// Times of the passes on the device, milliseconds; 0 where it cannot time. For a surface in pieces
    /// they are sums over its pieces.
    double rateMs = 0, diceMs = 0, shadowMs = 0, colorMs = 0, lightMs = 0;
    double occlusionMs = 0, otherLightsMs = 0; ///< shadows and light of Lighting::others
    double wallMs = 0;                         ///< rates to pixels on the host
    PipelineCounts pipeline; ///< of the color pass, where RenderOptions asks for it and the device can
};

/// Linear light, premultiplied alpha; for Show other than shaded, colors to be seen as they are.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint16_t> halves; ///< RGBA as IEEE half floats, from the top row
    bool isDisplayReferred = false;
    std::vector<Layer> layers;      ///< that were asked for
    std::vector<float> layerValues; ///< kLayerChannels per pixel (shared/inputs.h), from the top row; may be empty
    FrameStats stats;

    [[nodiscard]] Image image() const; ///< the pixels as 32-bit floats, 4 channels
};

struct RendererDesc {
    int width = 1024, height = 1024;
    int shadowSide = 2048;
};

class Renderer {
public:
    Renderer(Device& device, const RendererDesc& desc);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Makes pictures of another size from now on; shaders stay compiled. Throws as the constructor does.
    void resize(const RendererDesc& desc);

    /// Throws Failure::usage for a rate or path that the device cannot do, and for more than kMostInstances.
    Picture render(std::span<const Instance> instances, const RenderOptions& options);
    Picture render(const Instance& instance, const RenderOptions& options) {
        return render(std::span(&instance, 1), options);
    }

    /// Front faces less back faces along the line of sight through the centre of each pixel, from the top row: 0
    /// everywhere for a closed surface, however it folds. Before that, vertices whose position has bits of odd parity
    /// move aside by `shift` (cage units), so that two samples that differ in the last bit separate visibly.
    std::vector<int> countCrossings(const Instance& instance, const RenderOptions& options, const vec3& shift = {});
    /// Pixels that see a crack, of a closed surface: those whose crossings are not 0.
    std::uint64_t crackPixels(const Instance& instance, const RenderOptions& options, const vec3& shift);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// What is seen from a point, and what is behind it.
struct SurroundingsDesc {
    dvec3 at{0}; ///< in the world
    int side = 256;
    const EnvironmentPicture* behind = nullptr; ///< where the instances are not; null: the built-in studio
};

/// Renders a cube of all that is around a point by six pictures of 90 degrees: an environment for what is put there and
/// mirrors it. Cameras of the options are ignored, all else holds; depth goes as far as RenderOptions::bounds does.
EnvironmentPicture captureSurroundings(Device& device, std::span<const Instance> instances, RenderOptions options,
                                       const SurroundingsDesc& desc);

enum class Background { studio, transparent, color };
struct Finish {
    Background background = Background::studio;
    vec3 color{1};       ///< sRGB 0..1
    double exposure = 0; ///< light is multiplied by two to this power before the tone curve
};

/// What a .png shows: tone-mapped, sRGB 0..1, 3 channels, or 4 where the background is transparent.
Image displayed(const Picture& picture, const Finish& finish = {});

/// Writes .png (tone-mapped, sRGB, 8 bit) or .exr (linear half with alpha, no background), whole or not at all. Layers
/// become channels of the .exr: Z, N.X N.Y N.Z, face.ID, uv.U uv.V, height.H, motion.X motion.Y, all of them floats.
void writePicture(const std::string& path, const Picture& picture, const Finish& finish = {});

} // namespace relief
