// What is wrong with a height map on a cage, before anything is rendered: faults of its values, of its layout and of
// the surface that it makes, each with its figure and a remedy; and what other renderers need for the same look.
#pragma once

#include "check/check.h"

namespace relief {

// --- findings -----------------------------------------------------------------------------------------------------

enum class FindingKind {
    midlevel,
    sign,
    bitDepth,
    colors,
    scale,
    voids,
    channel,
    flip,
    axes,
    seam,
    outside,
    island,
    stretch,
    fold,
};

inline constexpr Word<FindingKind> kFindingKinds[] = {
    {"midlevel", FindingKind::midlevel, "the stored height of the undisplaced surface is another one than --mid"},
    {"sign", FindingKind::sign, "heights point inwards, or negative numbers are read as large ones"},
    {"bit-depth", FindingKind::bitDepth, "heights have fewer steps than the file could hold"},
    {"colors", FindingKind::colors, "heights are encoded as colors, or marked as such"},
    {"scale", FindingKind::scale, "nothing says how large a height is"},
    {"voids", FindingKind::voids, "texels without a height"},
    {"channel", FindingKind::channel, "the file has several layers, and none is named"},
    {"flip", FindingKind::flip, "the map is mirrored or turned against the texture coordinates"},
    {"axes", FindingKind::axes, "the channels of a vector map are in another order than is said"},
    {"seam", FindingKind::seam, "the two sides of a seam have different heights"},
    {"outside", FindingKind::outside, "texture coordinates leave the map, or the tiles of a set"},
    {"island", FindingKind::island, "a part of the layout has no heights"},
    {"stretch", FindingKind::stretch, "texels are much longer on the surface than others"},
    {"fold", FindingKind::fold, "heights fold the surface over itself"},
};

/// One finding of a map.
struct Finding {
    FindingKind kind{};
    bool isFault = true; ///< else something to know, which may be meant
    std::string text;    ///< what was found, with its figure
    std::string advice;  ///< what to do
    double figure = 0;   ///< the number that stands for it in `text`
    std::optional<SurfaceLocation> at{};
};

// --- the surface in texture space -----------------------------------------------------------------------------------

/// A small piece of a face, a quad or a triangle of its (u,v) domain.
struct LayoutCell {
    SurfaceLocation at;           ///< its centre
    double area = 0;              ///< on the limit surface, in units of positions
    std::array<dvec2, 4> corners; ///< texture coordinates
    dvec2 st{0};                  ///< of the centre
    glm::dmat2x3 tangents{0};     ///< p_s and p_t; infinite where the texture coordinates span no area
    std::optional<Curvatures> curvature{};
    std::uint32_t island = 0;
};

/// The limit surface cut into cells, and the islands that its faces form in texture space.
struct SurfaceLayout {
    std::vector<LayoutCell> cells;
    std::vector<std::uint32_t> islandFaces; ///< per island: number of faces
    bool hasTexCoords = false;
    dvec2 lower{0}, upper{0}; ///< box of the texture coordinates
};

/// Cuts all drawn faces into cells, some 20,000 in all, and at least 4 per face.
SurfaceLayout makeLayout(const Surface& surface, const ReferenceSurface& reference);

// --- examination ----------------------------------------------------------------------------------------------------

/// What maps are examined on. All of it has to outlive the examination.
struct DoctorSubject {
    const Surface* surface = nullptr;
    const ReferenceSurface* reference = nullptr;
    const SurfaceLayout* layout = nullptr;
    double unit = 1;            ///< cage units per unit of positions
    std::uint64_t topology = 0; ///< hashTopology() of the cage: maps per face of other cages are refused
};

/// A map and what is wrong with it.
struct Examination {
    std::string path;
    Scheme scheme = Scheme::catmark;     ///< of the cage
    HeightMap map;                       ///< in the unit of positions; of vectors their lengths
    std::string vectorOrder, vectorFlip; ///< of a vector map: VectorOptions' order and flip
    double bound = 0;                    ///< largest |h|, cage units
    std::vector<Finding> findings;       ///< in the order of FindingKind
    SeamReport seams;                    ///< in the unit of positions

    [[nodiscard]] bool isHealthy() const;
};

struct DoctorOptions {
    HeightOptions height;
    std::optional<VectorOptions> vectors{}; ///< maps are vector maps of this space, order and flips, else height maps
    bool namesWrap = false; ///< the user has said how the map continues: coordinates outside of it are meant
};

/// Reads a map and examines its values, its layout on the surface and the surface that it makes. Of vector maps these
/// are the midlevels of the components, their order, and seams, islands and folds by the lengths of the vectors. Of a
/// set of tiles each file is examined as a map of its own, but of vectors the first header and all values; of a map per
/// face values and folds are, for it has no layout. Throws as loadHeightMap and loadVectorMap do, and Failure::input
/// for a map per face of another cage.
Examination examineMap(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject);

/// Draws the layout over the heights: folds red, stretched texels orange, empty islands blue, seams whose sides
/// disagree magenta. `side`: width and height, pixels.
Image drawFindings(const Examination& examination, const DoctorSubject& subject, int side);

// --- other renderers ------------------------------------------------------------------------------------------------

/// One parameter of another renderer, and its value as the user types it.
struct RendererSetting {
    std::string renderer, name, value;
};

/// What Blender, Arnold and RenderMan need to displace the same cage by the same map to the same surface, or that they
/// lack the scheme of subdivision. Lengths are in cage units.
std::vector<RendererSetting> listRendererSettings(const Examination& examination, double unit);

} // namespace relief
