// One picture = an ordered list of passes over a model: rates, shadow, surface, light, read-back.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "displacement/displacement.h"
#include "gpu/gpu.h"
#include "shared/scene.h"
#include "surface/surface.h"

namespace relief {

// --- models on the device -----------------------------------------------------------------------------------------

/// What a mesh costs as floats: position, normal and texture coordinates a vertex, three 32-bit indices a triangle.
constexpr std::uint64_t denseBytes(std::uint64_t vertexCount, std::uint64_t triangleCount) {
    return 32 * vertexCount + 12 * triangleCount;
}

/// Triangles with one normal and one texture coordinate a vertex.
struct DenseMesh {
    std::vector<vec3> positions, normals;
    std::vector<vec2> texCoords;        ///< empty, or one a vertex
    std::vector<std::uint32_t> indices; ///< three a triangle

    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Polygons as fans of triangles, without subdivision. Vertices repeat only where normals or texture coordinates
/// differ; normals that the file lacks are the area-weighted sum of the faces around a vertex.
DenseMesh denseMesh(const Cage& cage);

/// The triangles that the grid path draws at `rate` segments an edge, by the reference evaluator, with full normals;
/// faces share no vertices. For surfaces of four-sided faces.
DenseMesh denseMesh(const ReferenceSurface& surface, const HeightMap* map, int rate);

struct ModelDesc {
    const Surface* surface = nullptr; ///< a subdivision surface with its posed cage points ...
    std::span<const vec3> cagePositions;
    const HeightMap* height = nullptr;
    const DenseMesh* dense = nullptr; ///< ... or a dense mesh
    const Image* albedo = nullptr;    ///< 3 or more channels, sRGB-encoded values 0..1
};

/// What the device holds of a cage (or a dense mesh): flat arrays and maps. The desc may go away afterwards.
class Model {
public:
    Model(Device& device, const ModelDesc& desc);

    /// Fills the model's part of a scene and of its bindings (kBind...; the samplers of images are not touched).
    void describe(Scene& scene, std::span<Binding> bindings) const;
    /// Segments of every edge when a cage edge has `rate`: half of it, rounded up, for the halves of edges beside
    /// n-gons.
    [[nodiscard]] std::vector<std::uint32_t> uniformRates(std::uint32_t rate) const;

    [[nodiscard]] bool isDense() const { return isDense_; }
    [[nodiscard]] const Buffer& indices() const { return indices_; } ///< of a dense mesh
    [[nodiscard]] std::uint32_t indexCount() const { return indexCount_; }
    [[nodiscard]] std::uint32_t vertexCount() const { return vertexCount_; } ///< of a dense mesh
    [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
    [[nodiscard]] std::size_t edgeCount() const { return edgeIsHalf_.size(); }
    [[nodiscard]] std::size_t cornerCount() const { return cornerCount_; }
    [[nodiscard]] int sideCount() const { return sideCount_; }
    [[nodiscard]] bool isTriangles() const { return sideCount_ == 3; }
    [[nodiscard]] bool hasTexCoords() const { return hasTexCoords_; }
    [[nodiscard]] bool hasHeight() const { return mapSize_.x > 0; }
    [[nodiscard]] bool hasAlbedoMap() const { return hasAlbedo_; }
    [[nodiscard]] Wrap wrap() const { return wrap_; }
    /// Bytes resident on the device: buffers and textures.
    [[nodiscard]] std::uint64_t byteCount() const { return byteCount_; }

private:
    void uploadSurface(Device& device, const ModelDesc& desc);
    void uploadDense(Device& device, const DenseMesh& mesh);
    void uploadMaps(Device& device, const ModelDesc& desc);

    TexelBuffer records_, words_, points_, texPoints_, mesh_;
    Buffer indices_;
    Texture heightMap_, albedoMap_;
    std::uint32_t firstFace_ = 0, firstPatch_ = 0, firstEdge_ = 0, firstCorner_ = 0, firstTouch_ = 0;
    std::uint32_t firstPatchPoint_ = 0, firstTexPatchPoint_ = 0;
    std::vector<Face> faces_;
    std::vector<bool> edgeIsHalf_;
    std::size_t cornerCount_ = 0;
    std::uint32_t indexCount_ = 0, vertexCount_ = 0;
    int sideCount_ = 4;
    glm::ivec2 mapSize_{0};
    float heightMid_ = 0, heightScale_ = 0, heightReach_ = 0;
    Wrap wrap_ = Wrap::repeat;
    bool isDense_ = false, hasTexCoords_ = false, hasAlbedo_ = false;
    std::uint64_t byteCount_ = 0;
};

// --- camera and light ---------------------------------------------------------------------------------------------

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

/// Points that outline a displaced surface: a few a face, for framing. Uses the reference evaluator.
std::vector<dvec3> outline(const ReferenceSurface& surface, const HeightMap* map);

/// A camera that holds all `points` with a small margin.
Camera frameCamera(std::span<const dvec3> points, const CameraOptions& options, double aspect);

/// Unit vector at azimuth and elevation in degrees, from the origin towards that place.
dvec3 directionAt(double azimuth, double elevation);

/// An equirectangular environment, ready to light with.
struct Environment {
    std::vector<Image> levels; ///< RGB, level l for roughness l / (levels - 1)
    vec3 irradiance[9];        ///< see shade.frag
};

/// The built-in neutral studio: a soft sky, a large soft box, a rim light, a warm floor.
Environment studioEnvironment();

/// From a picture (.hdr or .exr, width = 2 height). Throws Failure::input for other shapes and values below zero.
Environment loadEnvironment(const std::string& path);

struct Lighting {
    double keyAzimuth = -25, keyElevation = 50; ///< degrees, as the camera's
    double keyStrength = 2.9;                   ///< radiance times pi of the key light
    bool castsShadows = true;
    const Environment* environment = nullptr;
};

struct Material {
    vec3 albedo{0.52f, 0.50f, 0.47f}; ///< linear; multiplies the albedo map where there is one
    float roughness = 0.4f;
};

// --- pictures -----------------------------------------------------------------------------------------------------

enum class Path { tessellation, grid }; ///< ways to make the triangles; dense meshes have their own
enum class Show { shaded, normal, height, rate, faces, wireframe };
enum class NormalKind { limit, firstOrder, full };

struct RenderOptions {
    Path path = Path::tessellation;
    std::optional<int> rate; ///< segments a cage edge, the same for all ...
    double edgePixels = 2;   ///< ... or as many as make segments this long on screen
    NormalKind normal = NormalKind::full;
    Show show = Show::shaded;
    Camera camera;
    Lighting lighting;
    Material material;
    Bounds bounds; ///< of the object: what the shadow map covers
    /// Tessellation: vertices that one draw may make; default what suits the device.
    std::optional<std::uint32_t> tessellatedVerticesPerDraw;
};

struct FrameStats {
    std::uint64_t triangleCount = 0, faceCount = 0;
    std::uint64_t vertexCount = 0; ///< distinct samples of the surface: what a dense mesh would store
    std::uint32_t drawCount = 0, maxRate = 0;
    double rateMs = 0, shadowMs = 0, colorMs = 0, lightMs = 0; ///< on the device; 0 where it cannot time
    double wallMs = 0;                                         ///< rates to pixels on the host
};

/// Linear light, premultiplied alpha; for Show other than shaded, colors to be seen as they are.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint16_t> halves; ///< RGBA as IEEE half floats, from the top row
    bool isDisplayReferred = false;
    FrameStats stats;

    [[nodiscard]] Image image() const; ///< the same as floats, 4 channels
};

struct RendererDesc {
    int width = 1024, height = 1024;
    int shadowSide = 2048;
};

/// Faces drawn together, and the calls that draw them.
struct DrawBatch {
    std::uint32_t rate = 0;                     ///< grid: segments a side of every face in it
    std::uint32_t firstFace = 0, faceCount = 0; ///< into DrawPlan::faces
};

struct DrawPlan {
    std::vector<std::uint32_t> faces;
    std::vector<DrawBatch> batches;
    std::uint64_t triangleCount = 0, vertexCount = 0;
    std::uint32_t maxRate = 0;
};

/// Splits faces into draws of at most `verticesPerDraw` tessellated vertices, in order of faces.
DrawPlan planPatches(const Model& model, std::span<const std::uint32_t> edgeRates, std::uint32_t verticesPerDraw);
/// Groups faces by their largest side rate.
DrawPlan planGrids(const Model& model, std::span<const std::uint32_t> edgeRates);
/// Triangles that the fixed-function tessellator makes of one patch with these side rates (3 or 4 of them).
std::uint64_t tessellatedTriangles(std::span<const std::uint32_t> sideRates);

class Renderer {
public:
    Renderer(Device& device, const RendererDesc& desc);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Throws Failure::usage for a rate or path that the device cannot do.
    Picture render(const Model& model, const RenderOptions& options);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

enum class Background { studio, transparent, color };
struct Finish {
    Background background = Background::studio;
    vec3 color{1}; ///< sRGB 0..1
};

/// Writes .png (tone-mapped, sRGB, 8 bit) or .exr (linear half with alpha, no background), whole or not at all.
void writePicture(const std::string& path, const Picture& picture, const Finish& finish = {});

// --- single points ------------------------------------------------------------------------------------------------

struct SampleOptions {
    std::size_t firstRow = 0; ///< number of the first query, for messages
    NormalKind normal = NormalKind::full;
    bool isGenericBasis = false; ///< OpenSubdiv's own basis for all patches: slower, the check of the others
};

/// The device's own frames at single points. Shaders are compiled once for a kind of model.
class SurfaceSampler {
public:
    explicit SurfaceSampler(Device& device);

    /// Throws Failure::input for a face out of range, a hole, or (u,v) outside its face.
    std::vector<SampleResult> sample(const Model& model, std::span<const SampleQuery> queries,
                                     const SampleOptions& options = {});

private:
    const Pipeline& pipelineOf(const Model& model, const SampleOptions& options);

    Device& device_;
    Owned<VkSampler> sampler_;
    Buffer scene_;
    TexelBuffer none_;
    std::map<std::vector<std::uint32_t>, Pipeline> pipelines_;
};

} // namespace relief
