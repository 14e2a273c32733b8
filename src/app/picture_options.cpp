#include "app/picture_options.h"

#include <algorithm>

#include "app/light_options.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/units.h"

namespace relief::app {
namespace {

constexpr const char* kAllLayers = "all";

void addLayers(CLI::App& app, std::vector<Layer>& layers) {
    std::vector<WordHelp> words = listWords(kLayers);
    words.push_back({kAllLayers, "all of these"});
    const auto set = [&layers](const std::vector<std::string>& names) {
        const auto isNamed = [&](const char* word) { return std::ranges::find(names, word) != names.end(); };
        layers.clear();
        for (const Word<Layer>& row : kLayers)
            if (isNamed(row.word) || isNamed(kAllLayers)) layers.push_back(row.value);
    };
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        "--layers", set,
        describeWords("further channels of an .exr, with commas between them: values at pixel centres", words));
    listIn("shading", "LAYERS", option->delimiter(',')->check(oneOf(words)));
}

void addColors(CLI::App& app, MaterialDesc& material) {
    const char* group = "shading";
    const vec3 color = Material().albedo;
    listIn(group, "MAP", app.add_option("--albedo", material.albedo, "color map (sRGB)"));
    listIn(
        group, "R,G,B",
        addVector<vec3>(app, "--color", material.color,
                        fmt::format("linear albedo 0..1, multiplied by the color map (default: {:.2f},{:.2f},{:.2f}, "
                                    "or 1,1,1 with a map)",
                                    color.x, color.y, color.z))
            ->check(numberIn(0, 1)));
    addReflection(app, material);
}

void addDetail(CLI::App& app, ObjectDesc& object) {
    listIn("height", "HOW", addEnum(app, "--detail", object.height.detail, kDetails, "what heights do"));
    const char* group = "shading";
    NormalMapDesc& normalMap = object.material.normalMap;
    CLI::Option* map = app.add_option("--normal-map", normalMap.path, "normal map: .png .tif .exr .jpg");
    listIn(group, "MAP", map);
    listIn(group, "SPACE",
           addEnum(app, "--normal-space", normalMap.space, kNormalSpaces, "what normals are relative to")->needs(map));
    listIn(group, "Y",
           addEnum(app, "--normal-y", normalMap.y, kNormalYs, "where green points in tangent space")->needs(map));
}

void addFilter(CLI::App& app, PictureArgs& picture) {
    const char* group = "shading";
    CLI::Option* filter =
        addEnum(app, "--filter", picture.filter, kFilters, "how color, normal and bump maps are looked up");
    listIn(group, "FILTER", filter);
    listIn(group, "N",
           app.add_option("--anisotropy", picture.anisotropy,
                          fmt::format("most lookups per pixel of the anisotropic filter, 2..16 (default: {})",
                                      picture.anisotropy))
               ->check(numberIn(2, 16))
               ->needs(filter));
}

void addBackground(CLI::App& app, Finish& finish) {
    const char* group = "shading";
    const auto setColor = [&finish](const std::vector<double>& rgb) {
        finish.background = Background::color;
        finish.color = vec3(rgb[0], rgb[1], rgb[2]);
    };
    CLI::Option* color = app.add_option_function<std::vector<double>>(
        "--background", setColor, "sRGB color 0..1 of the background of a .png or clip (default: a grey studio)");
    color->delimiter(',')->expected(3)->allow_extra_args(false)->check(numberIn(0, 1));
    listIn(group, "R,G,B", color);
    const auto setTransparent = [&finish](std::int64_t) { finish.background = Background::transparent; };
    app.add_flag_function("--transparent", setTransparent, "transparent background of a .png")
        ->excludes(color)
        ->group(group);
    listIn(group, "STOPS",
           app.add_option("--exposure", finish.exposure,
                          "what a .png or clip shows: light times two to the power of STOPS (default: 0)")
               ->check(numberIn(-30, 30)));
}

} // namespace

void addPath(CLI::App& app, std::optional<Path>& path, const std::string& defaultPath) {
    listIn("triangles", "PATH",
           addEnum(app, "--path", path, kPaths, fmt::format("how triangles are made (default: {})", defaultPath)));
}

void addTriangles(CLI::App& app, TriangleOptions& options) {
    const char* group = "triangles";
    CLI::Option* rate = app.add_option("--rate", options.rate, "segments per edge of the cage, the same everywhere");
    listIn(group, "N", rate);
    listIn(group, "P",
           app.add_option("--edge-pixels", options.edgePixels,
                          fmt::format("length of segments on screen in pixels, which chooses the segments per edge "
                                      "(default: {})",
                                      options.edgePixels))
               ->check(numberIn(1e-3, 1e6))
               ->excludes(rate));
    listIn(group, "SPACING", addEnum(app, "--spacing", options.spacing, kSpacings, "where edges are split"));
    const auto setMemory = [&options](const std::string& word) { options.memory = parseBytes(word); };
    listIn(group, "SIZE",
           app.add_option_function<std::string>(
                  "--memory", setMemory,
                  "largest size of a diced mesh in bytes, such as 512M or 2G (default: half of the device's memory)")
               ->check(sizeInBytes()));
    addNormal(app, options.normal);
}

void addNormal(CLI::App& app, NormalKind& normal) {
    listIn("normal", "KIND", addEnum(app, "--normal", normal, kNormals, "which normals"));
}

void addCamera(CLI::App& app, CameraOptions& camera, ivec2& size) {
    const char* group = "camera";
    // The picture, and from which side the object is seen.
    listIn(group, "W,H",
           addVector<ivec2>(app, "--size", size,
                            fmt::format("width and height of the picture in pixels (default: {},{})", size.x, size.y))
               ->check(CLI::Range(1, 16384)));
    listIn(group, "A",
           app.add_option("--azimuth", camera.azimuth,
                          fmt::format("degrees around the Y axis, to the right; 0 looks along -Z (default: {})",
                                      camera.azimuth))
               ->check(anyNumber()));
    listIn(group, "E",
           app.add_option("--elevation", camera.elevation,
                          fmt::format("degrees above the horizon, -90..90 (default: {})", camera.elevation))
               ->check(numberIn(-90, 90)));
    // What replaces the framing of the object.
    listIn(group, "D",
           app.add_option("--distance", camera.distance,
                          "distance in cage units from the point looked at (default: the object fills the picture)")
               ->check(numberIn(kSmallestSide, kFarthestCoordinate)));
    listIn(group, "X,Y,Z",
           addVector<dvec3>(app, "--look-at", camera.lookAt,
                            "point in cage units that the camera looks at (default: the centre of the object)")
               ->check(anyCoordinate()));
    listIn(group, "F",
           app.add_option("--fov", camera.fieldOfView,
                          fmt::format("vertical field of view in degrees, 1..150 (default: {})", camera.fieldOfView))
               ->check(numberIn(1, 150)));
}

void addDevice(CLI::App& app, std::string& name) {
    listIn("device", "NAME",
           app.add_option("--device", name,
                          "part of the name of the Vulkan device to use; relief info --devices lists them"));
}

void addPicture(CLI::App& app, SceneDesc& scene, PictureArgs& picture) {
    addPath(app, picture.triangles.path,
            "the fastest one of the device, which relief info --devices names; dice where that makes too few segments");
    addTriangles(app, picture.triangles.options);
    listIn("triangles", "RASTER",
           addEnum(app, "--raster", picture.raster, kRasters, "what makes samples of triangles"));
    addCamera(app, scene.camera, scene.size);
    addDetail(app, scene.object);
    addColors(app, scene.object.material);
    addFilter(app, picture);
    addLighting(app, scene.lighting);
    addShading(app, scene.shading);
    listIn("shading", "WHAT", addEnum(app, "--show", picture.show, kShows, "what the picture shows"));
    addLayers(app, picture.layers);
    addBackground(app, picture.finish);
    addHeightSpace(app, scene.object.height.space);
    addDevice(app, picture.device);
}

TriangleOptions toTriangleOptions(const TriangleArgs& args, const Device& device) {
    TriangleOptions options = args.options;
    options.path = args.path.value_or(choosePath(device.traits()).path);
    return options;
}

RenderOptions toRenderOptions(const PictureArgs& picture, const SceneDesc& scene, const LoadedObject& object,
                              const Device& device) {
    RenderOptions options{toTriangleOptions(picture.triangles, device)};
    options.show = picture.show;
    options.layers = picture.layers;
    options.raster = picture.raster;
    options.filter = picture.filter;
    options.anisotropy = picture.anisotropy;
    options.lighting = makeLighting(scene.lighting, scene.camera.azimuth, nullptr);
    options.shading = scene.shading.shading;
    options.phong = scene.shading.phong;
    options.tableAtVertices = scene.shading.tableAtVertices;
    if (options.shading == Shading::water) options.waterFloor = makeWaterFloor(scene.shading.waterFloor, object);
    options.unit = object.coordinates().unit;
    return options;
}

Picture drawPicture(Renderer& renderer, const Instance& instance, RenderOptions& options, const PictureArgs& args,
                    const Device& device) {
    Picture picture = renderer.render(instance, options);
    if (args.triangles.path || !isCutShort(options, device.traits(), picture.stats.maxRate)) return picture;
    options.path = Path::dice;
    return renderer.render(instance, options);
}

void warnOfLongSegments(const RenderOptions& options, const Device& device, const FrameStats& stats, const Warn& warn) {
    if (!isCutShort(options, device.traits(), stats.maxRate)) return;
    warn(fmt::format("--path tessellation makes {} segments per edge at most, so some are longer than the {} pixels of "
                     "--edge-pixels; --path dice makes up to 1024",
                     stats.maxRate, options.edgePixels));
}

void checkShown(const PictureArgs& args, const std::string& cage, const LoadedObject& object) {
    const bool hasTexCoords = object.dense ? !object.dense->texCoords.empty() : object.cage.hasTexCoords();
    if (args.show == Show::texCoords && !hasTexCoords)
        fail(Failure::input, "{}: there are no texture coordinates, which --show uv shows", cage);
    if (args.show == Show::error && object.dense)
        fail(Failure::input,
             "{}: polygons are drawn as they are; --show error compares triangles with a surface: name a "
             "--scheme",
             cage);
}

void checkFilter(const PictureArgs& args, const Device& device, const Warn& warn) {
    const DeviceTraits& traits = device.traits();
    if (args.filter != Filter::anisotropic || args.anisotropy <= traits.maxAnisotropy) return;
    if (traits.maxAnisotropy <= 1)
        fail(Failure::device, "{} has no anisotropic filter; --filter mipmap is the nearest one", traits.name);
    warn(fmt::format("{} filters with {} lookups at most, fewer than the {} of --anisotropy", traits.name,
                     traits.maxAnisotropy, args.anisotropy));
}

void checkPicturePath(const std::string& path, const PictureArgs& args) {
    if (!isPicturePath(path)) fail(Failure::usage, "{}: pictures are written as .png or .exr", path);
    if (!args.layers.empty() && !path.ends_with(".exr")) fail(Failure::usage, "{}: layers are written to .exr", path);
}

bool wantsMotion(const PictureArgs& args) { return std::ranges::find(args.layers, Layer::motion) != args.layers.end(); }

} // namespace relief::app
