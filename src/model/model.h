// A displaced surface on the device, and the triangles made of it: rates, plans of draws, single points.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "displacement/displacement.h"
#include "gpu/gpu.h"
#include "shared/scene.h"
#include "surface/surface.h"

namespace relief {

// --- models on the device -----------------------------------------------------------------------------------------

struct ModelDesc {
    const Surface* surface = nullptr; ///< a subdivision surface with its posed cage points ...
    std::span<const vec3> cagePositions;
    const HeightMap* height = nullptr;
    const MapEncoding* encoding = nullptr; ///< of `height`; null: 32-bit floats
    const DenseMesh* dense = nullptr;      ///< ... or a dense mesh
    const Image* albedo = nullptr;         ///< 3 or more channels, sRGB-encoded values 0..1
};

class HeightPyramid;
struct FaceNormals;
struct NormalBounds;
struct TexBox;

/// Points that patches are made of, one pose after another in a texel buffer: where each begins.
struct PointSets {
    TexelBuffer texels;                ///< four floats a point, the last one unused
    std::uint32_t now = 0, before = 0; ///< of this frame, and of the one that motion is measured from
    std::optional<std::uint32_t> rest; ///< heights stretch with the surface since this one
};

/// What the device holds of a cage (or a dense mesh): flat arrays and maps. The desc may go away afterwards.
class Model {
public:
    Model(Device& device, const ModelDesc& desc);
    ~Model();

    /// Fills the model's part of a scene and of its bindings (kBind...; the samplers of images are not touched).
    void describe(Scene& scene, std::span<Binding> bindings) const;
    /// Takes another pose's points in place of its own (module pose makes them), and the boxes around its faces.
    void usePoints(PointSets points);
    void useFaceBounds(std::vector<Bounds> bounds);
    /// Rates of all edges when a cage edge has `rate` segments: half of it, rounded up, for the halves of edges beside
    /// n-gons.
    [[nodiscard]] std::vector<float> uniformRates(float rate) const;

    /// Lives as long as the model: what others derive from it and keep is theirs to drop after that.
    [[nodiscard]] const std::shared_ptr<const int>& identity() const { return identity_; }
    [[nodiscard]] bool isDense() const { return isDense_; }
    [[nodiscard]] const Buffer& indices() const { return indices_; }          ///< of a dense mesh
    [[nodiscard]] const Buffer& meshVertices() const { return mesh_.buffer; } ///< position with height, normal
    [[nodiscard]] std::uint32_t indexCount() const { return indexCount_; }
    [[nodiscard]] std::uint32_t vertexCount() const { return vertexCount_; } ///< of a dense mesh
    [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
    [[nodiscard]] const std::vector<std::uint32_t>& tree() const { return tree_; } ///< as Surface::tree
    /// Bounds of the normals of displaced faces; empty unless the surface is closed and oriented.
    [[nodiscard]] const std::vector<NormalBounds>& normalBounds() const { return normalBounds_; }
    /// What bounds of normals are made of for heights of other mip levels; empty as normalBounds is.
    [[nodiscard]] const std::vector<FaceNormals>& faceNormals() const { return faceNormals_; }
    /// Texture coordinates of faces.
    [[nodiscard]] const std::vector<TexBox>& faceTexBoxes() const { return faceTexBoxes_; }
    /// Boxes around faces displaced by level 0 of the height map; empty ones for holes.
    [[nodiscard]] const std::vector<Bounds>& faceBounds() const { return faceBounds_; }
    /// Largest |h| on each face in level 0 of the height map, cage units.
    [[nodiscard]] const std::vector<float>& faceHeightBounds() const { return faceHeightBounds_; }
    /// Whether heights grow with the surface since a rest pose.
    [[nodiscard]] bool stretches() const { return points_.rest.has_value(); }
    /// Whether it holds the pose that motion is measured from.
    [[nodiscard]] bool hasMotion() const { return points_.before != points_.now; }
    [[nodiscard]] const HeightPyramid& heightPyramid() const { return *heightPyramid_; }
    /// Whether the points of a leaf patch and its texture coordinates are both bicubic.
    [[nodiscard]] bool isRegular(std::uint32_t patch) const { return patchIsRegular_[patch]; }
    [[nodiscard]] std::size_t cornerCount() const { return cornerFlags_.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& cornerFlags() const { return cornerFlags_; } ///< kOn...
    [[nodiscard]] int sideCount() const { return sideCount_; }
    [[nodiscard]] bool isTriangles() const { return sideCount_ == 3; }
    [[nodiscard]] bool hasTexCoords() const { return hasTexCoords_; }
    [[nodiscard]] bool hasHeight() const { return mapSize_.x > 0; }
    [[nodiscard]] bool hasAlbedoMap() const { return hasAlbedo_; }
    [[nodiscard]] Wrap wrap() const { return wrap_; }
    [[nodiscard]] MapFormat mapFormat() const { return mapFormat_; }
    /// Whether control points are numbered with 32 bits (shared/records.h).
    [[nodiscard]] bool hasWideIndices() const { return hasWideIndices_; }
    [[nodiscard]] bool hasStraightCorners() const { return hasStraightCorners_; }
    /// Bytes of the height map on the device, with its mips.
    [[nodiscard]] std::uint64_t heightBytes() const { return hasHeight() ? heights_.buffer.bytes : 0; }
    /// Bytes resident on the device: buffers and textures.
    [[nodiscard]] std::uint64_t byteCount() const { return byteCount_; }

private:
    void uploadSurface(Device& device, const ModelDesc& desc);
    void uploadDense(Device& device, const DenseMesh& mesh);
    void uploadMaps(Device& device, const ModelDesc& desc);

    PointSets points_;
    TexelBuffer records_, words_, texPoints_, mesh_, meshTexCoords_, heights_;
    Buffer indices_;
    Texture albedoMap_;
    std::uint32_t firstFace_ = 0, firstPatch_ = 0, firstEdge_ = 0, firstCorner_ = 0, firstIncidence_ = 0;
    std::vector<Face> faces_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> tree_;
    std::shared_ptr<const int> identity_ = std::make_shared<const int>(0);
    std::unique_ptr<HeightPyramid> heightPyramid_;
    std::vector<Bounds> faceBounds_;
    std::vector<float> faceHeightBounds_;
    std::vector<NormalBounds> normalBounds_;
    std::vector<FaceNormals> faceNormals_;
    std::vector<TexBox> faceTexBoxes_;
    std::vector<std::uint32_t> mapFirsts_; ///< where the words of each level begin
    std::vector<bool> edgeIsHalf_, patchIsRegular_;
    std::vector<std::uint32_t> cornerFlags_;
    std::uint32_t indexCount_ = 0, vertexCount_ = 0;
    int sideCount_ = 4;
    glm::ivec2 mapSize_{0};
    float heightMid_ = 0, heightScale_ = 0, heightBound_ = 0;
    MapFormat mapFormat_ = MapFormat::real;
    Wrap wrap_ = Wrap::repeat;
    bool isDense_ = false, hasWideIndices_ = false, hasStraightCorners_ = false, hasTexCoords_ = false,
         hasAlbedo_ = false;
    std::uint64_t byteCount_ = 0;
};

} // namespace relief
