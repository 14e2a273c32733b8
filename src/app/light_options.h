// The options of materials, lights, environments and shading, for verbs that draw pictures or balls.
#pragma once

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relief::app {

/// Adds --roughness and --metallic.
void addReflection(CLI::App& app, MaterialDesc& material);
/// Adds --environment and the distant lights.
void addLighting(CLI::App& app, LightingDesc& lighting);
/// Adds --environment-shape alone.
void addEnvironmentShape(CLI::App& app, std::optional<EnvironmentShape>& shape);
/// Adds --phong alone.
void addPhong(CLI::App& app, PhongCoefficients& phong);
/// Adds --shading and what belongs to it.
void addShading(CLI::App& app, ShadingDesc& shading);

/// Reads a light such as "30,45" or "-60,20,1.5,1,0.9,0.8": azimuth and elevation, and then its strength and its color.
/// Empty where the word is none.
struct LightWord {
    dvec2 direction{0};
    std::optional<double> strength;
    std::optional<vec3> color;
};
std::optional<LightWord> parseLight(const std::string& word);

} // namespace relief::app
