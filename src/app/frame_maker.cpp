#include "app/frame_maker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/empty.h"
#include "app/frames.h"
#include "base/clock.h"

namespace relief::app {
namespace {

constexpr double kLargestFrame = 1e9;

/// The file that says how the cage moves, for messages.
const std::string& motionFile(const ObjectDesc& object) {
    const MotionDesc& motion = object.motion;
    return !motion.cachePath.empty() ? motion.cachePath : !motion.skinPath.empty() ? motion.skinPath : object.cage;
}

/// Times for what is measured of a height function: those of the keys, or else ten seconds, whichever frames are drawn.
std::vector<double> steadyTimes(const Animation* animation) {
    constexpr int kCount = 9;
    dvec2 range = animation != nullptr ? animation->keyRange() : dvec2(0);
    if (!(range.y > range.x) || !std::isfinite(range.y - range.x)) range = {0, 10};
    std::vector<double> times;
    times.reserve(kCount);
    for (int i = 0; i < kCount; ++i) times.push_back(glm::mix(range.x, range.y, double(i) / (kCount - 1)));
    return times;
}

} // namespace

double toSeconds(int frame, const MotionDesc& motion) { return frame / motion.cache.fps; }

std::vector<int> listFrames(const AnimationArgs& args, const Animation* animation) {
    if (!args.frames.empty()) return parseFrames(args.frames);
    const ObjectDesc& object = args.scene.object;
    dvec2 range(1, args.turntableCount);
    if (args.turntableCount == 0) {
        if (animation == nullptr)
            fail(Failure::usage, "{}: nothing moves; name {}--cache, --skin, --deform or --turntable", object.cage,
                 object.height.function.empty() ? "" : "the --frames of the height function, ");
        range = animation->keyRange() * object.motion.cache.fps;
        if (!(std::max(std::abs(range.x), std::abs(range.y)) <= kLargestFrame))
            fail(Failure::input, "{}: its keys are from {} to {} seconds; name the --frames{}", motionFile(object),
                 animation->keyRange().x, animation->keyRange().y,
                 object.motion.cachePath.empty() ? "" : ", or take its own with --cache-frames");
    }
    return parseFrames(fmt::format("{}:{}", int(std::ceil(range.x - 1e-6)), int(std::floor(range.y + 1e-6))));
}

FrameMaker::FrameMaker(const AnimationArgs& args, const Warn& warn) : args_(args), warn_(warn) {
    const ObjectDesc& desc = args.scene.object;
    loaded_ = load(args.scene, CageState::atRest, warn);
    LoadedObject& object = loaded_.object;
    isDense_ = object.dense.has_value();
    if (isDense_ && object.animation) {
        if (wantsMotion(args.picture))
            fail(Failure::usage, "{}: the layer of motion is not known for plain polygons; name their --scheme",
                 desc.cage);
        polygons_.emplace(object.cage, *object.animation, object.needsTangents);
    }
    frames_ = listFrames(args, object.animation.get());
    device_ = std::make_unique<Device>(DeviceDesc{.name = args.picture.device});
    measureFunction(*device_, object, desc.height, measuredTimes(), warn, steadyTimes(object.animation.get()));
    placeScene();
    if (polygons_) object.dense = polygons_->makeMesh(toSeconds(frames_.front(), desc.motion));
    makeModel();
    checkShown(args_.picture, args_.scene.object.cage, loaded_.object);
    checkFilter(args.picture, *device_, warn);
    renderer_ =
        std::make_unique<Renderer>(*device_, RendererDesc{.width = args.scene.size.x, .height = args.scene.size.y});
}

/// Times spread evenly over the frames, the first and the last one among them.
std::vector<double> FrameMaker::measuredTimes() const {
    constexpr std::size_t kMost = 9;
    const std::size_t count = std::min(frames_.size(), kMost);
    std::vector<double> times;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t frame = count > 1 ? i * (frames_.size() - 1) / (count - 1) : 0;
        times.push_back(toSeconds(frames_[frame], args_.scene.object.motion));
    }
    return times;
}

/// Fixes the camera for all frames: it must not follow the object.
void FrameMaker::placeScene() {
    const SceneDesc& scene = args_.scene;
    const std::vector<dvec3> points = computeOutlineOfAll(loaded_.object);
    bounds_ = computeBounds(points);
    camera_ = holdAllPoints(toLocal(loaded_.object.coordinates(), scene.camera), points,
                            double(scene.size.x) / scene.size.y, args_.turntableCount > 0);
}

void FrameMaker::makeModel() {
    LoadedObject& object = loaded_.object;
    model_ = std::make_unique<Model>(relief::makeModel(*device_, object));
    environment_ = makeEnvironment(*device_, loaded_);
    matcap_ = makeMatcap(*device_, loaded_);
    if (polygons_)
        meshPoser_ = std::make_unique<MeshPoser>(*device_, std::get<MeshModel>(*model_), *object.dense, Rig());
    else if (object.animation)
        poser_ = std::make_unique<Poser>(*device_, std::get<SurfaceModel>(*model_),
                                         PoserDesc{.surface = &object.surface,
                                                   .rig = object.animation->rig(),
                                                   .heightSpace = args_.scene.object.height.space,
                                                   .restPositions = object.cage.positions,
                                                   .keepsBefore = wantsMotion(args_.picture)});
    freeHostCopies(loaded_);
}

/// The box around the object in the pose that is drawn, or in all poses where the device does not move it.
Bounds FrameMaker::boundsNow() const {
    if (poser_) return poser_->bounds();
    return meshPoser_ ? polygonBounds_ : bounds_;
}

CameraOptions FrameMaker::cameraAt(int frame) const {
    CameraOptions camera = camera_;
    if (args_.turntableCount > 0) camera.azimuth += 360.0 * (frame - 1) / args_.turntableCount;
    return camera;
}

RenderOptions FrameMaker::optionsAt(int frame) const {
    RenderOptions options = toRenderOptions(args_.picture, args_.scene, loaded_.object, *device_);
    options.bounds = boundsNow();
    options.camera = placeCamera(cameraAt(frame), options.bounds);
    options.cameraBefore = placeCamera(cameraAt(frame - 1), options.bounds);
    // The light turns with the camera unless it is given.
    options.lighting =
        makeLighting(args_.scene.lighting, cameraAt(frame).azimuth, environment_ ? &*environment_ : nullptr);
    options.matcap = matcap_ ? &*matcap_ : nullptr;
    return options;
}

Pose FrameMaker::poseAt(int frame) const {
    return loaded_.object.animation->pose(toSeconds(frame, args_.scene.object.motion));
}

void FrameMaker::posePolygons(int frame, DrawnFrame& drawn) {
    const double start = secondsNow();
    const DenseMesh mesh = polygons_->makeMesh(toSeconds(frame, args_.scene.object.motion));
    std::optional<Tangents> tangents;
    if (loaded_.object.needsTangents) tangents = computeTangents(mesh);
    drawn.uploadedBytes = meshPoser_->upload(mesh, tangents ? &*tangents : nullptr);
    drawn.poseMs = 1e3 * (secondsNow() - start);
    polygonBounds_ = computeBounds(mesh.positions);
}

DrawnFrame FrameMaker::draw(int frame) {
    DrawnFrame drawn{.frame = frame};
    if (poser_) {
        std::optional<Pose> before;
        if (wantsMotion(args_.picture)) before = poseAt(frame - 1);
        poser_->pose(poseAt(frame), before ? &*before : nullptr);
        drawn.uploadedBytes = poser_->stats().uploadedBytes;
        drawn.poseMs = poser_->stats().milliseconds;
    }
    if (meshPoser_) posePolygons(frame, drawn);
    const MotionDesc& motion = args_.scene.object.motion;
    std::visit([&](auto& model) { model.setTime(toSeconds(frame, motion), toSeconds(frame - 1, motion)); }, *model_);
    const Material material = makeMaterial(args_.scene.object.material, loaded_.object.textureColor);
    RenderOptions options = optionsAt(frame);
    drawn.picture = drawPicture(*renderer_, Instance(*model_, material), options, args_.picture, *device_);
    const auto warnOnce = [this](const std::string& line) {
        if (!std::exchange(hasWarned_, true)) warn_(line);
    };
    warnOfLongSegments(options, *device_, drawn.picture.stats, warnOnce);
    return drawn;
}

std::string FrameMaker::findComplaint(const DrawnFrame& drawn) const {
    if (!isSparse(drawn.picture)) return "";
    const LoadedObject& object = loaded_.object;
    const double seconds = toSeconds(drawn.frame, args_.scene.object.motion);
    std::vector<dvec3> points(object.cage.positions.begin(), object.cage.positions.end());
    if (polygons_) {
        const DenseMesh mesh = polygons_->makeMesh(seconds);
        points.assign(mesh.positions.begin(), mesh.positions.end());
    } else if (!isDense_) {
        points = computeOutlineAt(object.cage, object.options.scheme, object.animation.get(), seconds);
    }
    const Camera camera = optionsAt(drawn.frame).camera;
    return complaintOf(drawn.picture, {points, camera, args_.scene.size, object.coordinates()});
}

} // namespace relief::app
