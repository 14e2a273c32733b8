// Maps made of other maps: normals from heights, and heights from normals.
#pragma once

#include "displacement/displacement.h"

namespace relief {

/// The true size of the unit square of texture space, in the units of heights. Both are above 0.
using MapSize = dvec2;

/// Returns the size of a map of square texels whose width is 1.
MapSize computeMapSize(int width, int height);

/// Makes the tangent-space normals n ~ (-h_x, -h_y, 1) of a height map at its texel centres. The slopes are central
/// differences over one texel, as sampleHeight and the shaders take them, per true length: h_x = h_s / size.x along s,
/// h_y = h_t / size.y along t. Beyond the border the map continues by its own wrap.
NormalMap computeNormalMap(const HeightMap& heights, const MapSize& size);

/// Encodes normals as codes (n + 1) / 2 in three channels. With NormalY::down the second one is that of -n.y.
Image toCodes(const NormalMap& map, NormalY y);

/// Finds the steepest slope of a tangent-space map: the largest angle between a normal and the z axis, degrees.
double computeSteepestSlope(const NormalMap& map);

/// Heights whose slopes come nearest to those of normals, and how near.
struct IntegratedHeights {
    HeightMap heights;      ///< mean 0, mid 0 and scale 1; in the unit of the size
    double slopeRms = 0;    ///< length of the normals' slopes, root of the mean square
    double residualRms = 0; ///< the same of the difference between them and the slopes of the heights
    dvec2 meanSlope{0};     ///< of the normals, along x and y
    [[nodiscard]] double residualShare() const { return slopeRms > 0 ? residualRms / slopeRms : 0; }
};

/// Computes the standard deviation of slopes of normals that a file's samples round; 0 for floats of 32 bits and more.
double computeSlopeRounding(const ImageInfo& info);

/// Throws Failure::usage for normals that no heights can be made of: those of object space. `name` stands for the map.
void checkNormalSpace(NormalSpace space, const std::string& name);

struct IntegrationOptions {
    MapSize size{1};     ///< of the unit square
    double rounding = 0; ///< computeSlopeRounding of the file
};

/// Integrates a tangent-space map: the least-squares solution of "the central differences of h are the slopes
/// (-n.x, -n.y) / n.z of the normals", up to a constant. It inverts computeNormalMap under the map's own wrap.
///
/// The normal equations are a Poisson equation. They are diagonal after a Hartley transform along an axis that repeats
/// and a cosine transform along one that is clamped. Waves of two texels, of which central differences see nothing, are
/// 0 in the result. With a `rounding`, heights with small second differences are preferred as much as the rounding
/// hides of them (Tikhonov); without that, errors of the slopes show as a pattern of single texels. Across a clamped
/// border a map may hold all of a slope, or the half that a clamped difference sees: all of it where that makes much
/// smoother heights.
/// Throws Failure::input for normals with z <= 0, and as checkNormalSpace; `name` stands for the map in messages.
IntegratedHeights integrateNormals(const NormalMap& map, const IntegrationOptions& options, const std::string& name);

} // namespace relief
