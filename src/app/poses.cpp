// What moves a cage, as the command line asks for it, and the camera that holds it at all times.
#include <algorithm>

#include "app/options.h"

namespace relief::app {

std::unique_ptr<Animation> animationOf(const PoseArgs& args, const Cage& cage, const Output& output) {
    if (args.isStill()) return nullptr;
    std::unique_ptr<Animation> animation;
    if (!args.cache.empty()) {
        const auto interpolation = args.interpolation == "step" ? Interpolation::step : Interpolation::linear;
        const CacheOptions options{
            .fps = args.fps, .interpolation = interpolation, .countsFrames = args.countsCacheFrames};
        animation = readPointCache(args.cache, cage, options, output.warn());
    } else if (!args.skin.empty()) {
        animation = readSkin(args.skin, cage, {.clip = args.clip, .bindsNearest = args.bindsNearest}, output.warn());
    } else {
        animation = stillPose(cage);
    }
    return args.deform.empty() ? std::move(animation) : deform(std::move(animation), cage, args.deform);
}

void takePose(Loaded& loaded, const PoseArgs& args, const std::string& path) {
    if (args.time && !loaded.animation)
        fail(Failure::usage, "{}: --time asks for a pose; say what moves the cage: --cache, --skin or --deform", path);
    if (!loaded.animation || args.staysAtRest) return;
    loaded.restPositions = std::move(loaded.cage.positions);
    loaded.cage.positions = posedPositions(loaded.animation->rig(), loaded.animation->pose(args.time.value_or(0)));
    turnNormals(loaded.cage, loaded.restPositions);
    loaded.cage.coordinates = loaded.animation->coordinates();
    recenter(loaded.cage);
}

MovingPolygons::MovingPolygons(Cage rest, const Animation& animation)
    : rest_(std::move(rest)), animation_(&animation) {}

DenseMesh MovingPolygons::at(double seconds) const {
    Cage posed = rest_;
    posed.positions = posedPositions(animation_->rig(), animation_->pose(seconds));
    posed.coordinates = animation_->coordinates();
    turnNormals(posed, rest_.positions);
    return denseMesh(posed);
}

std::vector<dvec3> outlineOfAll(const Loaded& loaded) {
    if (!loaded.animation) return outlineOf(loaded);
    constexpr int kPoses = 9;
    std::optional<ReferenceSurface> coarse;
    if (!loaded.dense) coarse.emplace(loaded.cage, SurfaceOptions{.scheme = loaded.options.scheme, .isolation = 2});
    const dvec2 range = loaded.animation->keyRange();
    std::vector<dvec3> points;
    for (int i = 0; i < (range.x < range.y ? kPoses : 1); ++i) {
        const Pose pose = loaded.animation->pose(glm::mix(range.x, range.y, double(i) / (kPoses - 1)));
        const std::vector<vec3> posed = posedPositions(loaded.animation->rig(), pose);
        std::vector<dvec3> more(posed.begin(), posed.end());
        if (coarse) {
            coarse->pose(posed);
            more = outline(*coarse, loaded.heightMap());
        }
        points.insert(points.end(), more.begin(), more.end());
    }
    return points;
}

void holdCamera(CameraArgs& camera, std::span<const dvec3> points, bool isTurn) {
    constexpr int kSides = 24;
    if (isTurn && camera.lookAt.empty()) {
        Bounds bounds;
        for (const dvec3& p : points) bounds.add(p);
        camera.lookAt = {bounds.center().x, bounds.center().y, bounds.center().z};
    }
    CameraArgs side = camera;
    double farthest = 0;
    Camera held;
    for (int i = 0; i < (isTurn ? kSides : 1); ++i) {
        side.options.azimuth = camera.options.azimuth + 360.0 * i / kSides;
        held = cameraOf(side, points);
        farthest = std::max(farthest, glm::length(held.eye - held.target));
    }
    camera.lookAt = {held.target.x, held.target.y, held.target.z};
    camera.distance = farthest;
}

} // namespace relief::app
