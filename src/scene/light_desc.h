// Light, materials and shading that a command line asks for, as plain values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace relief {

/// A normal map as NormalOptions describes it. The path is empty where there is none.
struct NormalMapDesc {
    std::string path;
    NormalSpace space = NormalSpace::tangent;
    NormalY y = NormalY::up;
};

struct MaterialDesc {
    std::string albedo;        ///< path of a color map, or empty
    std::optional<vec3> color; ///< linear, multiplies the map; default: that of Material, or white with a map
    float roughness = Material().roughness;
    std::optional<float> metallic; ///< of Material; default: 0 for a roughness below 0.05
    NormalMapDesc normalMap;

    /// Whether it is a material that conserves energy, and may be a mirror.
    [[nodiscard]] bool conservesEnergy() const { return metallic || roughness < 0.05f; }
};

struct LightingDesc {
    std::optional<dvec2> key;          ///< azimuth and elevation of the key light, degrees; default: left of the camera
    std::optional<double> keyStrength; ///< default: that of Lighting
    std::optional<vec3> keyColor;
    std::vector<DistantLight> others;
    bool castsShadows = Lighting().castsShadows;
    std::string environment;               ///< path as of readEnvironment; empty: the built-in studio
    std::optional<EnvironmentShape> shape; ///< of it; default: what its sides say
    double environmentAzimuth = 0;         ///< as Lighting's
    double occlusionRadius = 0;            ///< as Lighting's
};

/// How surfaces shade.
struct ShadingDesc {
    Shading shading = Shading::physical;
    PhongCoefficients phong;
    bool tableAtVertices = false;
    WaterFloor waterFloor; ///< in cage units; its height follows from the cage: see makeWaterFloor
    std::string matcap;    ///< path of a picture of a ball; empty: one of the object's own material and lights
};

} // namespace relief
