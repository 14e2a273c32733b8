// What `relief bake` is asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/output.h"
#include "bake/bake.h"
#include "scene/scene.h"

namespace relief::app {

/// A picture to write besides the heights.
struct LayerFile {
    std::string path;
    SculptLayer layer;
};

struct BakeArgs {
    ObjectDesc
        object; ///< its height is read with --check; else its mid and scale are those of the file that is written
    std::string sculpt, target, voids, heatmap, device;
    std::string normals, position, vector, occlusion, curvature;
    NormalSpace normalSpace = NormalSpace::tangent;
    NormalY normalY = NormalY::up;
    int occlusionLines = 64;
    std::optional<SampleType> sample;
    ivec2 size{1024};
    int sampleCount = 4;
    double margin = 2;
    Distance front{0.05, true}, back{0.05, true}, tolerance{0.001, true};
    bool hasReach = false; ///< `front` and `back` are asked for
    bool perFace = false;
    std::optional<int> faceSize;       ///< per face: segments of a side
    std::optional<Distance> texelSize; ///< per face: length of a segment
    std::string lineCage;              ///< path of the cage that lines begin on
    bool smoothCage = false;           ///< lines begin on the cage itself, inflated
    bool checksOnly = false, dropsBehind = false;
    Output output;

    [[nodiscard]] int samplesPerSide() const; ///< of a texel
};

/// The other maps that are asked for, in the order of BakeOptions::layers.
std::vector<LayerFile> listLayers(const BakeArgs& args);

/// True for layers whose numbers have a unit: they are written as floats.
bool hasUnit(SculptLayer layer);

/// How heights are written. Throws Failure::usage where the file's format does not hold them.
SampleType chooseHeightSample(const BakeArgs& args);

/// Throws Failure::usage for what makes no sense, and for outputs that cannot be written, before anything is read.
void checkBakeArgs(const BakeArgs& args);

/// Adds cage, sculpt, output and all options.
void addBakeOptions(CLI::App& app, BakeArgs& args);

} // namespace relief::app
