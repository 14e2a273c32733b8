// The words of what a scene asks for: one table per enumeration, for option words, help and messages.
#pragma once

#include "animation/animation.h"
#include "base/words.h"
#include "frame/frame.h"
#include "pose/pose.h"

namespace relief {

/// How the polygons of a cage become what is drawn.
enum class Subdivision { catmark, loop, bilinear, none };

inline constexpr Word<Subdivision> kSubdivisions[] = {
    {"catmark", Subdivision::catmark, "Catmull-Clark subdivision"},
    {"loop", Subdivision::loop, "Loop subdivision; all faces must be triangles"},
    {"bilinear", Subdivision::bilinear, "bilinear subdivision: the surface follows the polygons"},
    {"none", Subdivision::none, "the polygons themselves, which a height map cannot displace"},
};

inline constexpr Word<EndCapKind> kEndCaps[] = {
    {"exact", EndCapKind::exact, "the limit surface"},
    {"gregory", EndCapKind::gregory, "OpenSubdiv's Gregory patches, which approximate it"},
};

inline constexpr Word<Path> kPaths[] = {
    {"tessellation", Path::tessellation, "by the hardware tessellator, in every pass"},
    {"grid", Path::grid, "by the vertex shader, in every pass"},
    {"dice", Path::dice, "once per picture by compute shaders, into an indexed mesh in memory"},
};

inline constexpr Word<Spacing> kSpacings[] = {
    {"equal", Spacing::equal, "whole numbers of segments of equal length"},
    {"fractional", Spacing::fractional,
     "segments that appear at zero length, so that nothing jumps while rates change"},
};

inline constexpr Word<NormalKind> kNormals[] = {
    {"limit", NormalKind::limit, "of the smooth surface before displacement"},
    {"first-order", NormalKind::firstOrder, "of the displaced surface, without the term of the surface's curvature"},
    {"full", NormalKind::full, "of the displaced surface"},
};

inline constexpr Word<Wrap> kWraps[] = {
    {"repeat", Wrap::repeat, "the map again"},
    {"clamp", Wrap::clamp, "the nearest texel of its border"},
};

/// No value: the smallest format that keeps every value of the file.
inline constexpr Word<std::optional<MapFormat>> kMapFormatChoices[] = {
    {"auto", std::nullopt, "the smallest format that keeps every value of the file"},
    {"float", MapFormat::real, "32-bit floats"},
    {"half", MapFormat::half, "16-bit floats"},
    {"unorm16", MapFormat::unorm16, "16-bit integers over the map's own range"},
    {"unorm8", MapFormat::unorm8, "8-bit integers over the map's own range"},
    {"bc4", MapFormat::bc4, "4 bits per texel, in compressed blocks"},
};

/// What heights do to a picture.
enum class Detail {
    displacement, ///< they move the surface
    bump,         ///< they bend normals per fragment; the surface stays where it is
    both,         ///< they move the surface as far as its triangles can follow, and bend normals by the rest
    none,         ///< nothing
};

inline constexpr Word<Detail> kDetails[] = {
    {"displacement", Detail::displacement, "heights move the surface"},
    {"bump", Detail::bump, "heights bend normals at every pixel; the surface stays where it is"},
    {"both", Detail::both, "heights move the surface as far as its triangles can follow, and bend normals by the rest"},
    {"none", Detail::none, "the surface without heights"},
};

inline constexpr Word<Filter> kFilters[] = {
    {"nearest", Filter::nearest, "the nearest texel"},
    {"bilinear", Filter::bilinear, "between four texels of the full map"},
    {"mipmap", Filter::mipmap, "between mip levels with texels as large as the pixel"},
    {"anisotropic", Filter::anisotropic, "several such lookups along what the pixel covers"},
};

inline constexpr Word<Raster> kRasters[] = {
    {"auto", Raster::automatic, "what is faster for the picture on the device"},
    {"hardware", Raster::hardware, "the device's fixed function"},
    {"compute", Raster::compute,
     "compute shaders, which pixel-sized triangles may suit better: for --path dice and meshes"},
};

inline constexpr Word<HeightSpace> kHeightSpaces[] = {
    {"absolute", HeightSpace::absolute, "cage units in every pose"},
    {"stretch", HeightSpace::stretch, "heights grow and shrink with the surface"},
};

inline constexpr Word<Interpolation> kInterpolations[] = {
    {"linear", Interpolation::linear, "positions are interpolated between the two nearest keys"},
    {"step", Interpolation::step, "the earlier key holds until the next one"},
};

inline constexpr Word<EnvironmentShape> kEnvironmentShapes[] = {
    {"equirect", EnvironmentShape::equirect, "longitude and latitude, twice as wide as high"},
    {"cube", EnvironmentShape::cube, "six faces: in files with {face} in their names, or in a cross, column or strip"},
    {"sphere", EnvironmentShape::sphere, "a mirroring ball, black outside of it"},
};

inline constexpr Word<CubeLayout> kCubeLayouts[] = {
    {"cross", CubeLayout::cross, "four by three faces"},
    {"column", CubeLayout::column, "three by four faces"},
    {"strip", CubeLayout::strip, "six faces side by side: px nx py ny pz nz"},
};

inline constexpr Word<Shading> kShadings[] = {
    {"physical", Shading::physical, "the material in the environment and the lights"},
    {"phong", Shading::phong, "k_a c + k_d c (n.l) + k_s (v.r)^e"},
    {"table", Shading::table, "the same, from a table looked up at n.l and v.r"},
    {"matcap", Shading::matcap, "a picture of a ball, looked up by the normal as the eye sees it"},
    {"water", Shading::water, "clear water over a floor; --color is what its depth lets through"},
};

inline constexpr Word<Show> kShows[] = {
    {"shaded", Show::shaded, "the material in light"},
    {"normal", Show::normal, "normals as colors"},
    {"height", Show::height, "heights as colors"},
    {"rate", Show::rate, "segments per edge as colors"},
    {"faces", Show::faces, "each face of the cage in a color of its own"},
    {"wireframe", Show::wireframe, "the edges of the triangles"},
    {"uv", Show::texCoords, "texture coordinates: 8 x 8 fields per unit square, redder with s, greener with t"},
    {"error", Show::error, "how far triangles are from the surface: orange a pixel outside, blue a pixel inside"},
};

inline constexpr Word<Layer> kLayers[] = {
    {"depth", Layer::depth, "distance along the view, cage units"},
    {"normal", Layer::normal, "unit normal in world space, turned towards the eye"},
    {"face", Layer::face, "number of the cage's face, -1 where nothing is seen"},
    {"uv", Layer::uv, "texture coordinates"},
    {"height", Layer::height, "height over the smooth surface, cage units"},
    {"motion", Layer::motion, "pixels since the frame before, x to the right and y down"},
};

} // namespace relief
