#include "animation/gltf_bind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/point_tree.h"

namespace relief {
namespace {

static_assert(kMostGltfInfluences == kMostInfluences);

constexpr std::uint64_t kMostOffsets = 1ull << 28;
constexpr double kTolerance = 1e-5; // of the cage's diagonal: what a number loses in a text of six digits

/// A vertex of a mesh that a node shows.
struct Source {
    std::uint32_t node = 0;
    const GltfPrimitive* primitive = nullptr;
    std::uint32_t vertex = 0;
};

std::vector<Source> sourcesOf(const GltfScene& scene) {
    std::vector<Source> sources;
    for (const std::uint32_t node : scene.meshNodes)
        for (const GltfPrimitive& primitive : scene.meshes[std::size_t(scene.nodes[node].mesh)].primitives)
            for (std::uint32_t vertex = 0; vertex < primitive.positions.size(); ++vertex)
                sources.push_back({node, &primitive, vertex});
    return sources;
}

// --- which vertex each cage point follows ------------------------------------------------------------------------

bool isFinite(const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The positions of all vertices when nothing moves, in the cage's coordinates; rounded to floats they have the same
/// bits as those of a cage that was read from this file.
std::vector<dvec3> restPositions(const GltfScene& scene, const Cage& cage, const std::vector<Source>& sources,
                                 const std::string& path) {
    const std::vector<glm::dmat4> worlds = worldMatrices(scene, restTransforms(scene));
    std::vector<glm::dmat4> joints;
    std::vector<dvec3> positions;
    positions.reserve(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const auto& [node, primitive, vertex] = sources[i];
        if (i == 0 || node != sources[i - 1].node) joints = jointMatrices(scene, node, worlds, cage.coordinates);
        const glm::dmat4 matrix = blendedMatrix(*primitive, vertex, scene.nodes[node].skin >= 0, joints);
        const dvec3 morphed = morphedPosition(*primitive, vertex, scene.nodes[node].weights);
        positions.emplace_back(matrix * glm::dvec4(morphed, 1));
        if (!isFinite(vec3(positions.back())))
            fail(Failure::input, "{}: nodes/{}: its vertex {} does not stand at finite numbers", path, node, vertex);
    }
    return positions;
}

std::vector<dvec3> asFloats(std::vector<dvec3> positions) {
    for (dvec3& position : positions) position = vec3(position);
    return positions;
}

/// The positions that vertices would have if the spaces of their meshes were the world.
std::vector<dvec3> meshPositions(const Cage& cage, const std::vector<Source>& sources) {
    std::vector<dvec3> positions;
    positions.reserve(sources.size());
    for (const Source& source : sources)
        positions.push_back(cage.coordinates.toLocal(source.primitive->positions[source.vertex]));
    return positions;
}

/// The nearest vertex of each cage point.
struct Match {
    std::vector<std::uint32_t> sources;
    std::vector<double> distances;
    bool isAtRest = true; ///< by the vertices' positions in the world at rest, not in their meshes
    Bounds bounds;        ///< of those positions at rest of the vertices that are matched, in the cage's coordinates

    [[nodiscard]] double largestDistance() const { return *std::max_element(distances.begin(), distances.end()); }
};

Match matchNearest(const Cage& cage, std::vector<dvec3> positions, bool isAtRest) {
    const PointTree tree(std::move(positions));
    Match match{.sources = {}, .distances = {}, .isAtRest = isAtRest, .bounds = {}};
    for (const vec3& position : cage.positions) {
        const dvec3 p(position);
        double nearest = std::numeric_limits<double>::infinity();
        std::uint32_t found = 0;
        const auto distance = [&](const Bounds& box) { return box.distanceTo(p); };
        tree.search(distance, nearest, [&](std::uint32_t source) {
            const double away = glm::length(tree[source] - p);
            if (away < nearest || (away == nearest && source < found)) nearest = away, found = source;
        });
        match.sources.push_back(found);
        match.distances.push_back(nearest);
    }
    return match;
}

/// The match of a cage that was read from this very file (readCage): its points are the positions of each node's
/// vertices, in their order and each once. By distance alone, nodes that meet would take each other's points.
std::optional<Match> matchOwn(const Cage& cage, const std::vector<Source>& sources,
                              const std::vector<dvec3>& positions) {
    Match match;
    std::set<std::array<double, 3>> ofNode;
    for (std::uint32_t i = 0; i < sources.size(); ++i) {
        if (i > 0 && sources[i].node != sources[i - 1].node) ofNode.clear();
        const dvec3 p = positions[i] + dvec3(0); // both zeros are one
        if (!ofNode.insert({p.x, p.y, p.z}).second) continue;
        const std::size_t point = match.sources.size();
        if (point >= cage.positions.size() || dvec3(cage.positions[point]) != p) return std::nullopt;
        match.sources.push_back(i);
    }
    if (match.sources.size() != cage.positions.size()) return std::nullopt;
    match.distances.resize(match.sources.size(), 0);
    return match;
}

void checkExact(const Match& match, const Cage& cage, double tolerance, const std::string& path) {
    const auto isOff = [&](double distance) { return !(distance <= tolerance); };
    const auto first = std::find_if(match.distances.begin(), match.distances.end(), isOff);
    if (first == match.distances.end()) return;
    const auto point = std::size_t(first - match.distances.begin());
    const dvec3 p = cage.coordinates.toWorld(cage.positions[point]);
    const int digits = cage.coordinates.isIdentity() ? 7 : 15;
    fail(Failure::input,
         "{}: {} of {} cage points have no vertex at their position; point {} at ({:.{}g}, {:.{}g}, {:.{}g}) is {:.4g} "
         "away from the nearest; --bind-nearest takes that one",
         path, std::count_if(match.distances.begin(), match.distances.end(), isOff), cage.positions.size(), point, p.x,
         digits, p.y, digits, p.z, digits, *first * cage.coordinates.unit);
}

Match matchCage(const GltfScene& scene, const Cage& cage, const std::vector<Source>& sources, bool bindsNearest,
                const std::string& path) {
    const double tolerance = kTolerance * computeBounds(cage.positions).diagonal();
    const std::vector<dvec3> positions = restPositions(scene, cage, sources, path);
    const std::vector<dvec3> rounded = asFloats(positions);
    if (std::optional<Match> own = matchOwn(cage, sources, rounded)) return *own;
    Match atRest = matchNearest(cage, rounded, true);
    if (atRest.largestDistance() <= tolerance) return atRest;
    Match inMeshes = matchNearest(cage, meshPositions(cage, sources), false);
    inMeshes.bounds = computeBounds(inMeshes.sources, [&](std::uint32_t source) { return positions[source]; });
    if (inMeshes.largestDistance() <= tolerance) return inMeshes;
    if (!bindsNearest) checkExact(atRest, cage, tolerance, path);
    return atRest;
}

// --- the rig of the matched vertices ----------------------------------------------------------------------------

/// The joints that move a point, by their numbers in the rig.
struct Influences {
    std::uint32_t count = 0;
    std::array<std::uint32_t, kMostInfluences> joints{};
    std::array<float, kMostInfluences> weights{};

    void add(std::uint32_t joint, float weight) { joints[count] = joint, weights[count] = weight, ++count; }
};

class Binder {
public:
    Binder(const GltfScene& scene, const std::vector<Source>& sources, const Match& match, const std::string& path)
        : scene_(scene), sources_(sources), match_(match), path_(path) {
        binding_.rest =
            coordinatesFor(computeBounds(match_.sources, [&](std::uint32_t source) { return positionOf(source); }));
    }

    /// Makes the rig of the vertices' joints, weights and morph offsets, with the vertices' own positions at rest.
    GltfBinding bind() {
        for (const std::uint32_t source : match_.sources) influences_.push_back(influencesOf(sources_[source]));
        packInfluences();
        for (const std::uint32_t source : match_.sources)
            binding_.rig.rest.emplace_back(binding_.rest.toLocal(positionOf(source)));
        addMorphs();
        return std::move(binding_);
    }

private:
    [[nodiscard]] dvec3 positionOf(std::uint32_t source) const {
        return sources_[source].primitive->positions[sources_[source].vertex];
    }
    Influences influencesOf(const Source& source);
    std::uint32_t jointOf(int skin, std::uint32_t index);
    void packInfluences();
    void addMorphs();

    const GltfScene& scene_;
    const std::vector<Source>& sources_;
    const Match& match_;
    const std::string& path_;
    GltfBinding binding_;
    std::vector<Influences> influences_;
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> joints_; ///< (skin, joint), or (-1, node) without skin
};

std::uint32_t Binder::jointOf(int skin, std::uint32_t index) {
    const auto [joint, isNew] = joints_.try_emplace({skin, index}, std::uint32_t(binding_.joints.size()));
    if (isNew && skin < 0) binding_.joints.push_back({.node = index});
    if (isNew && skin >= 0) {
        const GltfSkin& from = scene_.skins[std::size_t(skin)];
        binding_.joints.push_back({.node = from.joints[index], .inverseBind = from.inverseBinds[index]});
    }
    return joint->second;
}

Influences Binder::influencesOf(const Source& source) {
    const GltfPrimitive& primitive = *source.primitive;
    const int skin = scene_.nodes[source.node].skin;
    Influences influences;
    if (skin < 0) {
        influences.add(jointOf(-1, source.node), 1);
        return influences;
    }
    for (std::size_t i = 0; i < primitive.influenceCount; ++i) {
        const std::size_t at = std::size_t(source.vertex) * primitive.influenceCount + i;
        if (primitive.weights[at] != 0) influences.add(jointOf(skin, primitive.joints[at]), primitive.weights[at]);
    }
    return influences;
}

/// Gives all points as many joints; those that a point lacks have no weight.
void Binder::packInfluences() {
    Rig& rig = binding_.rig;
    rig.jointCount = std::uint32_t(binding_.joints.size());
    for (const Influences& influences : influences_)
        rig.influenceCount = std::max(rig.influenceCount, influences.count);
    for (const Influences& influences : influences_)
        for (std::uint32_t i = 0; i < rig.influenceCount; ++i) {
            rig.joints.push_back(influences.joints[i]);
            rig.weights.push_back(influences.weights[i]);
        }
}

/// Adds the morph targets of all nodes; they do not move the points of other nodes.
void Binder::addMorphs() {
    std::map<std::uint32_t, std::uint32_t> firstMorphs; // by node
    for (const std::uint32_t source : match_.sources) {
        const std::uint32_t node = sources_[source].node;
        if (!firstMorphs.try_emplace(node, std::uint32_t(binding_.morphs.size())).second) continue;
        for (std::uint32_t target = 0; target < scene_.nodes[node].weights.size(); ++target)
            binding_.morphs.push_back({.node = node, .target = target});
    }
    Rig& rig = binding_.rig;
    rig.morphCount = std::uint32_t(binding_.morphs.size());
    if (rig.morphCount * rig.rest.size() > kMostOffsets)
        fail(Failure::input, "{}: {} morph targets of {} cage points; together up to {} are possible", path_,
             rig.morphCount, rig.rest.size(), kMostOffsets);
    rig.morphOffsets.resize(rig.morphCount * rig.rest.size(), vec3(0));
    for (std::size_t point = 0; point < match_.sources.size(); ++point) {
        const auto& [node, primitive, vertex] = sources_[match_.sources[point]];
        for (std::size_t target = 0; target < scene_.nodes[node].weights.size(); ++target)
            rig.morphOffsets[(firstMorphs[node] + target) * rig.rest.size() + point] =
                dvec3(primitive->offsets[target * primitive->positions.size() + vertex]) / binding_.rest.unit;
    }
}

// --- points between vertices ------------------------------------------------------------------------------------

/// The matrices of the rig's joints when no animation moves them.
std::vector<glm::dmat4> restJoints(const GltfScene& scene, const GltfBinding& binding) {
    const std::vector<glm::dmat4> worlds = worldMatrices(scene, restTransforms(scene));
    std::vector<glm::dmat4> joints;
    for (const GltfJoint& joint : binding.joints)
        joints.emplace_back(mat4(leadingTo(binding.posed, worlds[joint.node] * joint.inverseBind)));
    return joints;
}

/// Chooses the rig's rest points such that the pose at rest has the cage's own points. Returns for how many there are
/// none, because their joints flatten space.
std::size_t keepCagePositions(const GltfScene& scene, const Cage& cage, GltfBinding& binding) {
    const std::vector<glm::dmat4> joints = restJoints(scene, binding);
    Rig& rig = binding.rig;
    std::size_t flatCount = 0;
    for (std::size_t point = 0; point < rig.rest.size(); ++point) {
        glm::dmat4 matrix(0);
        for (std::size_t i = point * rig.influenceCount; i < (point + 1) * rig.influenceCount; ++i)
            matrix += double(rig.weights[i]) * joints[rig.joints[i]];
        const glm::dmat3 linear(matrix);
        dvec3 rest = glm::inverse(linear) * (dvec3(cage.positions[point]) - dvec3(matrix[3]));
        for (std::size_t k = 0; k < binding.morphs.size(); ++k)
            rest -= scene.nodes[binding.morphs[k].node].weights[binding.morphs[k].target] *
                    dvec3(rig.morphOffsets[k * rig.rest.size() + point]);
        if (isFinite(vec3(rest)))
            rig.rest[point] = vec3(rest);
        else
            ++flatCount;
    }
    return flatCount;
}

/// Poses have the cage's coordinates where it fits the vertices at rest, else ones near the vertices in the world.
Coordinates posedCoordinates(const Match& match, const Cage& cage) {
    if (match.isAtRest) return cage.coordinates;
    Coordinates coordinates = coordinatesFor(cage.coordinates.toWorld(match.bounds));
    coordinates.unit = cage.coordinates.unit; // heights and lengths are in it already
    return coordinates;
}

/// Makes the joints take points in `coordinates`.
void startFrom(const Coordinates& coordinates, GltfBinding& binding) {
    binding.rest = coordinates;
    if (coordinates.isIdentity()) return;
    glm::dmat4 toMesh(coordinates.unit);
    toMesh[3] = glm::dvec4(coordinates.origin, 1);
    for (GltfJoint& joint : binding.joints) joint.inverseBind = joint.inverseBind * toMesh;
}

} // namespace

GltfBinding bindCage(const GltfScene& scene, const Cage& cage, bool bindsNearest, const std::string& path,
                     const Warn& warn) {
    if (cage.positions.empty()) fail(Failure::input, "{}: there is no cage point to bind", path);
    const std::vector<Source> sources = sourcesOf(scene);
    const Match match = matchCage(scene, cage, sources, bindsNearest, path);
    GltfBinding binding = Binder(scene, sources, match, path).bind();
    binding.posed = posedCoordinates(match, cage);
    const bool takesCage = bindsNearest && !match.isAtRest;
    if (takesCage) {
        binding.rig.rest = cage.positions;
        const double factor = binding.rest.unit / cage.coordinates.unit;
        for (vec3& offset : binding.rig.morphOffsets) offset = factor * dvec3(offset);
    }
    startFrom(takesCage ? cage.coordinates : binding.rest, binding);
    if (takesCage || !bindsNearest) return binding;
    const std::size_t flatCount = keepCagePositions(scene, cage, binding);
    if (flatCount > 0)
        warn(fmt::format("{}: the joints of {} cage points have no volume at rest; they take the vertices' positions",
                         path, flatCount));
    return binding;
}

} // namespace relief
