#include "scene/scene.h"

namespace relief {
namespace {

std::vector<dvec3> positionsOf(const std::vector<vec3>& positions) { return {positions.begin(), positions.end()}; }

/// The largest height of a function that moves the surface; 0 where none does.
double boundOf(const LoadedObject& object) {
    const bool isDisplaced = object.detail == Detail::displacement || object.detail == Detail::both;
    return object.function && isDisplaced ? object.function->bound : 0;
}

std::vector<vec3> positionsAt(const Animation& animation, double seconds) {
    return posedPositions(animation.rig(), animation.pose(seconds));
}

} // namespace

std::vector<dvec3> computeOutline(const Cage& cage, Scheme scheme, const HeightMap* map) {
    return outline(makeCoarseSurface(cage, scheme), map);
}

std::vector<dvec3> computeOutline(const LoadedObject& object) {
    if (object.dense) return positionsOf(object.dense->positions);
    return outline(makeCoarseSurface(object.cage, object.options.scheme), object.heightMap(), boundOf(object));
}

std::vector<dvec3> computeOutlineAt(const Cage& cage, Scheme scheme, const Animation* animation, double seconds) {
    ReferenceSurface coarse = makeCoarseSurface(cage, scheme);
    if (animation != nullptr) coarse.pose(positionsAt(*animation, seconds));
    return outline(coarse, nullptr);
}

std::vector<dvec3> computeOutlineOfAll(const LoadedObject& object) {
    if (!object.animation) return computeOutline(object);
    constexpr int kPoses = 9;
    // A surface is refined once and posed again and again.
    std::optional<ReferenceSurface> coarse;
    if (!object.dense) coarse.emplace(makeCoarseSurface(object.cage, object.options.scheme));
    const dvec2 range = object.animation->keyRange();
    std::vector<dvec3> points;
    for (int i = 0; i < (range.x < range.y ? kPoses : 1); ++i) {
        const std::vector<vec3> posed =
            positionsAt(*object.animation, glm::mix(range.x, range.y, double(i) / (kPoses - 1)));
        std::vector<dvec3> more = positionsOf(posed);
        if (coarse) {
            coarse->pose(posed);
            more = outline(*coarse, object.heightMap(), boundOf(object));
        }
        points.insert(points.end(), more.begin(), more.end());
    }
    return points;
}

} // namespace relief
