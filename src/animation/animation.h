// Where the points of a cage are at a time: point caches, skins and morphs, deformers. Topology never changes.
#pragma once

#include <memory>
#include <span>

#include "cage/cage.h"

namespace relief {

// --- poses -------------------------------------------------------------------------------------------------------

inline constexpr std::uint32_t kMostInfluences = 8; ///< joints that move one point

/// How morph targets and joints move the points of a cage: fixed for a whole animation, so that a pose is a few
/// matrices and weights.
struct Rig {
    std::vector<vec3> rest; ///< one a cage point, before morphs and joints
    std::uint32_t jointCount = 0, morphCount = 0;
    std::uint32_t influenceCount = 0;  ///< joints a point, 0..kMostInfluences; 0: points move by morphs alone
    std::vector<std::uint32_t> joints; ///< influenceCount a point, each below jointCount
    std::vector<float> weights;        ///< as joints; those of a point add up to 1
    std::vector<vec3> morphOffsets;    ///< one a cage point, target after target: morphCount * rest.size()
};

/// Either the posed points themselves, or what moves them through a Rig.
struct Pose {
    std::vector<vec3> positions;     ///< one a cage point; empty where a rig moves them
    std::vector<mat4> joints;        ///< jointCount affine matrices: a joint's place times its inverse bind matrix
    std::vector<float> morphWeights; ///< morphCount
};

/// Points of a pose: its own, or sum_i w_i J_i (rest + sum_k m_k offset_k) (glTF 2.0, sections 3.7.2.2 and 3.7.3.3) in
/// double precision. What the device does with the same numbers is held against it.
std::vector<vec3> posedPositions(const Rig* rig, const Pose& pose);

// --- animations --------------------------------------------------------------------------------------------------

/// A cage's poses over time. Before the first key and after the last it stands still. An object serves one thread at a
/// time, because keys that have been read are kept.
class Animation {
public:
    explicit Animation(const Coordinates& coordinates = {}) : coordinates_(coordinates) {}
    virtual ~Animation() = default;

    /// Of all poses: what positions and joints are in. Those of the cage, unless a skin stands elsewhere.
    [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }

    /// The same bits for the same time, whatever was asked before. Throws Failure::input or Failure::file, naming the
    /// frame, where keys are read when they are needed and one of them is bad.
    [[nodiscard]] virtual Pose pose(double seconds) const = 0;
    /// What pose() names matrices and weights for, or null where it gives positions.
    [[nodiscard]] virtual const Rig* rig() const { return nullptr; }
    /// Seconds of the first and the last key; (0, 0) where there is only one.
    [[nodiscard]] virtual dvec2 keyRange() const = 0;

private:
    Coordinates coordinates_;
};

/// The cage as it stands, at all times.
std::unique_ptr<Animation> stillPose(const Cage& cage);

/// The motion of `points` alone, in their order: what moves a cage moves a welded one by WeldedCage::sources.
std::unique_ptr<Animation> gather(std::unique_ptr<Animation> base, std::vector<std::uint32_t> points);

// --- plain polygons ----------------------------------------------------------------------------------------------

/// Turns the normals of a cage, which are still those of `restPositions`, with the faces around them: what a pose is
/// drawn with as plain polygons. A normal of a single face stays as it is to that face; one that faces share stays
/// shared by them. Each corner's number of its normal changes the same way for all poses of one cage.
void turnNormals(Cage& cage, std::span<const vec3> restPositions);

// --- point caches ------------------------------------------------------------------------------------------------

/// How positions between two keys are made.
enum class Interpolation { linear, step };

struct CacheOptions {
    double fps = 24; ///< where a cache counts in frames (PC2, OBJ): frame k is at k / fps seconds; MDD has seconds
    Interpolation interpolation = Interpolation::linear;
    bool countsFrames = false; ///< the times in a .pc2 or .mdd are ignored: its frame k, from 0, is at k / fps seconds
};

/// A point cache by the name of its file: .pc2, .mdd, or a sequence of cages, `cage.{frame:4}.obj` ({frame} or
/// {frame:DIGITS}), of which all files that exist are keys. Counts are checked against the cage and the file's length
/// before memory is taken; keys are read when they are needed, two are kept. Throws Failure::file when it cannot be
/// read, Failure::input, naming the file and the frame, when it does not fit the cage or holds numbers that are not
/// finite, Failure::usage for an fps outside 0.001..1000000. Warns of a cache of only one frame.
std::unique_ptr<Animation> readPointCache(const std::string& path, const Cage& cage, const CacheOptions& options,
                                          const Warn& warn = warnOnStderr);

/// Warns where the floats of a point cache are too coarse for a cage whose poses lie around `origin`; `path` is the
/// cache's.
void warnOfCoarseFloats(const std::string& path, const Cage& cage, const dvec3& origin, const Warn& warn);

struct CacheHeader {
    std::uint32_t pointCount = 0, frameCount = 0; ///< 1..2^31 - 1
    double startFrame = 0;
    double fps = 24; ///< of .mdd
};

/// Writes poses, which are in the world, as .pc2 (frames startFrame, startFrame + 1, ...) or .mdd (seconds frame /
/// fps), by the extension of `path`, whole or not at all and a frame at a time: `positions(k)` for k in
/// 0..frameCount-1, pointCount each; they read back to the same bits. Throws Failure::usage for other extensions and
/// for a header that the format cannot hold, Failure::input when a pose has another count or is not finite,
/// Failure::file when writing fails.
void writePointCache(const std::string& path, const CacheHeader& header,
                     const std::function<std::vector<vec3>(std::uint32_t)>& positions);

/// The file name of a frame: `pattern` with {frame} or {frame:DIGITS} replaced by the number, padded with zeros to so
/// many digits (a minus stands before them). Throws Failure::usage for a pattern without exactly one such place, or
/// with more than 9 digits.
std::string frameName(const std::string& pattern, int frame);
/// Whether `pattern` has such a place (or something in braces that is meant to be one).
bool isFramePattern(const std::string& pattern);

// --- skins -------------------------------------------------------------------------------------------------------

struct SkinOptions {
    std::string clip;          ///< the animation's name or number (from 0); "": the first
    bool bindsNearest = false; ///< a cage point takes the skin of the nearest original vertex; else only of one at its
                               ///< very place
};

/// The skins, the morph targets and the movement of nodes of a glTF file (.gltf, .glb), taken over by a cage: each cage
/// point follows the vertex of the file's meshes at the same place, up to 1e-5 of the cage's diagonal. The places of
/// vertices are those in the world when no animation moves the nodes: what an exporter writes as OBJ from the same
/// scene. A cage that does not fit them, but the numbers of the meshes themselves (POSITION: in the space of the node,
/// or in the bind pose of a skin) at every point, is bound by those instead.
///
/// A point at its vertex takes over the vertex's place exactly. With bindsNearest it keeps its own: the pose at rest
/// has the points of the cage, each moved by the joints, weights and morph targets of the nearest vertex.
///
/// Vertices of nodes without a skin have one joint, the node. Throws Failure::file and Failure::input, naming file and
/// element; for a cage point without a vertex at its place it names the point, its distance to the nearest and
/// --bind-nearest; for a clip that is not there, those that are.
std::unique_ptr<Animation> readSkin(const std::string& path, const Cage& cage, const SkinOptions& options,
                                    const Warn& warn = warnOnStderr);

// --- deformers ---------------------------------------------------------------------------------------------------

/// `base` moved further by deformers, one after another: "twist(axis=y, angle=90*sin(t)) bend(angle=30)". Names, their
/// values and the arithmetic of values over t (seconds) are listed by deformerHelp(). They work from the bounding box
/// of the faces of `cage` at rest. Throws Failure::usage for an expression that cannot be read, saying what and where,
/// and from pose() for a value that is not finite or makes no sense at that time. Deformers have no end: where they
/// move with time, the first 4 seconds stand for it, and keyRange() covers those and the range of `base`.
std::unique_ptr<Animation> deform(std::unique_ptr<Animation> base, const Cage& cage, const std::string& expression);

/// The vocabulary, for --help: a deformer with its values and defaults, a line of what it does, and so on.
std::string deformerHelp();

} // namespace relief
