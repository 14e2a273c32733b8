#include <malloc.h>

#include "base/clock.h"
#include "cage/gltf.h"
#include "scene/loading.h"

namespace relief {
namespace {

Scheme toScheme(Subdivision subdivision) {
    switch (subdivision) {
    case Subdivision::loop: return Scheme::loop;
    case Subdivision::bilinear: return Scheme::bilinear;
    default: return Scheme::catmark;
    }
}

Subdivision chooseSubdivision(const ObjectDesc& desc, const Cage& cage) {
    return desc.subdivision.value_or(cage.isAllTriangles() ? Subdivision::none : Subdivision::catmark);
}

SurfaceOptions makeSurfaceOptions(const ObjectDesc& desc, Subdivision subdivision, const Cage& cage) {
    return {.scheme = toScheme(subdivision),
            .isolation = desc.isolation.value_or(neededIsolation(cage, desc.endCaps)),
            .endCaps = desc.endCaps,
            .separation = desc.isolation.value_or(kSeparation)};
}

/// Errors of the surface name the file of its cage.
Surface buildNamedSurface(const LoadedObject& object, const std::string& path) {
    try {
        return buildSurface(object.cage, object.options);
    } catch (const Error& error) {
        fail(error.failure, "{}: {}", path, error.what());
    }
}

void warnOfApproximateFaces(const LoadedObject& object, const std::string& path, const Warn& warn) {
    const auto faces = listApproximateFaces(object.cage, object.options, &object.surface);
    if (faces.empty()) return;
    warn(fmt::format(
        "{}: {} of {} faces only approximate the limit surface, the first is face {}: their vertices are not "
        "apart or semi-sharp after {} levels (--isolation), or their texture coordinates end at linear boundaries",
        path, faces.size(), object.cage.faceCount(), faces[0], object.options.isolation));
}

/// What cannot work together, whatever the files hold.
void checkUse(const ObjectDesc& desc, bool isDense) {
    const Detail detail = desc.height.detail;
    const bool hasHeights = !desc.height.path.empty() || !desc.height.function.empty();
    if (isDense && hasHeights && (detail == Detail::displacement || detail == Detail::both))
        fail(Failure::usage,
             "{}: heights displace a subdivision surface, and this is drawn as plain polygons; name --scheme "
             "catmark, loop or bilinear, or --detail bump",
             desc.cage);
}

/// Vectors of an object do not turn with what moves its cage, and no normal is bent by vectors.
void checkVectors(const ObjectDesc& desc, const std::string& path, const std::optional<VectorOptions>& vectors) {
    if (!vectors) return;
    const Detail detail = desc.height.detail;
    if (detail == Detail::bump || detail == Detail::both)
        fail(Failure::usage, "{}: vectors move the surface; --detail {} is for heights", path,
             wordOf(kDetails, detail));
    if (vectors->space == VectorSpace::object && !desc.motion.isStill())
        fail(Failure::usage,
             "{}: vectors of object space do not follow a cage that changes its shape; bake them as --vector-space "
             "tangent",
             path);
}

void checkAllVectors(const ObjectDesc& desc) {
    checkVectors(desc, desc.height.path, desc.height.vectors);
    for (const LayerDesc& layer : desc.height.layers) checkVectors(desc, layer.path, layer.vectors);
}

Cage readObjectCage(const ObjectDesc& desc, const Warn& warn) {
    if (lowerExtension(desc.cage) == ".exr") {
        if (desc.uvSet != 0)
            fail(Failure::usage,
                 "{}: --uv-set {} is of glTF files; a geometry image has one set of texture coordinates", desc.cage,
                 desc.uvSet);
        return readGeometryImageCage(desc);
    }
    if (desc.mip) fail(Failure::usage, "{}: --mip is of geometry images (.exr)", desc.cage);
    if (desc.uvSet == 0) return readCage(desc.cage, warn);
    const std::string extension = lowerExtension(desc.cage);
    if (extension != ".gltf" && extension != ".glb")
        fail(Failure::usage, "{}: --uv-set {} is of glTF files; an .obj has one set of texture coordinates", desc.cage,
             desc.uvSet);
    return readGltfCage(desc.cage, warn, desc.uvSet);
}

/// Normals are bent and turned along texture coordinates. (u,v) of faces, which stand for them where heights displace,
/// jump from face to face.
void checkBentNormals(const ObjectDesc& desc, const Cage& cage) {
    const Detail detail = desc.height.detail;
    const bool isBumped = !desc.height.path.empty() && (detail == Detail::bump || detail == Detail::both);
    const std::string& map = isBumped ? desc.height.path : desc.material.normalMap.path;
    if (!map.empty() && !cage.hasTexCoords())
        fail(Failure::input, "{}: there are no texture coordinates, which {} needs", desc.cage, map);
}

/// Bump and both are what heights do: without any, the picture is that of none.
void warnOfNoHeights(const ObjectDesc& desc, const Warn& warn) {
    const Detail detail = desc.height.detail;
    if (desc.height.path.empty() && desc.height.function.empty() && (detail == Detail::bump || detail == Detail::both))
        warn(fmt::format("--detail {} shows nothing without heights; name a --height map or a --height-function",
                         wordOf(kDetails, detail)));
}

void poseAsAsked(LoadedObject& object, const ObjectDesc& desc, CageState state) {
    if (desc.motion.time && !object.animation && !object.function)
        fail(Failure::usage,
             "{}: --time asks for a pose; say what moves the cage: --cache, --skin, --deform or a "
             "--height-function",
             desc.cage);
    object.time = desc.motion.time.value_or(0);
    if (object.animation && state == CageState::posed) poseCage(object, desc.motion);
}

/// The polygons of a mesh at rest.
DenseMesh makeRestMesh(const LoadedObject& object) {
    if (object.restPositions.empty()) return *object.dense;
    Cage rest = object.cage;
    rest.positions = object.restPositions;
    return denseMesh(rest);
}

void splitForTangents(LoadedObject& object) {
    const bool isTurned = object.normalMap && object.normalMap->space == NormalSpace::tangent;
    const bool isBent = object.dense && object.functionHeights() != nullptr;
    object.needsTangents = isTurned || object.bumpMap() != nullptr || (isBent && !object.dense->texCoords.empty());
    std::optional<DenseMesh> rest;
    if (object.dense && object.function)
        rest = makeRestMesh(object); // where it is measured, whether it is shown or not
    if (object.dense && object.needsTangents) {
        object.dense = splitMirrored(std::move(*object.dense));
        if (rest) rest = splitMirrored(std::move(*rest));
    }
    if (rest) object.denseRest = std::move(rest->positions);
}

} // namespace

std::vector<std::string> listFiles(const ObjectDesc& object) {
    std::vector<std::string> files{object.cage, object.height.function, object.motion.cachePath,
                                   object.motion.skinPath};
    std::vector<std::string> maps{object.height.path, object.material.albedo, object.material.normalMap.path};
    for (const LayerDesc& layer : object.height.layers) maps.push_back(layer.path), maps.push_back(layer.mask);
    for (const std::string& map : maps) {
        files.push_back(map);
        if (!findTilePattern(map)) continue;
        for (const TileFile& tile : listTiles(map)) files.push_back(tile.path);
    }
    return files;
}

std::vector<std::string> listFiles(const SceneDesc& scene) {
    std::vector<std::string> files = listFiles(scene.object);
    for (const std::string& file : listEnvironmentFiles(scene.lighting.environment)) files.push_back(file);
    files.push_back(scene.shading.matcap);
    return files;
}

std::optional<SurfaceOptions> chooseSurface(const ObjectDesc& desc, const Cage& cage) {
    const Subdivision subdivision = chooseSubdivision(desc, cage);
    if (subdivision == Subdivision::none) return {};
    return makeSurfaceOptions(desc, subdivision, cage);
}

const Coordinates& LoadedObject::coordinates() const {
    return animation && restPositions.empty() ? animation->coordinates() : cage.coordinates;
}

namespace {

/// load() of an object; `looks` gets the materials of its file, where they are wanted.
LoadedObject loadObject(const ObjectDesc& desc, CageState state, GltfLooks* looks, const Warn& warn) {
    if (desc.height.path.empty() && !desc.height.layers.empty())
        fail(Failure::usage, "--layer {}: layers are added to a map; name the first one with --height or --vector",
             desc.height.layers.front().path);
    checkAllVectors(desc);
    LoadedObject object;
    const double start = secondsNow();
    object.cage = readObjectCage(desc, warn);
    checkTexCoords(object.cage, {desc.height.path, desc.material.albedo, desc.material.normalMap.path}, warn);
    checkBentNormals(desc, object.cage);
    placeTexCoords(object.cage, desc);
    if (looks != nullptr) *looks = readLooks(object.cage, desc, warn);
    const Subdivision subdivision = chooseSubdivision(desc, object.cage);
    const bool isDense = subdivision == Subdivision::none;
    object.wrap = desc.height.wrap.value_or(object.wrap);
    checkUse(desc, isDense);

    // Heights may change the unit of the cage, which what moves it has to be read in.
    if (!desc.height.path.empty()) {
        EncodedMap map = loadHeights(desc, object.cage, warn);
        object.height = std::move(map.decoded);
        object.heightEncoding = std::move(map.encoding);
        object.detail = desc.height.detail;
        fitUnitToHeights(object, warn);
    }
    if (!desc.height.function.empty())
        object.function = loadFunction(desc, object.cage), object.detail = desc.height.detail;
    object.animation = loadAnimation(desc.motion, object.cage, warn);

    // Point caches and skins fit the cage as it is in its file, so that it is welded after them.
    if (desc.weld) weldObject(object, *desc.weld);
    if (!isDense && !desc.weld) warnOfCoincidentVertices(object.cage, desc.cage, warn);
    poseAsAsked(object, desc, state);
    const double loadEnd = secondsNow();

    // What is drawn: the polygons or a surface of them.
    if (isDense) {
        object.dense = denseMesh(object.cage);
    } else {
        object.options = makeSurfaceOptions(desc, subdivision, object.cage);
        object.surface = buildNamedSurface(object, desc.cage);
        warnOfApproximateFaces(object, desc.cage, warn);
        if (object.height) fitHeights(object, desc, warn);
    }
    object.loadSeconds = loadEnd - start;
    object.surfaceSeconds = secondsNow() - loadEnd;
    return object;
}

void loadLight(LoadedScene& scene, const SceneDesc& desc) {
    if (!desc.shading.matcap.empty()) scene.matcap = loadMatcap(desc.shading.matcap);
    const std::string& path = desc.lighting.environment;
    if (path.empty()) return;
    const EnvironmentFile file = readEnvironment(path, desc.lighting.shape);
    scene.environment =
        makeEnvironment(file.picture, desc.object.material.conservesEnergy() || desc.shading.shading == Shading::water);
    if (file.isChosen) scene.environmentNote = fmt::format("{}: {}", path, describe(file.picture, file.layout));
}

} // namespace

LoadedObject load(const ObjectDesc& desc, CageState state, const Warn& warn) {
    return loadObject(desc, state, nullptr, warn);
}

LoadedScene load(const SceneDesc& desc, CageState state, const Warn& warn) {
    const ObjectDesc& object = desc.object;
    GltfLooks looks;
    LoadedScene scene{.object = loadObject(object, state, &looks, warn)};
    warnOfUnusedTags(scene.object, object, warn);
    if (!object.material.albedo.empty()) {
        loadAlbedo(scene.object, object.material.albedo, warn);
        // A height map has been named in such a warning already.
        if (object.height.path.empty()) warnOutsideMap(object, scene.object.cage, object.material.albedo, warn);
    }
    const std::string& normals = object.material.normalMap.path;
    if (!normals.empty()) {
        scene.object.normalMap = loadNormals(object, scene.object, warn);
        if (object.height.path.empty() && object.material.albedo.empty())
            warnOutsideMap(object, scene.object.cage, normals, warn);
    }
    takeGltfTextures(scene.object, object, looks, warn);
    warnOfFlatTexCoords(scene.object, object.cage, warn);
    warnOfNoHeights(object, warn);
    splitForTangents(scene.object);
    loadLight(scene, desc);
    return scene;
}

void freeHostCopies(LoadedScene& scene) {
    LoadedObject& object = scene.object;
    object.surface = {};
    object.height.reset();
    object.heightEncoding = {};
    object.dense.reset();
    object.albedo.reset();
    object.normalMap.reset();
    scene.environment.reset();
    scene.matcap.reset();
    malloc_trim(0); // the C library would keep what is small
}

} // namespace relief
