// What a device makes of a loaded object, and how it draws it.
#include "scene/scene.h"

namespace relief {

SurfaceModel makeSurfaceModel(Device& device, const LoadedObject& object) {
    RELIEF_CHECK(!object.dense.has_value());
    SurfaceModel model(device, {.surface = &object.surface,
                                .cagePositions = object.cage.positions,
                                .height = object.heightMap(),
                                .encoding = &object.heightEncoding,
                                .function = object.functionHeights(),
                                .bump = object.bumpMap(),
                                .normalMap = object.normalMap ? &*object.normalMap : nullptr,
                                .albedoWrap = object.wrap,
                                .albedoTiles = object.albedoTiles,
                                .albedo = object.albedo ? &*object.albedo : nullptr});
    model.setTime(object.time, object.time);
    return model;
}

Model makeModel(Device& device, const LoadedObject& object) {
    if (!object.dense) return makeSurfaceModel(device, object);
    std::optional<Tangents> tangents;
    if (object.needsTangents) tangents = computeTangents(*object.dense);
    MeshModelDesc desc{.mesh = &*object.dense,
                       .bump = object.bumpMap(),
                       .normalMap = object.normalMap ? &*object.normalMap : nullptr,
                       .function = object.functionHeights(),
                       .restPositions = object.denseRest,
                       .tangents = tangents ? &*tangents : nullptr,
                       .albedoWrap = object.wrap,
                       .albedoTiles = object.albedoTiles,
                       .albedo = object.albedo ? &*object.albedo : nullptr};
    MeshModel model(device, desc);
    model.setTime(object.time, object.time);
    return model;
}

void keepRestPose(Device& device, SurfaceModel& model, const LoadedObject& object, HeightSpace space) {
    const bool stretches = space == HeightSpace::stretch && (model.height || model.pictures.slopes);
    if (object.restPositions.empty() || !(stretches || object.function)) return;
    Poser poser(device, model,
                {.surface = &object.surface, .heightSpace = space, .restPositions = object.restPositions});
    poser.pose({.positions = object.cage.positions, .joints = {}, .morphWeights = {}});
}

bool isPicturePath(const std::string& path) { return path.ends_with(".png") || path.ends_with(".exr"); }

PathChoice choosePath(const DeviceTraits& traits) {
    if (!traits.evaluatesInVertexStages) return {Path::dice, "its vertex shaders do not read storage buffers rightly"};
    if (traits.dicesFaster) return {Path::dice, "diced meshes are measured to be faster there than tessellated faces"};
    if (traits.hasTessellation) return {Path::tessellation, "it has tessellation shaders"};
    return {Path::grid, "it has no tessellation shaders"};
}

std::vector<Path> listCapturablePaths(const DeviceTraits& traits) {
    std::vector<Path> paths;
    if (!traits.evaluatesInVertexStages) return {Path::dice};
    if (traits.hasTessellation && traits.hasTransformFeedback) paths.push_back(Path::tessellation);
    if (traits.hasVertexStores) paths.push_back(Path::grid);
    paths.push_back(Path::dice);
    return paths;
}

std::string describeTableReads(const DeviceTraits& traits) {
    if (traits.readsTablesAs == TableAccess::storageBuffers)
        return fmt::format("storage buffers of up to {}: its texel buffers hold {} elements",
                           humanBytes(traits.maxStorageBufferRange), traits.maxTexelBufferElements);
    return fmt::format("texel buffers of up to {} elements", traits.maxTexelBufferElements);
}

std::vector<std::string> listLimits(const DeviceTraits& traits) {
    std::vector<std::string> limits;
    const auto add = [&](bool isMissing, const char* text) {
        if (isMissing) limits.emplace_back(text);
    };
    add(!traits.hasTessellation, "no tessellation shaders: --path tessellation is refused");
    add(!traits.evaluatesInVertexStages,
        "storage buffers go wrong in vertex shaders: --path tessellation and --path grid are refused");
    add(!traits.hasWireframe, traits.hasLongAtomics
                                  ? "no wireframe: --show wireframe is drawn by --raster compute alone"
                                  : "no wireframe: --show wireframe is refused");
    add(traits.hasTessellation && !traits.hasTransformFeedback,
        "no transform feedback: relief check cannot certify --path tessellation");
    add(!traits.hasVertexStores, "no stores from vertex shaders: relief check cannot certify --path grid");
    add(traits.timestampNanoseconds == 0, "no timestamps: times of passes are reported as 0");
    add(!traits.countsPipeline, "no pipeline statistics: relief bench counts no shader invocations");
    return limits;
}

} // namespace relief
