// What the words about a picture turn into: shared by the verbs that draw.
#include <algorithm>
#include <cmath>

#include "app/options.h"

namespace relief::app {
namespace {

Show showOf(const std::string& word) {
    static const std::map<std::string, Show> words{{"shaded", Show::shaded}, {"normal", Show::normal},
                                                   {"height", Show::height}, {"rate", Show::rate},
                                                   {"faces", Show::faces},   {"wireframe", Show::wireframe}};
    return words.at(word);
}

std::vector<Layer> layersOf(const std::vector<std::string>& words) {
    static const std::vector<std::pair<std::string, Layer>> known{{"depth", Layer::depth},   {"normal", Layer::normal},
                                                                  {"face", Layer::face},     {"uv", Layer::uv},
                                                                  {"height", Layer::height}, {"motion", Layer::motion}};
    std::vector<Layer> layers;
    for (const auto& [word, layer] : known)
        if (std::ranges::find(words, word) != words.end() || std::ranges::find(words, "all") != words.end())
            layers.push_back(layer);
    return layers;
}

} // namespace

void checkPicturePath(const std::string& path, const PictureArgs& args) {
    if (!path.ends_with(".png") && !path.ends_with(".exr"))
        fail(Failure::usage, "{}: pictures are written as .png or .exr", path);
    if (!args.layers.empty() && !path.ends_with(".exr")) fail(Failure::usage, "{}: layers go into an .exr", path);
}

bool wantsMotion(const PictureArgs& args) {
    const std::vector<Layer> layers = layersOf(args.layers);
    return std::ranges::find(layers, Layer::motion) != layers.end();
}

void suitHeights(Loaded& loaded, const Warn& warn) {
    constexpr double kUsual = 1 << 20, kMost = 1e15;
    Coordinates& coordinates = loaded.cage.coordinates;
    const double reach = loaded.height->heightBound(), size = summarize(loaded.cage).bounds.longestSide();
    const double ratio = size > 0 ? reach / size : 0;
    if (ratio > kMost)
        warn(fmt::format("heights of up to {:.3g} cage units on a cage {:.3g} large: 32-bit floats hold at most {:.0e} "
                         "times its size; lower --scale",
                         reach, size, kMost));
    if (ratio > kUsual) {
        const double factor = std::ldexp(1.0, std::ilogb(std::min(ratio, kMost)) / 2);
        for (vec3& p : loaded.cage.positions) p = dvec3(p) / factor;
        coordinates.unit *= factor;
    }
    loaded.height->scale /= coordinates.unit;
}

void enter(const Coordinates& coordinates, CameraArgs& args) {
    args.distance /= coordinates.unit;
    if (args.lookAt.empty()) return;
    const dvec3 at = coordinates.toLocal(dvec3(args.lookAt[0], args.lookAt[1], args.lookAt[2]));
    args.lookAt = {at.x, at.y, at.z};
}

Camera cameraOf(const CameraArgs& args, std::span<const dvec3> points) {
    CameraOptions options = args.options;
    if (args.distance > 0) options.distance = args.distance;
    if (!args.lookAt.empty()) options.lookAt = dvec3(args.lookAt[0], args.lookAt[1], args.lookAt[2]);
    return frameCamera(points, options, double(args.size[0]) / args.size[1]);
}

RenderOptions renderOptions(const PictureArgs& picture, const Device& device, const std::vector<dvec3>& points) {
    RenderOptions options{triangleOptions(picture.triangles, device)};
    options.show = showOf(picture.show);
    options.camera = cameraOf(picture.camera, points);
    for (const dvec3& p : points) options.bounds.add(p);
    options.lighting.keyAzimuth = picture.light.empty() ? picture.camera.options.azimuth - 55 : picture.light[0];
    options.lighting.keyElevation = picture.light.empty() ? 50 : picture.light[1];
    options.lighting.castsShadows = !picture.hasNoShadows;
    options.layers = layersOf(picture.layers);
    return options;
}

Material materialOf(const PictureArgs& picture) {
    Material material;
    if (!picture.albedo.empty()) material.albedo = vec3(1);
    if (!picture.color.empty()) material.albedo = vec3(picture.color[0], picture.color[1], picture.color[2]);
    material.roughness = float(picture.roughness);
    return material;
}

Finish finishOf(const PictureArgs& args) {
    Finish finish;
    if (args.isTransparent) finish.background = Background::transparent;
    if (!args.background.empty()) {
        finish.background = Background::color;
        finish.color = vec3(args.background[0], args.background[1], args.background[2]);
    }
    return finish;
}

} // namespace relief::app
