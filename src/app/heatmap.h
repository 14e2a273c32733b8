// Where a surface is wrong, as a picture.
#pragma once

#include "app/certificate.h"
#include "frame/frame.h"

namespace relief::app {

/// Throws Failure::usage unless `path` is one that pictures are written to.
void checkHeatmapPath(const std::string& path);

/// What `relief check` knows of the surface at every sample.
struct Heat {
    const SurfaceSamples& samples;
    std::span<const SampleResult> results;
    std::span<const SampleError> errors;
    Promises promises;
};

/// One value a sample: up to +1 errors, on a logarithmic scale from 0 at a tenth of what is promised to 1 at the
/// promise itself; down to -1 folds, from 0 where 1 + h kappa is 0.5 to -1 where it is 0 or less. Folds go first: the
/// rounding of floats is some errors everywhere.
std::vector<float> heatValues(const Heat& heat);

/// The displaced surface through the samples, of faces with so many sides, with those values as heights.
DenseMesh heatMesh(const Heat& heat, int sideCount);
/// Errors are orange, folds blue, the rest white; from where `relief render` looks.
Picture drawHeatmap(Device& device, const DenseMesh& mesh);

} // namespace relief::app
