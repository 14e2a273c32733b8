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
    std::vector<vec3> rest; ///< per cage point, before morphs and joints
    std::uint32_t jointCount = 0, morphCount = 0;
    std::uint32_t influenceCount = 0;  ///< joints per point, 0..kMostInfluences; 0: only morphs move points
    std::vector<std::uint32_t> joints; ///< influenceCount per point, each below jointCount
    std::vector<float> weights;        ///< per entry of `joints`; those of a point add up to 1
    std::vector<vec3> morphOffsets;    ///< per cage point, target after target: morphCount * rest.size()
};

/// Either the posed points themselves, or what moves them through a Rig.
struct Pose {
    std::vector<vec3> positions; ///< per cage point; empty where a rig moves them
    std::vector<mat4> joints;    ///< jointCount affine matrices: a joint's world matrix times its inverse bind matrix
    std::vector<float> morphWeights; ///< morphCount
};

/// Computes the points of a pose: its own positions, or sum_i w_i J_i (rest + sum_k m_k offset_k) (glTF 2.0, sections
/// 3.7.2.2 and 3.7.3.3) in double precision. Tests compare the device's points with it.
std::vector<vec3> posedPositions(const Rig* rig, const Pose& pose);

// --- animations --------------------------------------------------------------------------------------------------

/// A cage's poses over time. Before the first key and after the last nothing moves. Only one thread at a time may use
/// an object, because it keeps keys that it has read.
class Animation {
public:
    explicit Animation(const Coordinates& coordinates = {}) : coordinates_(coordinates) {}
    virtual ~Animation() = default;

    /// Coordinates of the positions and joints of all poses: those of the cage, unless a skin is far away from it.
    [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }

    /// The pose at a time: the same bits for the same time, whatever was asked before. Throws Failure::input or
    /// Failure::file, naming the frame, for animations that read keys when they are needed, if one of them is bad.
    [[nodiscard]] virtual Pose pose(double seconds) const = 0;
    /// The rig that pose() gives matrices and weights for; null where it gives positions.
    [[nodiscard]] virtual const Rig* rig() const { return nullptr; }
    /// Seconds of the first and the last key; (0, 0) where there is only one.
    [[nodiscard]] virtual dvec2 keyRange() const = 0;

private:
    Coordinates coordinates_;
};

/// Makes an animation that has the cage's own positions at all times.
std::unique_ptr<Animation> stillPose(const Cage& cage);

/// Makes an animation of the given points of another one, in their order. With WeldedCage::sources it turns the
/// animation of a cage into that of the welded cage.
std::unique_ptr<Animation> gather(std::unique_ptr<Animation> base, std::vector<std::uint32_t> points);

// --- plain polygons ----------------------------------------------------------------------------------------------

/// Rotates the normals of a posed cage, which are still those of `restPositions`, with the faces around them, for
/// drawing the pose as plain polygons. A normal that only one face uses keeps its angle to that face; normals that
/// faces share stay shared. Corners are renumbered, in the same way for all poses of one cage.
void turnNormals(Cage& cage, std::span<const vec3> restPositions);

// --- point caches ------------------------------------------------------------------------------------------------

/// How positions between two keys are computed.
enum class Interpolation { linear, step };

struct CacheOptions {
    double fps = 24; ///< where a cache counts in frames (PC2, OBJ): frame k is at k / fps seconds; MDD has seconds
    Interpolation interpolation = Interpolation::linear;
    bool countsFrames = false; ///< the times in a .pc2 or .mdd are ignored: its frame k, from 0, is at k / fps seconds
};

/// Opens a point cache by the name of its file: .pc2, .mdd, or a sequence of cages, `cage.{frame:4}.obj` ({frame} or
/// {frame:DIGITS}), of which all files that exist are keys.
/// Counts are checked against the cage and the file's length before memory is taken. Keys are read when they are
/// needed; two of them are kept. Warns of a cache of only one frame. Throws Failure::file when it cannot be read,
/// Failure::input, naming the file and the frame, when it does not fit the cage or holds numbers that are not finite,
/// Failure::usage for an fps outside 0.001..1000000.
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

/// Writes a point cache by the extension of `path`, whole or not at all: .pc2 with frames startFrame, startFrame + 1,
/// ..., or .mdd with times frame / fps in seconds.
/// `positions(k)` is called for k = 0..frameCount-1 and gives pointCount world positions, which read back to the same
/// bits. One frame at a time is in memory.
/// Throws Failure::usage for other extensions and for a header that the format cannot hold, Failure::input when a pose
/// has another count or is not finite, Failure::file when writing fails.
void writePointCache(const std::string& path, const CacheHeader& header,
                     const std::function<std::vector<vec3>(std::uint32_t)>& positions);

/// Makes the file name of a frame: `pattern` with {frame} or {frame:DIGITS} replaced by the number, padded with zeros
/// to DIGITS digits (a minus sign comes before them). Throws Failure::usage for a pattern without exactly one such
/// placeholder, or with more than 9 digits.
std::string frameName(const std::string& pattern, int frame);
/// Whether `pattern` has such a placeholder (or something in braces that is meant to be one).
bool isFramePattern(const std::string& pattern);

// --- skins -------------------------------------------------------------------------------------------------------

struct SkinOptions {
    std::string clip;          ///< the animation's name or number (from 0); "": the first
    bool bindsNearest = false; ///< a cage point uses the skin of the nearest vertex; else only of one at its position
};

/// Binds a cage to the skins, morph targets and animated nodes of a glTF file (.gltf, .glb): each cage point follows
/// the vertex of the file's meshes at the same position, up to 1e-5 of the cage's diagonal. Positions of vertices are
/// those in the world when no animation moves the nodes: what an exporter writes as OBJ from the same scene. A cage
/// that does not fit these, but fits the POSITION values of the meshes at every point (in the space of the node, or in
/// the bind pose of a skin), is bound by those instead.
///
/// A point at its vertex takes the vertex's position exactly. With bindsNearest it keeps its own: the pose at rest has
/// the points of the cage, each moved by the joints, weights and morph targets of the nearest vertex.
///
/// Vertices of nodes without a skin have one joint, the node.
/// Throws Failure::file and Failure::input, naming file and element. For a cage point without a vertex at its position
/// the message names the point, its distance to the nearest vertex and --bind-nearest; for a clip that does not exist,
/// those that do.
std::unique_ptr<Animation> readSkin(const std::string& path, const Cage& cage, const SkinOptions& options,
                                    const Warn& warn = warnOnStderr);

// --- deformers ---------------------------------------------------------------------------------------------------

/// Makes an animation that applies deformers to the poses of `base`, one after another:
/// "twist(axis=y, angle=90*sin(t)) bend(angle=30)". deformerHelp() lists their names, their values and the arithmetic
/// of values over t (seconds). Lengths are relative to the bounding box of the faces of `cage` at rest. Deformers have
/// no last key: where they depend on t, keyRange() covers the first 4 seconds and the range of `base`. Throws
/// Failure::usage for an expression that cannot be read, saying what and where, and from pose() for a value that is not
/// finite or out of range at that time.
std::unique_ptr<Animation> deform(std::unique_ptr<Animation> base, const Cage& cage, const std::string& expression);

/// A value of a deformer, as it stands in an expression.
struct DeformerValue {
    std::string name, text;       ///< "angle", "90*sin(t)"; the default's text where it is not given
    bool isGiven = false;         ///< it stands in the expression
    std::optional<double> number; ///< its value, where the text is a number and nothing else
};
struct DeformerText {
    std::string name;
    std::vector<DeformerValue> values; ///< all that the deformer has
};
/// Takes an expression of deform() apart, for those who change its numbers. Throws as deform() does.
std::vector<DeformerText> parseDeformers(const std::string& expression);
/// The expression with the values that are given.
std::string toExpression(std::span<const DeformerText> deformers);

/// The text for --help: per deformer its values with their defaults, and a line on what it does.
std::string deformerHelp();

} // namespace relief
