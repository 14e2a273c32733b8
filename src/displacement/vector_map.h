// Displacement by vectors: loading, convention, lookup, and the double-precision reference.
#pragma once

#include "displacement/displaced_frame.h"
#include "shared/constants.h"

namespace relief {

/// What the components of a vector map are along.
enum class VectorSpace : std::uint32_t { tangent = kVectorTangent, object = kVectorObject };
inline constexpr Word<VectorSpace> kVectorSpaces[] = {
    {"tangent", VectorSpace::tangent, "x along s, y along t and z along the surface's own normal"},
    {"object", VectorSpace::object, "along the object's x, y and z"},
};

/// Programs whose order of channels and signs maps have.
enum class VectorPreset { none, zbrush, mudbox, blender };
inline constexpr Word<VectorPreset> kVectorPresets[] = {
    {"none", VectorPreset::none, "red is x, green y and blue z"},
    {"zbrush", VectorPreset::zbrush,
     "ZBrush with FlipAndSwitch 1: red is x, green y and blue z (25, that of Maya and Arnold, is mudbox)"},
    {"mudbox", VectorPreset::mudbox, "Mudbox, Maya and Arnold: of tangent space, green is the normal and blue along t"},
    {"blender", VectorPreset::blender,
     "Blender: of tangent space, green is the normal and blue along t; of object space, Z is up"},
};

/// The three components of the displacement, one scalar map each: of one size, or sets of the same tiles.
struct VectorMap {
    std::array<HeightMap, 3> channels;    ///< along T, B and N, or x, y and z
    std::array<MapEncoding, 3> encodings; ///< how the device stores them: one format
    VectorSpace space = VectorSpace::tangent;
};

struct VectorOptions {
    VectorSpace space = VectorSpace::tangent;
    std::string order = "xyz";        ///< the component that red, green and blue hold: a permutation of "xyz"
    std::string flip;                 ///< components whose sign is turned: some of "xyz"
    std::optional<double> mid, scale; ///< as HeightOptions'; the scale is that of all components
    std::string channel;              ///< the first of the three channels, as findChannel reads it; "": the first
    Wrap wrap = Wrap::repeat;
    std::optional<MapFormat> format;
    ImageLimits limits;
};

/// The order of channels and the flips of a program, in a space.
void applyPreset(VectorOptions& options, VectorPreset preset);

/// Makes a map of three channels of components in cage units, before order and flips.
/// Throws as makeHeightMap does, and Failure::usage for an order that is no permutation of "xyz".
HeightMap makeVectorMap(const Image& components, const VectorOptions& options);

/// Makes a map of three components in cage units, which all are single maps of one size or sets of the same tiles.
/// The device stores them in `format`.
HeightMap joinComponents(const std::array<HeightMap, 3>& components, VectorSpace space, MapFormat format);

/// Reads three channels of an image as raw data; of all files of a set where `path` is a TilePattern. Warns as
/// loadHeightMap does.
/// Throws Failure::input for fewer than three channels, for texels that are not finite and for a map per face, and as
/// readImage and listTiles do; Failure::device for a set larger than memory.
HeightMap loadVectorMap(const std::string& path, const VectorOptions& options, const Warn& warn = warnOnStderr);

/// Multiplies the heights or the vectors of a map.
void scaleHeights(HeightMap& map, double factor);

// --- lookup ---------------------------------------------------------------------------------------------------------

/// The components and their central differences over one texel, as HeightSample.
struct VectorSample {
    dvec3 c{0}, cs{0}, ct{0};
};
VectorSample sampleVectors(const VectorMap& map, const MapPlace& place);
VectorSample sampleVectors(const VectorMap& map, const dvec2& st);

// --- the displaced surface ------------------------------------------------------------------------------------------

struct VectorReference {
    const ReferenceSurface& surface;
    VectorSpace space = VectorSpace::tangent;
    const ReferenceSurface* rest = nullptr; ///< vectors grow with the surface since then; null: they do not
};

/// Evaluates the surface displaced by components that vary linearly with s and t around the point. Tangents are
/// differences of q over the surface, which share no formula with the shaders. At extraordinary vertices there are
/// none: q_u and q_v are 0, and all normals are the limit surface's.
DisplacedFrame displacedByVectors(const VectorReference& reference, const VectorSample& sample, int face,
                                  const dvec2& uv);

/// The lowest real part of the eigenvalues of the map from the limit surface to its displaced image, seen along n: of
/// heights 1 + h kappa. 0 or less where the surface has turned over: it is folded, or hangs over. Not finite without a
/// tangent plane.
double computeFoldFactor(const DisplacedFrame& frame);

} // namespace relief
