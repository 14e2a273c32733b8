// The options that say which object there is: cage, scheme, height map, what moves it.
#pragma once

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relief::app {

/// Adds the cage as a positional, and all options of its surface, height map and motion.
void addObject(CLI::App& app, ObjectDesc& object);
/// Adds the options of a surface without heights.
void addSurface(CLI::App& app, ObjectDesc& object);
/// Adds the options of a surface and its height map alone.
void addSurfaceOptions(CLI::App& app, ObjectDesc& object);
/// Adds the options of a surface and of all that displaces it: height and vector maps, layers, height functions.
void addHeightedSurface(CLI::App& app, ObjectDesc& object);
/// Adds --height-function and --height-bound, for verbs that have addSurfaceOptions.
void addHeightFunction(CLI::App& app, HeightDesc& height);
/// Adds --scale, --mid and --channel: how the values of a height map are read.
void addHeightValues(CLI::App& app, HeightDesc& height);
/// Adds --vector-space and the order and signs of channels, for verbs whose maps are positionals: with a space they are
/// vector maps.
void addVectorKind(CLI::App& app, HeightDesc& height);
/// Adds --time, for verbs that take one pose of an object that moves.
void addTime(CLI::App& app, MotionDesc& motion);
/// Adds --height-space, for verbs that show an object that moves.
void addHeightSpace(CLI::App& app, HeightSpace& space);

} // namespace relief::app
