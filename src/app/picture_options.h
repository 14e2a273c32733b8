// The options that say how triangles are made and what a picture of them shows.
#pragma once

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relief::app {

struct TriangleArgs {
    std::optional<Path> path; ///< default: what suits the verb and the device
    TriangleOptions options;  ///< all else
};

struct PictureArgs {
    TriangleArgs triangles;
    Show show = RenderOptions().show;
    std::vector<Layer> layers;
    Raster raster = RenderOptions().raster;
    Filter filter = RenderOptions().filter;
    float anisotropy = RenderOptions().anisotropy;
    Finish finish;
    std::string device; ///< part of its name, or empty
};

/// Adds --path. `defaultPath` says in words what is done without it.
void addPath(CLI::App& app, std::optional<Path>& path, const std::string& defaultPath);
/// Adds all options of triangles but --path, which not every verb can choose.
void addTriangles(CLI::App& app, TriangleOptions& options);
void addNormal(CLI::App& app, NormalKind& normal);
/// Adds the options of the camera and the size of its picture in pixels.
void addCamera(CLI::App& app, CameraOptions& camera, ivec2& size);
void addDevice(CLI::App& app, std::string& name);
/// Adds the options of triangles, camera, material, light and picture.
void addPicture(CLI::App& app, SceneDesc& scene, PictureArgs& picture);

/// The path that was asked for, or what suits the device.
TriangleOptions toTriangleOptions(const TriangleArgs& args, const Device& device);
/// What a picture shows of a loaded scene. The verb sets camera, bounds, and the environment of the scene.
RenderOptions toRenderOptions(const PictureArgs& picture, const SceneDesc& scene, const LoadedObject& object,
                              const Device& device);

/// Draws a picture. Where no path was asked for and that of `options` makes too few segments, it becomes dicing.
Picture drawPicture(Renderer& renderer, const Instance& instance, RenderOptions& options, const PictureArgs& args,
                    const Device& device);
/// Warns where segments of a picture that was drawn may be longer than was asked for.
void warnOfLongSegments(const RenderOptions& options, const Device& device, const FrameStats& stats, const Warn& warn);

/// Throws Failure::input where texture coordinates or errors are to be shown and `cage`, the object's file, has none.
void checkShown(const PictureArgs& args, const std::string& cage, const LoadedObject& object);
/// Warns of more anisotropy than the device has; throws Failure::device where it has none.
void checkFilter(const PictureArgs& args, const Device& device, const Warn& warn);

/// Throws Failure::usage unless `path` is a picture's, and an .exr where layers are asked for.
void checkPicturePath(const std::string& path, const PictureArgs& args);
/// Whether the layer of motion is asked for, which needs the pose of the frame before.
bool wantsMotion(const PictureArgs& args);

} // namespace relief::app
