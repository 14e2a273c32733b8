#include <algorithm>

#include "doctor/doctor.h"

namespace relief {

namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }

/// Which channels of the map another program has to be given as red, green and blue, where it takes those as `order`,
/// some of them flipped: "R, B, G".
std::string shuffleFor(const Examination& examination, const std::string& order, const std::string& flip) {
    std::string channels;
    for (const char axis : order) {
        const std::size_t index = examination.vectorOrder.find(axis);
        const auto isIn = [&](const std::string& axes) { return axes.find(axis) != std::string::npos; };
        channels += channels.empty() ? "" : ", ";
        channels += isIn(flip) != isIn(examination.vectorFlip) ? "-" : "";
        channels += index < 3 ? "RGB"[index] : '?';
    }
    return channels;
}

std::vector<RendererSetting> listVectorSettings(const Examination& examination, double unit) {
    const VectorMap& vectors = *examination.map.vectors;
    const HeightMap& first = vectors.channels[0];
    const bool isTangent = vectors.space == VectorSpace::tangent;
    const std::string scale = number(std::abs(first.scale) * unit), bound = number(examination.bound);
    return {
        {"blender", "Image Texture: Color Space", "Non-Color"},
        {"blender", "Image Texture: Extension", first.wrap == Wrap::repeat ? "Repeat" : "Extend"},
        {"blender", "Image channels as red, green, blue", shuffleFor(examination, "xzy", isTangent ? "" : "z")},
        {"blender", "Vector Displacement node: Space", isTangent ? "Tangent Space" : "Object Space"},
        {"blender", "Vector Displacement node: Midlevel", number(first.mid)},
        {"blender", "Vector Displacement node: Scale", scale},
        {"blender", "Material: Displacement", "Displacement and Bump"},
        {"arnold", "image: color_space", "Raw"},
        {"arnold", fmt::format("image channels for vector_map: order {}", isTangent ? "XZY" : "XYZ"),
         shuffleFor(examination, isTangent ? "xzy" : "xyz", "")},
        {"arnold", "vector_map: tangent_space", isTangent ? "on" : "off"},
        {"arnold", "polymesh: disp_height", scale},
        {"arnold", "polymesh: disp_padding", bound},
        {"renderman", "PxrTexture: linearize", "0"},
        {"renderman", "PxrDispTransform: dispHeight", scale},
        {"renderman", "PxrDispTransform: vectorSpace", isTangent ? "tangent" : "object"},
        {"renderman", "Attribute displacementbound: sphere", bound},
    };
}

std::vector<RendererSetting> listHeightSettings(const Examination& examination, double unit) {
    const HeightMap& map = examination.map;
    const std::string scale = number(map.scale * unit), mid = number(map.mid), bound = number(examination.bound);
    return {
        {"blender", "Image Texture: Color Space", "Non-Color"},
        {"blender", "Image Texture: Extension", map.wrap == Wrap::repeat ? "Repeat" : "Extend"},
        {"blender", "Displacement node: Space", "Object"},
        {"blender", "Displacement node: Midlevel", mid},
        {"blender", "Displacement node: Scale", scale},
        {"blender", "Material: Displacement", "Displacement and Bump"},
        {"arnold", "image: color_space", "Raw"},
        {"arnold", "polymesh: disp_zero_value", mid},
        {"arnold", "polymesh: disp_height", scale},
        {"arnold", "polymesh: disp_padding", bound},
        {"arnold", "polymesh: autobump_visibility", "camera"},
        {"renderman", "PxrTexture: linearize", "0"},
        {"renderman", "PxrTexture: colorScale", scale},
        {"renderman", "PxrTexture: colorOffset", number(0 - map.mid * map.scale * unit)},
        {"renderman", "PxrDispTransform: dispRemapMode", "None"},
        {"renderman", "PxrDispTransform: dispScaleSpace", "object"},
        {"renderman", "PxrDisplace: dispAmount", "1"},
        {"renderman", "Attribute displacementbound: sphere", bound},
    };
}

/// How the cage is subdivided.
std::vector<RendererSetting> listSchemeSettings(Scheme scheme) {
    const char* const none = "none: it has no Loop subdivision";
    switch (scheme) {
    case Scheme::catmark:
        return {{"blender", "Subdivision modifier", "Catmull-Clark, adaptive"},
                {"arnold", "polymesh: subdiv_type", "catclark"},
                {"renderman", "SubdivisionMesh: scheme", "catmull-clark"}};
    case Scheme::loop:
        return {{"blender", "Subdivision modifier", none},
                {"arnold", "polymesh: subdiv_type", none},
                {"renderman", "SubdivisionMesh: scheme", "loop"}};
    case Scheme::bilinear:
        return {{"blender", "Subdivision modifier", "Simple, adaptive"},
                {"arnold", "polymesh: subdiv_type", "linear"},
                {"renderman", "SubdivisionMesh: scheme", "bilinear"}};
    }
    return {};
}

/// How the files of a set are named, and that a map per face has to become one over texture coordinates.
void addFiles(const Examination& examination, std::vector<RendererSetting>& settings) {
    std::vector<RendererSetting> files;
    if (const std::optional<TilePattern> pattern = findTilePattern(examination.path)) {
        const auto named = [&](const char* token) { return pattern->before + token + pattern->after; };
        const bool isUdim = pattern->numbers == TilePattern::Numbers::udim;
        const std::string renamed = isUdim ? "" : "renamed to UDIM numbers: ";
        files = {{"blender", "Image: Source", "UDIM Tiles"},
                 {"blender", "Image: File", renamed + named("<UDIM>")},
                 {"arnold", "image: filename", renamed + named("<udim>")},
                 {"renderman", "PxrTexture: filename", renamed + named("<UDIM>")}};
    }
    if (examination.map.addressing == Addressing::faces)
        for (const char* renderer : {"blender", "arnold", "renderman"})
            files.push_back({renderer, "texture",
                             fmt::format("over texture coordinates: relief map CAGE {} -o MAP.exr", examination.path)});
    settings.insert(settings.begin(), files.begin(), files.end());
}

} // namespace

std::vector<RendererSetting> listRendererSettings(const Examination& examination, double unit) {
    std::vector<RendererSetting> settings =
        examination.map.vectors ? listVectorSettings(examination, unit) : listHeightSettings(examination, unit);
    const std::vector<RendererSetting> scheme = listSchemeSettings(examination.scheme);
    settings.insert(settings.end(), scheme.begin(), scheme.end());
    addFiles(examination, settings);
    const auto orderOf = [](const RendererSetting& setting) {
        return setting.renderer == "blender" ? 0 : setting.renderer == "arnold" ? 1 : 2;
    };
    std::ranges::stable_sort(settings, {}, orderOf);
    return settings;
}

} // namespace relief
