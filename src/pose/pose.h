// A model's cage moved on the device: posed cage points, or the joints and morph weights of a rig, become all points
// that patches are made of. Nothing comes back and nothing is refined on the host.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "animation/animation.h"
#include "model/model.h"

namespace relief {

// --- stencils as the device reads them -----------------------------------------------------------------------------

/// Blocks with as many entries each, one behind another.
struct StencilClass {
    std::uint32_t entryCount = 0, firstBlock = 0, blockCount = 0;
};

/// The rows of Stencils in blocks (shared/pose.h).
struct StencilBlocks {
    std::vector<StencilClass> classes;  ///< of all blocks but those of shared rows
    std::vector<std::uint32_t> firsts;  ///< first entry of each block, one more at the end
    std::vector<std::uint32_t> targets; ///< rows, kBlockRows per block; kNoPatch past the last one
    std::vector<std::uint32_t> entries; ///< points; those that fill up an eight repeat the block's first
    std::vector<std::int32_t> weights;  ///< kBlockRows per entry
    /// The first blocks, of shared rows and in no class: the others may need what they make.
    std::uint32_t sharedBlockCount = 0;

    [[nodiscard]] std::size_t blockCount() const { return firsts.empty() ? 0 : firsts.size() - 1; }
};
StencilBlocks stencilBlocks(const Stencils& stencils);

/// Boxes that hold every face of a surface however its cage is posed, from the few cage points that move a face.
class FaceSupports {
public:
    explicit FaceSupports(const Surface& surface);

    /// `heightBounds`: the largest height of each face (SurfaceModel::faceHeightBounds). Boxes of holes are empty.
    [[nodiscard]] std::vector<Bounds> bounds(std::span<const vec3> cagePositions,
                                             std::span<const float> heightBounds) const;

private:
    std::vector<std::uint32_t> firsts_; ///< into points_, one more at the end
    std::vector<std::uint32_t> points_;
    std::vector<float> spreads_; ///< sum of the absolute weights of a face's control points at most: 1 inside a hull
};

// --- posing --------------------------------------------------------------------------------------------------------

enum class HeightSpace {
    absolute, ///< heights are cage units in every pose
    stretch,  ///< heights grow with the square root of the area that the surface has gained since rest
};

struct PoserDesc {
    const Surface* surface = nullptr; ///< of the model; may go away afterwards, as the rig
    const Rig* rig = nullptr;         ///< null: poses are positions
    HeightSpace heightSpace = HeightSpace::absolute;
    std::span<const vec3> restPositions; ///< of the cage: what stretch measures from, and height functions are given
    bool keepsBefore = false;            ///< a second pose beside the first: motion between the two
};

struct PoseStats {
    std::uint64_t uploadedBytes = 0; ///< of one pose
    double milliseconds = 0; ///< on the device, all sets of points of the latest pose; the host's clock on a CPU
};

/// Takes the model's points over, and with them the boxes around its faces. The model has to outlive it.
class Poser {
public:
    Poser(Device& device, SurfaceModel& model, const PoserDesc& desc);
    ~Poser();

    /// Throws Failure::input when the pose has other counts than the rig or the cage, or numbers that are not finite.
    /// `before`: with keepsBefore, the pose that motion is measured from.
    void pose(const Pose& now, const Pose* before = nullptr);
    [[nodiscard]] const PoseStats& stats() const;
    /// A box that holds the whole posed surface.
    [[nodiscard]] const Bounds& bounds() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// --- dense meshes --------------------------------------------------------------------------------------------------

/// Moves the vertices of a dense mesh on the device: what animation takes without a cage.
class MeshPoser {
public:
    /// `rig`: of the mesh's vertices, joints alone. The model, made of the mesh, has to outlive it.
    MeshPoser(Device& device, MeshModel& model, const DenseMesh& mesh, const Rig& rig);
    ~MeshPoser();

    /// Skins positions and normals on the device, and the gradients of texture coordinates where the model has any.
    void pose(const Pose& pose);
    /// Uploads a mesh that the host has posed, and its tangents where the model has any; returns the bytes uploaded.
    std::uint64_t upload(const DenseMesh& posed, const Tangents* tangents = nullptr);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace relief
