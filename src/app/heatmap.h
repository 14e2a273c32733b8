// Heat maps: pictures of where a surface deviates from its reference or folds.
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
};

/// One value per sample. Errors are positive, on a logarithmic scale from 0 at a tenth of what is promised to 1 at the
/// promise itself. Folds are negative, from 0 where 1 + h kappa is 0.5 to -1 where it is 0 or less. Where there are
/// both, folds are shown: the rounding of floats makes small errors everywhere.
std::vector<float> heatValues(const Heat& heat);

/// The displaced surface through the samples as a mesh, with heatValues as heights. `sideCount`: sides per face, 3
/// or 4.
DenseMesh heatMesh(const Heat& heat, int sideCount);
/// A picture of that mesh from the default camera: errors orange, folds blue, the rest white.
Picture drawHeatmap(Device& device, const DenseMesh& mesh);

} // namespace relief::app
