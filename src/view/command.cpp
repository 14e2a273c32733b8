// The command line of what the window shows.
#include <algorithm>

#include "view/view.h"

namespace relief {
namespace {

/// Options whose values the window may change.
class Options {
public:
    explicit Options(std::vector<GivenOption> given) : given_(std::move(given)) {}

    void remove(const std::string& name) {
        std::erase_if(given_, [&](const GivenOption& option) { return option.name == name; });
    }
    /// Puts the option in place of the one that was given, or behind all others.
    void set(const std::string& name, const std::string& value) {
        const auto same = [&](const GivenOption& option) { return option.name == name; };
        const auto found = std::ranges::find_if(given_, same);
        if (found != given_.end())
            found->value = value;
        else
            given_.push_back({name, value});
    }
    /// Sets the option where two values differ; an empty new one removes it.
    void replace(const std::string& name, const std::string& before, const std::string& now) {
        if (before == now) return;
        if (now.empty())
            remove(name);
        else
            set(name, now);
    }
    [[nodiscard]] const std::vector<GivenOption>& all() const { return given_; }

private:
    std::vector<GivenOption> given_;
};

std::string textOf(const std::optional<double>& number) { return number ? fmt::format("{}", *number) : ""; }
std::string textOf(const std::optional<int>& number) { return number ? fmt::format("{}", *number) : ""; }
std::string textOf(const std::optional<dvec3>& p) { return p ? fmt::format("{},{},{}", p->x, p->y, p->z) : ""; }
std::string textOf(const std::optional<dvec2>& p) { return p ? fmt::format("{},{}", p->x, p->y) : ""; }

/// The key light as --light takes it; empty for the default one.
std::string textOf(const LightingDesc& lighting) {
    if (!lighting.key) return "";
    std::string text = textOf(lighting.key);
    if (lighting.keyStrength) text += fmt::format(",{}", *lighting.keyStrength);
    if (const auto& color = lighting.keyColor) text += fmt::format(",{},{},{}", color->x, color->y, color->z);
    return text;
}

void setObject(Options& options, const ObjectDesc& before, const ObjectDesc& now) {
    options.replace("", before.cage, now.cage);
    options.replace("--height", before.height.path, now.height.path);
    options.replace("--height-function", before.height.function, now.height.function);
    options.replace("--scale", textOf(before.height.scale), textOf(now.height.scale));
    options.replace("--mid", textOf(before.height.mid), textOf(now.height.mid));
    options.replace("--detail", wordOf(kDetails, before.height.detail), wordOf(kDetails, now.height.detail));
    options.replace("--deform", before.motion.deformers, now.motion.deformers);
    options.replace("--cache", before.motion.cachePath, now.motion.cachePath);
    options.replace("--skin", before.motion.skinPath, now.motion.skinPath);
    options.replace("--roughness", fmt::format("{}", before.material.roughness),
                    fmt::format("{}", now.material.roughness));
    // What needs an option that is gone.
    if (now.height.path.empty()) options.remove("--layer");
    if (now.height.function.empty()) options.remove("--height-bound");
    if (now.motion.cachePath.empty()) options.remove("--cache-frames");
    if (now.motion.skinPath.empty()) options.remove("--clip"), options.remove("--bind-nearest");
}

void setTriangles(Options& options, const Look& before, const Look& now) {
    options.replace("--rate", textOf(before.triangles.rate), textOf(now.triangles.rate));
    if (now.triangles.rate) // they exclude each other
        options.remove("--edge-pixels");
    else if (before.triangles.edgePixels != now.triangles.edgePixels || before.triangles.rate)
        options.set("--edge-pixels", fmt::format("{}", now.triangles.edgePixels));
    options.replace("--spacing", wordOf(kSpacings, before.triangles.spacing), wordOf(kSpacings, now.triangles.spacing));
    options.replace("--normal", wordOf(kNormals, before.triangles.normal), wordOf(kNormals, now.triangles.normal));
    options.replace("--path", before.path ? wordOf(kPaths, *before.path) : "",
                    now.path ? wordOf(kPaths, *now.path) : "");
}

void setCamera(Options& options, const SceneDesc& before, const SceneDesc& now) {
    const CameraOptions &old = before.camera, &camera = now.camera;
    options.set("--size", fmt::format("{},{}", now.size.x, now.size.y));
    options.replace("--azimuth", textOf(std::optional(old.azimuth)), textOf(std::optional(camera.azimuth)));
    options.replace("--elevation", textOf(std::optional(old.elevation)), textOf(std::optional(camera.elevation)));
    options.replace("--fov", textOf(std::optional(old.fieldOfView)), textOf(std::optional(camera.fieldOfView)));
    options.replace("--distance", textOf(old.distance), textOf(camera.distance));
    options.replace("--look-at", textOf(old.lookAt), textOf(camera.lookAt));
}

void setShading(Options& options, const Look& before, const Look& now) {
    options.replace("--show", wordOf(kShows, before.show), wordOf(kShows, now.show));
    options.replace("--raster", wordOf(kRasters, before.raster), wordOf(kRasters, now.raster));
    options.replace("--filter", wordOf(kFilters, before.filter), wordOf(kFilters, now.filter));
    const LightingDesc &old = before.scene.lighting, &lighting = now.scene.lighting;
    options.replace("--light", textOf(old), textOf(lighting));
    options.replace("--occlusion", textOf(std::optional(old.occlusionRadius)),
                    textOf(std::optional(lighting.occlusionRadius)));
    options.replace("--shading", wordOf(kShadings, before.scene.shading.shading),
                    wordOf(kShadings, now.scene.shading.shading));
    options.replace("--environment", old.environment, lighting.environment);
    options.replace("--environment-azimuth", textOf(std::optional(old.environmentAzimuth)),
                    textOf(std::optional(lighting.environmentAzimuth)));
    options.replace("--exposure", textOf(std::optional(before.finish.exposure)),
                    textOf(std::optional(now.finish.exposure)));
    if (!lighting.castsShadows && old.castsShadows) options.set("--no-shadows", "");
    if (lighting.castsShadows) options.remove("--no-shadows");
}

} // namespace

std::vector<std::string> toCommandWords(const std::string& verb, std::vector<GivenOption> given, const Look& first,
                                        const Look& look) {
    Options options(std::move(given));
    setObject(options, first.scene.object, look.scene.object);
    setTriangles(options, first, look);
    setCamera(options, first.scene, look.scene);
    setShading(options, first, look);
    if (verb == "animate") options.set("--frames", fmt::format("{0}:{0}", look.frame)), options.remove("--time");
    if (verb == "render") options.remove("--frames");

    // A value after "=" is never taken for an option, whatever its sign.
    std::vector<std::string> words{"relief", verb};
    for (const GivenOption& option : options.all()) {
        if (option.name.empty())
            words.push_back(option.value);
        else
            words.push_back(option.value.empty() ? option.name : option.name + "=" + option.value);
    }
    return words;
}

std::string toShellLine(const std::vector<std::string>& words) {
    constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=./,:+@%";
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == word.npos) {
            line += word;
            continue;
        }
        line += '\'';
        for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

} // namespace relief
