#include "doctor/doctor.h"

namespace relief {

namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::vector<RendererSetting> listVectorSettings(const Examination& examination, double unit) {
    const VectorMap& vectors = *examination.map.vectors;
    const HeightMap& first = vectors.channels[0];
    const bool isTangent = vectors.space == VectorSpace::tangent;
    const std::string scale = number(std::abs(first.scale) * unit), bound = number(examination.bound);
    return {
        {"blender", "Image Texture: Color Space", "Non-Color"},
        {"blender", "Image Texture: Extension", first.wrap == Wrap::repeat ? "Repeat" : "Extend"},
        {"blender", "Vector Displacement node: Space", isTangent ? "Tangent Space" : "Object Space"},
        {"blender", "Vector Displacement node: Midlevel", number(first.mid)},
        {"blender", "Vector Displacement node: Scale", scale},
        {"blender", "Material: Displacement", "Displacement and Bump"},
        {"arnold", "image: color_space", "Raw"},
        {"arnold", "polymesh: subdiv_type", "catclark"},
        {"arnold", "vector_map: tangent_space", isTangent ? "on" : "off"},
        {"arnold", "polymesh: disp_height", scale},
        {"arnold", "polymesh: disp_padding", bound},
        {"renderman", "PxrTexture: linearize", "0"},
        {"renderman", "PxrDispTransform: dispHeight", scale},
        {"renderman", "PxrDispTransform: vectorSpace", isTangent ? "tangent" : "object"},
        {"renderman", "Attribute displacementbound: sphere", bound},
    };
}

} // namespace

std::vector<RendererSetting> listRendererSettings(const Examination& examination, double unit) {
    if (examination.map.vectors) return listVectorSettings(examination, unit);
    const HeightMap& map = examination.map;
    const std::string scale = number(map.scale * unit), mid = number(map.mid), bound = number(examination.bound);
    return {
        {"blender", "Image Texture: Color Space", "Non-Color"},
        {"blender", "Image Texture: Extension", map.wrap == Wrap::repeat ? "Repeat" : "Extend"},
        {"blender", "Displacement node: Space", "Object"},
        {"blender", "Displacement node: Midlevel", mid},
        {"blender", "Displacement node: Scale", scale},
        {"blender", "Material: Displacement", "Displacement and Bump"},
        {"blender", "Subdivision modifier", "Catmull-Clark, adaptive"},
        {"arnold", "image: color_space", "Raw"},
        {"arnold", "polymesh: subdiv_type", "catclark"},
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

} // namespace relief
