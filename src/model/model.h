// A displaced surface on the device, and the triangles made of it: rates, plans of draws, single points.
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

// --- triangles ----------------------------------------------------------------------------------------------------

enum class Path { tessellation, grid }; ///< ways to make the triangles; dense meshes have their own
enum class NormalKind { limit, firstOrder, full };

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
