// The options that say where maps are looked up, and which maps are added.
#pragma once

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relief::app {

/// Adds --layer, for verbs that have --height.
void addLayers(CLI::App& app, HeightDesc& height);
/// Adds --map-repeat, --map-offset and --uv-set: which texture coordinates all maps are looked up by.
void addPlacement(CLI::App& app, ObjectDesc& object);

/// Reads "MAP,key=value,..." as --layer takes it. Throws Failure::usage for a key or value that is none.
LayerDesc parseLayer(const std::string& word);

} // namespace relief::app
