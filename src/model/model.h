// What of surfaces, triangle meshes and their maps lies on the device: plain data, filled by the constructors. What is
// derived from a model (rates, tables of dicing) belongs to who derives it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "displacement/displacement.h"
#include "formula/formula.h"
#include "gpu/gpu.h"
#include "mesh/mesh.h"
#include "model/bounds.h"
#include "shared/constants.h"
#include "shared/inputs.h"
#include "surface/surface.h"

namespace relief {

// --- maps ---------------------------------------------------------------------------------------------------------

/// Heights by a function: h = scale * (value - mid) in the unit of positions, where p is in cage units.
struct FunctionHeights {
    std::shared_ptr<const HeightFunction> function;
    double scale = 1, mid = 0;
    double unit = 1; ///< cage units per unit of positions
    float bound = 0; ///< largest |h|; what is beyond it is clamped to it
    float step = 0;  ///< of slopes: distance of their points to either side, in units of positions
    bool movesSurface = true;
    bool bendsNormals = false;     ///< per fragment: all of its slopes, whatever vertices follow of its heights
    std::vector<float> faceRanges; ///< per face: how far its heights differ, for the rates of edges; or empty
};

/// A height map with its mip levels in words of the device (shared/maps.h), or a function without words.
struct GpuHeightMap {
    TexelBuffer words;
    MapRecord record{};
    MapFormat format = MapFormat::real;
    float heightBound = 0; ///< largest |h|, cage units
    Addressing addressing = Addressing::texture;
    std::uint32_t vectorSpace = kVectorNone;
    std::array<MapRecord, 2> otherRecords{}; ///< of a vector map: the second and the third component
};

/// An edge on a map per face: how long it is in segments, and the highest less the lowest height along it.
struct EdgeHeights {
    float segments = 0, range = 0;
};

/// A colour picture with its mip levels, sRGB-encoded.
struct AlbedoMap {
    Texture texture;
    Wrap wrap = Wrap::repeat;
    PictureTiles tiles;
};

/// A normal map with its mip levels.
struct GpuNormalMap {
    Texture texture; ///< unit normals as NormalMap holds them, and means of them
    NormalSpace space = NormalSpace::tangent;
    Wrap wrap = Wrap::repeat;
    PictureTiles tiles;
};

/// The slopes of a height map that bend normals per fragment.
struct GpuSlopeMap {
    Texture texture; ///< as SlopeMap::texels
    float unit = 1;  ///< SlopeMap::unit
    Wrap wrap = Wrap::repeat;
    std::uint64_t byteCount = 0; ///< of its texels, mip levels included
    PictureTiles tiles;
};

/// What fragments read of a model, as far as there is any of it.
struct ModelPictures {
    std::optional<AlbedoMap> albedo;
    std::optional<GpuSlopeMap> slopes;
    std::optional<GpuNormalMap> normalMap;

    /// Whether normals are bent or turned in directions along the surface, which vertices have to carry.
    [[nodiscard]] bool needTexGradients() const {
        return slopes || (normalMap && normalMap->space == NormalSpace::tangent);
    }
    [[nodiscard]] bool needTexCoords() const { return slopes || normalMap; }
    /// Whether one of them covers other unit squares of texture coordinates than the first one.
    [[nodiscard]] bool haveTiles() const {
        return (albedo && !albedo->tiles.isOne()) || (slopes && !slopes->tiles.isOne()) ||
               (normalMap && !normalMap->tiles.isOne());
    }
};

// --- surfaces -----------------------------------------------------------------------------------------------------

/// The points that patches are made of, one pose after another in one table: four floats per point, the last one
/// unused.
struct PointSets {
    TexelBuffer table;
    std::uint32_t now = 0, before = 0; ///< where the pose of this frame begins, and that which motion is measured from
    std::optional<std::uint32_t> rest; ///< the rest pose, where heights depend on it
    bool stretches = false;            ///< heights stretch with the surface since the rest pose
};

struct SurfaceModelDesc {
    const Surface* surface = nullptr;
    std::span<const vec3> cagePositions;       ///< one per vertex of the cage
    const HeightMap* height = nullptr;         ///< null: the limit surface itself
    const MapEncoding* encoding = nullptr;     ///< of the height map; null: 32-bit floats
    const FunctionHeights* function = nullptr; ///< instead of a height map
    const HeightMap* bump = nullptr;           ///< heights whose slopes normals show, as far as `height` does not
    const NormalMap* normalMap = nullptr;      ///< of object space only where the cage never moves
    Wrap albedoWrap = Wrap::repeat;
    PictureTiles albedoTiles;
    const Image* albedo = nullptr; ///< 3 or more channels, sRGB-encoded values 0..1
};

/// A displaced subdivision surface. What its description points to may go away afterwards.
struct SurfaceModel {
    /// Throws Failure::device where a table is larger than the device reads or its memory holds.
    SurfaceModel(Device& device, const SurfaceModelDesc& desc);

    // On the device.
    TexelBuffer recordTable, treeTable, texPointTable;
    PointSets points;
    pass::ModelTables tables{}; ///< where records begin; describe() fills in points and maps, Dicer what dicing needs
    std::optional<GpuHeightMap> height;
    std::shared_ptr<const HeightFunction> function;                  ///< null: heights are those of a map
    bool functionMovesSurface = false, functionBendsNormals = false; ///< as in FunctionHeights
    ModelPictures pictures;
    std::uint64_t byteCount = 0; ///< resident on the device: buffers and textures

    // On the host: what plans of draws are made from.
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<std::uint32_t> tree;        ///< as Surface::tree
    std::vector<std::uint32_t> cornerFlags; ///< per corner: kOn...
    std::vector<bool> edgeIsHalf;           ///< per edge: half of a cage edge beside an n-gon, or as long as one
    std::vector<bool> patchIsRegular;       ///< per patch: its points and its texture coordinates are bicubic
    HeightPyramid heightPyramid;
    std::vector<HeightPyramid> componentPyramids; ///< of a vector map; heightPyramid has its lengths
    std::vector<TexBox> faceTexBoxes;             ///< texture coordinates of faces
    std::vector<Bounds> faceBounds;       ///< boxes around faces displaced by level 0 of the map; empty ones for holes
    std::vector<float> faceHeightBounds;  ///< largest |h| on each face in level 0 of the map, cage units
    std::vector<float> faceHeightRanges;  ///< FunctionHeights::faceRanges
    std::vector<EdgeHeights> edgeHeights; ///< per edge where the map is per face, else empty
    std::vector<ivec2> mapSegments;       ///< MapTile::segments per face where the map is per face, else empty
    std::vector<FaceNormals> faceNormals; ///< what bounds of normals are made of for other levels; empty as these
    std::vector<NormalBounds> normalBounds; ///< of displaced faces; empty unless the surface is closed and oriented
    int sideCount = 4;                      ///< of all faces: 4, or 3 of Loop surfaces
    bool hasTexCoords = false;
    bool hasWideIndices = false; ///< control points have 32-bit indices (shared/records.h)
    bool hasStraightCorners = false;
    std::uint32_t patchTypes = 0; ///< bit t: there are patches of type t (shared/surface.h)

    /// Lives as long as the model: what others derive from the model and keep is dropped after that.
    std::shared_ptr<const int> identity = std::make_shared<const int>(0);

    [[nodiscard]] bool isTriangles() const { return sideCount == 3; }
    [[nodiscard]] bool stretches() const { return points.stretches; }
    /// Whether vertices are displaced, by a map or a function.
    [[nodiscard]] bool isDisplaced() const { return height && (!function || functionMovesSurface); }
    /// Whether the surface was another one in the frame that motion is measured from.
    [[nodiscard]] bool hasMotion() const {
        return points.before != points.now || (function && tables.heightTime != tables.heightTimeBefore);
    }
    [[nodiscard]] Addressing addressing() const { return height ? height->addressing : Addressing::texture; }
    [[nodiscard]] MapFormat mapFormat() const { return height ? height->format : MapFormat::real; }

    /// The time that a height function is given, in seconds, and that of the frame that motion is measured from; 0
    /// until they are set.
    void setTime(double seconds, double before) {
        tables.heightTime = float(seconds), tables.heightTimeBefore = float(before);
    }

    /// Takes another pose's points in place of its own (module pose makes them). Bounds of normals are dropped with the
    /// old pose; those of faces stay until they are set.
    void setPoints(PointSets other);

private:
    void setFunction(const FunctionHeights& heights);
};

// --- triangle meshes ----------------------------------------------------------------------------------------------

struct MeshModelDesc {
    const DenseMesh* mesh = nullptr;
    const HeightMap* bump = nullptr;           ///< as SurfaceModelDesc::bump; it and a normal map need tangents ...
    const NormalMap* normalMap = nullptr;      ///< ... unless the map is of object space
    const FunctionHeights* function = nullptr; ///< that bends normals; needs tangents where there are coordinates
    std::span<const vec3> restPositions;       ///< what a function is given, per vertex; empty: those of the mesh
    const Tangents* tangents = nullptr;        ///< of the mesh
    Wrap albedoWrap = Wrap::repeat;
    PictureTiles albedoTiles;
    const Image* albedo = nullptr; ///< as SurfaceModelDesc::albedo
};

/// A triangle mesh as it is: what displaced surfaces are compared with.
struct MeshModel {
    MeshModel(Device& device, const MeshModelDesc& desc);

    TexelBuffer vertices;     ///< two texels per vertex: position with height, normal
    TexelBuffer texCoords;    ///< per vertex, or empty
    TexelBuffer texGradients; ///< as kBindMeshTexGradients; empty where nothing reads them
    TexelBuffer indices;      ///< three 32-bit indices per triangle; an index buffer too
    ModelPictures pictures;
    pass::ModelTables tables{}; ///< what a height function needs
    std::shared_ptr<const HeightFunction> function;
    std::vector<vec3> restPositions; ///< on the host, per vertex; empty without a function
    std::uint32_t vertexCount = 0, triangleCount = 0;
    bool hasTexCoords = false;
    std::uint64_t byteCount = 0;

    /// The time that a height function is given, in seconds, and that of the frame that motion is measured from.
    void setTime(double seconds, double before) {
        tables.heightTime = float(seconds), tables.heightTimeBefore = float(before);
    }
};

/// What MeshModel::texGradients holds of a mesh in any pose: the gradients of s and of t along it, and no slopes; then,
/// where there are rest positions, those and how they move with points of the mesh (shaders/varyings.glsl).
/// `tangents`: null for gradients that are 0. `restPositions`: per vertex, or empty.
std::vector<vec4> toTexGradients(const DenseMesh& mesh, const Tangents* tangents, std::span<const vec3> restPositions);

// --- either -------------------------------------------------------------------------------------------------------

/// What a picture can be drawn of.
using Model = std::variant<SurfaceModel, MeshModel>;

/// Bytes resident on the device.
inline std::uint64_t byteCountOf(const Model& model) {
    return std::visit([](const auto& either) { return either.byteCount; }, model);
}

} // namespace relief
