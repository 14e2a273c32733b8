#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "bake/bake.h"
#include "scene/scene.h"

namespace relief::app {
namespace {

constexpr int kMostSegments = 4096;

/// relief map: a map per face of one over texture coordinates, and back.
struct ConversionArgs {
    ObjectDesc object;
    std::string target;
    std::optional<int> segments;
    ivec2 size{1024, 1024};
    bool isJson = false, isQuiet = false;
};

/// Segments of a face that are as fine as the texels of a map under it, as powers of two.
ivec2 chooseSegments(const ReferenceSurface& reference, int face, const ivec2& texels) {
    constexpr int kSteps = 8;
    dvec2 lengths(0); // along u and v in texels, the longest of three lines
    for (int line = 0; line <= 2; ++line)
        for (int axis = 0; axis < 2; ++axis) {
            double length = 0;
            dvec2 last(0);
            for (int k = 0; k <= kSteps; ++k) {
                const double x = double(k) / kSteps, y = 0.5 * line;
                const dvec2 at = reference.texture(face, axis == 0 ? dvec2(x, y) : dvec2(y, x)).st * dvec2(texels);
                if (k > 0) length += glm::length(at - last);
                last = at;
            }
            lengths[axis] = std::max(lengths[axis], length);
        }
    const double most = std::log2(kMostSegments);
    return ivec2(glm::clamp(glm::ceil(glm::log2(glm::max(lengths, 1.0)) - 1e-6), 0.0, most));
}

HeightMap makeFaces(const LoadedObject& object, const std::optional<int>& asked) {
    const ReferenceSurface reference(object.cage, object.options);
    const HeightMap& map = *object.height;
    std::vector<ivec2> segments;
    for (int face = 0; face < int(object.surface.faces.size()); ++face)
        segments.push_back(reference.isHole(face) ? ivec2(0)
                           : asked                ? ivec2(int(std::lround(std::log2(*asked))))
                                                  : chooseSegments(reference, face, {map.width, map.height}));
    const double unit = object.coordinates().unit;
    HeightMap faces = makeFaceMap(object.surface, segments, [&](int face, const dvec2& uv) {
        return unit * sampleHeight(map, {.face = face, .uv = uv, .st = reference.texture(face, uv).st}).h;
    });
    faces.topology = hashTopology(object.cage);
    return faces;
}

Image makePicture(const LoadedObject& object, const std::string& cage, const ivec2& size) {
    if (!object.cage.hasTexCoords())
        fail(Failure::input, "{}: there are no texture coordinates, which a map over them needs", cage);
    if (std::ranges::any_of(object.cage.faceSizes, [](std::uint32_t corners) { return corners != 4; }))
        fail(Failure::input, "{}: maps over texture coordinates are painted for cages of quads", cage);
    Image image{.width = size.x, .height = size.y, .channels = 1, .texels = {}};
    image.texels.assign(std::size_t(size.x) * std::size_t(size.y), 0.0f);
    Atlas atlas(object.cage, size.x, size.y);
    const double unit = object.coordinates().unit;
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) {
        *image.at(x, y) = float(unit * sampleHeight(*object.height, {.face = point.face, .uv = point.uv}).h);
    });
    atlas.spread(image);
    return image;
}

int convertMap(const ConversionArgs& args) {
    if (lowerExtension(args.target) != ".exr")
        fail(Failure::usage, "{}: the map is written as .exr: heights are floats in cage units", args.target);
    if (args.segments && !std::has_single_bit(unsigned(*args.segments)))
        fail(Failure::usage, "--segments {}: a face has 1, 2, 4, ... {} segments per side", *args.segments,
             kMostSegments);
    checkOutput(args.target, listFiles(args.object));
    // The object carries the map in the addressing of its file, which decides the direction.
    const LoadedObject object = load(args.object, CageState::posed, makeWarn(args.isQuiet));
    if (object.dense)
        fail(Failure::usage, "{}: maps per face are for subdivision surfaces; name its --scheme", args.object.cage);
    if (object.height->addressing == Addressing::faces) {
        const Image image = makePicture(object, args.object.cage, args.size);
        writeImage(args.target, image, SampleType::real);
        if (args.isJson)
            printJson({{"output", args.target}, {"kind", "texture"}, {"width", image.width}, {"height", image.height}});
        else if (!args.isQuiet)
            std::cerr << fmt::format("{}: {} x {} heights over texture coordinates\n", args.target, image.width,
                                     image.height);
        return 0;
    }
    // From texture coordinates to faces.
    const HeightMap faces = makeFaces(object, args.segments);
    saveFaceMap(args.target, faces);
    const std::size_t nodes = [&] {
        std::size_t sum = 0;
        for (const MapTile& tile : faces.tiles) sum += std::size_t(tile.size.x) * std::size_t(tile.size.y);
        return sum;
    }();
    if (args.isJson)
        printJson({{"output", args.target},
                   {"kind", "faces"},
                   {"faces", faces.tiles.size()},
                   {"heights", nodes},
                   {"topology", fmt::format("{:016x}", faces.topology)}});
    else if (!args.isQuiet)
        std::cerr << fmt::format("{}: {} heights on {} faces, up to {} x {} on one\n", args.target, nodes,
                                 faces.tiles.size(), faces.width, faces.height);
    return 0;
}

} // namespace

Run addMap(CLI::App& app) {
    auto args = std::make_shared<ConversionArgs>();
    app.add_option("cage", args->object.cage, "control cage: .obj .gltf .glb")->required()->option_text("CAGE");
    app.add_option("map", args->object.height.path,
                   "height map over texture coordinates, set of tiles, or map per face of this cage")
        ->required()
        ->option_text("IN");
    app.add_option("-o,--output", args->target, "the other kind of map: .exr with heights in cage units")
        ->required()
        ->option_text("OUT");
    listIn("map", "N",
           app.add_option("--segments", args->segments,
                          "per face: segments along each side, a power of two (default: as fine as the texels)")
               ->check(CLI::Range(1, kMostSegments)));
    listIn("map", "W,H",
           addVector<ivec2>(app, "--size", args->size, "over texture coordinates: texels (default: 1024,1024)")
               ->check(numberIn(1, 16384)));
    addSurface(app, args->object);
    addHeightValues(app, args->object.height);
    app.add_flag("--json", args->isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args->isQuiet, "print no warnings and no summary")->group("output");
    app.footer(
        "A map per face needs no texture coordinates: --height takes it as any map. It fits the cage that it was\n"
        "made for alone.\n"
        "examples:\n"
        "  relief map cage.obj heights.exr -o faces.exr\n"
        "  relief map cage.obj faces.exr -o heights.exr --size 4096,4096");
    return [args] { return convertMap(*args); };
}

} // namespace relief::app
