// What moves a cage, and polygons that are posed on the host.
#include "scene/loading.h"

namespace relief {

std::unique_ptr<Animation> loadAnimation(const MotionDesc& desc, const Cage& cage, const Warn& warn) {
    if (desc.isStill()) return nullptr;
    std::unique_ptr<Animation> animation;
    if (!desc.cachePath.empty())
        animation = readPointCache(desc.cachePath, cage, desc.cache, warn);
    else if (!desc.skinPath.empty())
        animation = readSkin(desc.skinPath, cage, desc.skin, warn);
    else
        animation = stillPose(cage);
    return desc.deformers.empty() ? std::move(animation) : deform(std::move(animation), cage, desc.deformers);
}

void poseCage(LoadedObject& object, const MotionDesc& desc) {
    object.restPositions = std::move(object.cage.positions);
    object.cage.positions = posedPositions(object.animation->rig(), object.animation->pose(desc.time.value_or(0)));
    turnNormals(object.cage, object.restPositions);
    object.cage.coordinates = object.animation->coordinates();
    recenter(object.cage);
}

MovingPolygons::MovingPolygons(Cage rest, const Animation& animation, bool hasTangents)
    : rest_(std::move(rest)), animation_(&animation), hasTangents_(hasTangents) {}

DenseMesh MovingPolygons::makeMesh(double seconds) const {
    Cage posed = rest_;
    posed.positions = posedPositions(animation_->rig(), animation_->pose(seconds));
    posed.coordinates = animation_->coordinates();
    turnNormals(posed, rest_.positions);
    DenseMesh mesh = denseMesh(posed);
    return hasTangents_ ? splitMirrored(std::move(mesh)) : mesh;
}

} // namespace relief
