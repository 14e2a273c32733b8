#include "view/shown_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/clock.h"

namespace relief {
namespace {

double aspectOf(const ivec2& size) { return double(size.x) / size.y; }

/// Times that a height function is measured at: as render does, or as animate does for any of its frames.
std::vector<double> listTimes(const Prepared& prepared) {
    constexpr int kCount = 9;
    const LoadedObject& object = prepared.loaded.object;
    if (prepared.frames.empty()) return {object.time};
    dvec2 range = object.animation ? object.animation->keyRange() : dvec2(0);
    if (!(range.y > range.x) || !std::isfinite(range.y - range.x)) range = {0, 10};
    std::vector<double> times;
    for (int i = 0; i < kCount; ++i) times.push_back(glm::mix(range.x, range.y, double(i) / (kCount - 1)));
    return times;
}

std::vector<dvec3> computePoints(const Prepared& prepared) {
    const LoadedObject& object = prepared.loaded.object;
    return prepared.frames.empty() ? computeOutline(object) : computeOutlineOfAll(object);
}

} // namespace

Prepared prepareScene(const ViewDesc& desc, const Look& look) {
    Prepared prepared{.look = look};
    const Warn warn = [&](const std::string& line) {
        if (std::ranges::find(prepared.warnings, line) == prepared.warnings.end()) prepared.warnings.push_back(line);
    };
    // What moves is loaded at rest, to be posed on the device; a single pose is that of the host, as render draws it.
    const MotionDesc& motion = look.scene.object.motion;
    const bool isMovingFunction = desc.hasFrames && !look.scene.object.height.function.empty();
    const bool isMoving = (!motion.isStill() || isMovingFunction) && !motion.time;
    prepared.loaded = load(look.scene, isMoving ? CageState::atRest : CageState::posed, warn);
    const LoadedObject& object = prepared.loaded.object;
    if (isMoving) prepared.frames = desc.listFrames(object.animation.get());
    std::ranges::sort(prepared.frames); // lists may count down
    if (!object.function) prepared.points = computePoints(prepared);
    return prepared;
}

Look withFilesOf(const Look& loaded, const Look& look) {
    Look own = look;
    own.scene.object = loaded.scene.object;
    own.scene.object.material.roughness = look.scene.object.material.roughness;
    own.scene.object.material.metallic = look.scene.object.material.metallic;
    own.scene.lighting.environment = loaded.scene.lighting.environment;
    own.scene.lighting.shape = loaded.scene.lighting.shape;
    own.scene.shading.matcap = loaded.scene.shading.matcap;
    return own;
}

std::vector<CageEdge> listCageEdges(const Cage& cage) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, float> edges;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t i = 0; i < size; ++i)
            edges[std::minmax(cage.corners[first + i], cage.corners[first + (i + 1) % size])];
        first += size;
    }
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i)
        edges[std::minmax(cage.creaseEdges[2 * i], cage.creaseEdges[2 * i + 1])] = cage.creaseSharpness[i];
    std::vector<CageEdge> list;
    for (const auto& [ends, sharpness] : edges) list.push_back({ends.first, ends.second, sharpness});
    return list;
}

void measure(Device& device, Prepared& prepared) {
    const Warn warn = [&](const std::string& line) { prepared.warnings.push_back(line); };
    LoadedObject& object = prepared.loaded.object;
    measureFunction(device, object, prepared.look.scene.object.height, listTimes(prepared), warn);
    prepared.points = computePoints(prepared);
}

PipelineKey keyOf(const Prepared& prepared) {
    const LoadedObject& object = prepared.loaded.object;
    return {.function = object.function ? object.function->function->number() : 0,
            .detail = object.detail,
            .cage = prepared.look.scene.object.cage};
}

ShownScene::ShownScene(Device& device, const ViewDesc& desc, Prepared prepared)
    : device_(device), desc_(desc), look_(prepared.look), key_(keyOf(prepared)) {
    const ObjectDesc& asked = look_.scene.object;
    if (prepared.points.empty()) measure(device, prepared);
    loaded_ = std::move(prepared.loaded);
    frames_ = std::move(prepared.frames);
    points_ = std::move(prepared.points);
    warnings_ = std::move(prepared.warnings);
    LoadedObject& object = loaded_.object;
    if (object.height) mid_ = object.height->mid;

    // Polygons that are drawn themselves are posed on the host, surfaces on the device.
    if (isMoving() && object.dense && object.animation) {
        polygons_.emplace(object.cage, *object.animation, object.needsTangents);
        object.dense = polygons_->makeMesh(secondsOf(frames_.front()));
    }
    model_ = std::make_unique<Model>(makeModel(device, object));
    environment_ = makeEnvironment(device, loaded_);
    matcap_ = makeMatcap(device, loaded_);
    if (auto* surface = std::get_if<SurfaceModel>(model_.get())) {
        if (isMoving() && object.animation)
            poser_ = std::make_unique<Poser>(device, *surface,
                                             PoserDesc{.surface = &object.surface,
                                                       .rig = object.animation->rig(),
                                                       .heightSpace = asked.height.space,
                                                       .restPositions = object.cage.positions});
        else if (!isMoving())
            keepRestPose(device, *surface, object, asked.height.space);
    } else if (polygons_) {
        meshPoser_ = std::make_unique<MeshPoser>(device, std::get<MeshModel>(*model_), *object.dense, Rig());
    }

    edges_ = listCageEdges(object.cage);
    cagePoints_ = object.cage.positions;
    device.submitUploads();
    freeHostCopies(loaded_);
}

std::uint64_t ShownScene::mapBytes() const {
    const auto* surface = std::get_if<SurfaceModel>(model_.get());
    std::uint64_t bytes = surface != nullptr && surface->height ? surface->height->words.buffer.bytes : 0;
    const ModelPictures& pictures =
        std::visit([](const auto& m) -> const ModelPictures& { return m.pictures; }, *model_);
    const auto add = [&](const auto& map) { bytes += map ? map->texture.memory.range().bytes : 0; };
    add(pictures.albedo), add(pictures.slopes), add(pictures.normalMap);
    return bytes;
}

double ShownScene::secondsOf(int frame) const { return frame / look_.scene.object.motion.cache.fps; }

/// The box around the object in the pose that is drawn, or in all poses where the device does not move it.
Bounds ShownScene::boundsNow() const {
    if (poser_) return poser_->bounds();
    return meshPoser_ ? polygonBounds_ : computeBounds(points_);
}

Camera ShownScene::makeCamera(const Look& look, const ivec2& size) const {
    SceneDesc scene = look.scene;
    scene.size = size;
    if (!isMoving()) return relief::makeCamera(scene, coordinates(), points_);
    // It must not follow the object.
    const CameraOptions held = holdAllPoints(toLocal(coordinates(), scene.camera), points_, aspectOf(size), false);
    return placeCamera(held, boundsNow());
}

void ShownScene::poseAt(int frame) {
    if (!isMoving() || posedFrame_ == frame) return;
    const double start = secondsNow();
    std::visit([&](auto& model) { model.setTime(secondsOf(frame), secondsOf(frame - 1)); }, *model_);
    posedFrame_ = frame;
    if (!loaded_.object.animation) return;
    const Animation& animation = *loaded_.object.animation;
    const Pose pose = animation.pose(secondsOf(frame));
    if (poser_) {
        poser_->pose(pose);
        uploadedBytes_ = poser_->stats().uploadedBytes;
    } else {
        const DenseMesh mesh = polygons_->makeMesh(secondsOf(frame));
        std::optional<Tangents> tangents;
        if (loaded_.object.needsTangents) tangents = computeTangents(mesh);
        uploadedBytes_ = meshPoser_->upload(mesh, tangents ? &*tangents : nullptr);
        polygonBounds_ = computeBounds(mesh.positions);
    }
    cagePoints_ = posedPositions(animation.rig(), pose);
    poseMs_ = 1e3 * (secondsNow() - start);
}

Picture ShownScene::draw(Renderer& renderer, const Look& look, const ivec2& size,
                         const std::optional<Camera>& rateCamera) {
    poseAt(look.frame);
    const Look own = withFilesOf(look_, look);
    RenderOptions options = desc_.makeOptions(own, loaded_.object, device_);
    options.lighting =
        makeLighting(own.scene.lighting, own.scene.camera.azimuth, environment_ ? &*environment_ : nullptr);
    options.matcap = matcap_ ? &*matcap_ : nullptr;
    options.camera = makeCamera(own, size);
    options.rateCamera = rateCamera;
    options.bounds = boundsNow();
    const Material material = makeMaterial(own.scene.object.material, loaded_.object.textureColor);
    const Instance instance(*model_, material);
    Picture picture = renderer.render(instance, options);
    // As render: where no path is asked for and that of the device makes too few segments, it is dicing.
    if (own.path || !isCutShort(options, device_.traits(), picture.stats.maxRate)) return picture;
    options.path = Path::dice;
    return renderer.render(instance, options);
}

} // namespace relief
