// What moves a cage, as the command line asks for it.
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

} // namespace relief::app
