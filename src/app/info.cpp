#include <algorithm>
#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/output.h"
#include "check/check.h"
#include "geometry_image/geometry_image.h"

namespace relief::app {
namespace {

using nlohmann::json;

struct InfoArgs {
    std::vector<std::string> files;
    ObjectDesc object; ///< options of the cages; with --height there is one of them
    bool listsDevices = false, isJson = false, isQuiet = false;
};

json boundsToJson(const Bounds& b) {
    return {{"lower", {b.lower.x, b.lower.y, b.lower.z}},
            {"upper", {b.upper.x, b.upper.y, b.upper.z}},
            {"diagonal", b.diagonal()}};
}

/// Faces where the surface that the options ask for is not the limit surface.
std::size_t countApproximateFaces(const ObjectDesc& desc, const Cage& cage) {
    const std::optional<SurfaceOptions> options = chooseSurface(desc, cage);
    return options ? listApproximateFaces(cage, *options).size() : 0;
}

json describeCage(const std::string& path, const ObjectDesc& desc, const Warn& warn) {
    const Cage cage = weldCage(readCage(path, warn), desc.weld);
    checkTexCoords(cage, {}, warn);
    const CageSummary s = summarize(cage);
    // Named parts apart from the counts, which are of the whole cage.
    json parts = json::array();
    for (const CagePart& part : cage.parts)
        parts.push_back({{"name", part.name}, {"material", part.material}, {"faces", part.faceCount}});
    return {{"file", path},
            {"kind", "cage"},
            {"vertices", s.vertexCount},
            {"faces", s.faceCount},
            {"edges", s.edgeCount},
            {"triangles", s.triangleCount},
            {"quads", s.quadCount},
            {"n_gons", s.otherFaceCount},
            {"boundary_edges", s.boundaryEdgeCount},
            {"non_manifold_edges", s.nonManifoldEdgeCount},
            {"extraordinary_vertices", s.irregularVertexCount},
            {"max_valence", s.maxValence},
            {"unused_vertices", s.unusedVertexCount},
            {"coincident_boundary_vertices", countCoincidentVertices(cage)},
            {"creased_edges", s.creasedEdgeCount},
            {"sharp_vertices", s.sharpVertexCount},
            {"holes", s.holeCount},
            {"texture_coordinates", s.texCoordCount},
            {"seam_edges", s.seamEdgeCount},
            {"approximate_faces", countApproximateFaces(desc, cage)},
            {"bytes", cage.byteCount()},
            {"bounds", boundsToJson(s.bounds)},
            {"parts", parts}};
}

double toFraction(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// How far the heights of the two faces along the cage's edges differ.
json seamsToJson(const SeamReport& seams, double displacementBound, double unit) {
    json result{{"displacement_bound", unit * displacementBound},
                {"map_seam_edges", seams.seamEdgeCount},
                {"seam_disagreement_max", unit * seams.max},
                {"seam_disagreement_mean", unit * seams.mean},
                {"seam_max_of_displacement_bound", toFraction(seams.max, displacementBound)},
                {"seam_mean_of_displacement_bound", toFraction(seams.mean, displacementBound)}};
    if (seams.max > 0)
        result["seam_disagreement_at"] = {{"face", seams.worst.face}, {"u", seams.worst.uv.x}, {"v", seams.worst.uv.y}};
    return result;
}

/// What a map, or a function at the time 0, makes of a cage's surface.
json describeHeights(ObjectDesc desc, const std::string& cage, bool isQuiet) {
    desc.cage = cage;
    const Warn warn = makeWarn(isQuiet);
    LoadedObject object = load(desc, CageState::posed, warn);
    const ReferenceSurface reference(object.cage, object.options);
    const double unit = object.coordinates().unit;
    json result;
    if (object.function) {
        Device device;
        measureFunction(device, object, desc.height, {{object.time}}, warn);
        FunctionReference function(device, *object.function, reference, object.time);
        result = seamsToJson(reportSeams(object.surface, reference, function), object.function->bound, unit);
        result["height_function"] = desc.height.function;
        return result;
    }
    result = seamsToJson(reportSeams(object.surface, reference, *object.height), object.height->heightBound(), unit);
    result["map"] = desc.height.path;
    return result;
}

/// Counts what each channel holds, strip by strip: the picture is never in memory as a whole.
std::vector<HeightCensus> takeCensus(const std::string& path, const ImageInfo& info) {
    // What a PNG names is a grey: its reader adds the alpha, which is none.
    ImageInfo other = info;
    if (info.format == "png") other.noData.reset();
    std::vector<HeightCensus> channels(std::size_t(info.channels), HeightCensus(other));
    channels.front() = HeightCensus(info);
    readImageRows(path, [&](int, int, std::span<const float> texels) {
        for (std::size_t i = 0; i < texels.size(); i += channels.size())
            for (std::size_t c = 0; c < channels.size(); ++c) channels[c].add(texels[i + c]);
    });
    for (HeightCensus& channel : channels) channel.finish();
    return channels;
}

/// The range of values of each channel, its voids, and its texels that are not finite.
json describeTexels(const std::string& path, const ImageInfo& info) {
    json ranges = json::array(), voids = json::object(), notFinite = json::object();
    const std::vector<HeightCensus> channels = takeCensus(path, info);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const HeightCensus& channel = channels[c];
        const std::string& name = info.channelNames[c];
        const bool isEmpty = channel.lowest() > channel.highest();
        ranges.push_back(isEmpty ? json::array() : json{channel.lowest(), channel.highest()});
        if (channel.voidCount() > 0) voids[name] = {{"count", channel.voidCount()}, {"value", channel.voidReason()}};
        if (channel.notFiniteCount() == 0) continue;
        const std::uint64_t first = channel.firstNotFinite(), width = std::uint64_t(info.width);
        notFinite[name] = {{"count", channel.notFiniteCount()},
                           {"first", {{"column", first % width}, {"row", first / width}}}};
    }
    return {{"ranges", ranges}, {"voids", voids}, {"not_finite", notFinite}};
}

/// The files of a set of tiles.
json describeTiles(const std::string& path) {
    const TilePattern pattern = *findTilePattern(path);
    json tiles = json::array(), names = json::array();
    std::uint64_t bytes = 0;
    for (const TileFile& file : listTiles(path)) {
        const ImageInfo info = readImageInfo(file.path);
        const MapFormat format = fileFormat(info);
        bytes += mapBytes(format, info.width, info.height);
        names.push_back(nameTile(pattern, file.place));
        tiles.push_back({{"tile", names.back()},
                         {"file", file.path},
                         {"width", info.width},
                         {"height", info.height},
                         {"sample", info.sample},
                         {"channels", info.channelNames}});
    }
    return {
        {"file", path}, {"kind", "set of tiles"}, {"tile_count", tiles.size()}, {"tiles", tiles}, {"map_bytes", bytes}};
}

/// What the header of a map per face says.
json describeFaces(const ImageInfo& info, const std::string& path) {
    const FaceMapInfo faces = readFaceMapInfo(info, path);
    ivec2 lowest(faces.segments.front()), highest(lowest);
    std::uint64_t heights = 0;
    for (const ivec2& segments : faces.segments) {
        lowest = glm::min(lowest, segments), highest = glm::max(highest, segments);
        heights += std::uint64_t((1 << segments.x) + 1) * std::uint64_t((1 << segments.y) + 1);
    }
    return {{"map_per_face", true},
            {"map_faces", faces.segments.size()},
            {"map_heights", heights},
            {"map_segments_per_side", {1 << std::min(lowest.x, lowest.y), 1 << std::max(highest.x, highest.y)}},
            {"map_topology", fmt::format("{:016x}", faces.topology)}};
}

/// What the header of a geometry image says, and how its meshes are.
json describeGeometryImage(const std::string& path) {
    const GeometryImage image = readGeometryImage(path);
    json vertices = json::array(), openEdges = json::array();
    for (int mip = 0; mip < image.mipCount(); ++mip) {
        const DenseMesh mesh = toMesh(image, mip);
        vertices.push_back(mesh.positions.size());
        openEdges.push_back(findFaults(mesh.indices).openEdges);
    }
    return {{"geometry_image", true},
            {"geometry_image_mips", image.mipCount()},
            {"geometry_image_paths", image.sewing.paths.size()},
            {"mesh_vertices", vertices},
            {"mesh_open_edges", openEdges},
            {"bounds", boundsToJson(image.coordinates.toWorld(computeBounds(image.positions)))}};
}

json describePicture(const std::string& path) {
    if (findTilePattern(path)) return describeTiles(path);
    const ImageInfo info = readImageInfo(path);
    const MapFormat format = fileFormat(info);
    const std::vector<std::string> layers = layersOf(info);
    json result{{"file", path},
                {"kind", "picture"},
                {"format", info.format},
                {"width", info.width},
                {"height", info.height},
                {"sample", info.sample},
                {"channels", info.channelNames},
                {"layers", layers.size() > 1 ? json(layers) : json::array()},
                {"bytes", std::uint64_t(info.width) * info.height * info.channels * info.sampleBytes},
                {"default_mid", info.hasUnit() ? 0.0 : 0.5},
                {"map_format", wordOf(kMapFormats, format)},
                {"map_bytes", mapBytes(format, info.width, info.height)}};
    if (isGeometryImage(info)) result.update(describeGeometryImage(path));
    if (isFaceMap(info)) result.update(describeFaces(info, path));
    if (info.noData) result["no_data"] = fmt::format("{}", *info.noData);
    result.update(describeTexels(path, info));
    return result;
}

/// A number of which the largest stands for no limit: null then.
json toLimit(std::uint32_t value) { return value == 0xffffffffu ? json() : json(value); }

json describeDevices() {
    json list = json::array();
    for (const DeviceTraits& t : listDevices()) {
        const PathChoice choice = choosePath(t);
        list.push_back({{"device", t.name},
                        {"driver", t.driver},
                        {"vulkan", t.api},
                        {"cpu", t.isCpu},
                        {"default_path", wordOf(kPaths, choice.path)},
                        {"default_path_reason", choice.reason},
                        {"reads_tables_as", describeTableReads(t)},
                        {"limits", listLimits(t)},
                        {"tessellation_shaders", t.hasTessellation},
                        {"largest_tessellation_level", t.maxTessellationLevel},
                        {"wireframe", t.hasWireframe},
                        {"largest_image_side", t.maxImageSide},
                        {"memory", t.heapBytes},
                        {"times_passes", t.timestampNanoseconds > 0},
                        {"tessellated_vertices_per_draw", toLimit(t.tessellatedVerticesPerDraw)},
                        {"mesh_triangles_in_flight", toLimit(t.meshTrianglesInFlight)}});
    }
    return list;
}

bool isCage(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".obj" || extension == ".gltf" || extension == ".glb";
}

std::string formatValue(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) // far from the origin six digits do not separate positions
        return fmt::format("{:.{}g}", value.get<double>(), std::abs(value.get<double>()) < 1e5 ? 6 : 12);
    if (!value.is_structured()) return value.dump();
    std::string joined;
    for (const auto& [key, item] : value.items())
        joined += (joined.empty() ? "" : ", ") + (value.is_object() ? key + " " : "") + formatValue(item);
    return value.is_array() ? "(" + joined + ")" : joined;
}

bool isEmpty(const std::string& key, const json& value) {
    const bool isZero = value.is_number() && value.get<double>() == 0 && key != "default_mid";
    return value.is_null() || isZero || (value.is_structured() && value.empty());
}

constexpr int kNameColumns = 32; ///< as wide as the longest name that reports have

void printRow(std::string name, const std::string& text) {
    std::ranges::replace(name, '_', ' ');
    std::cout << fmt::format("  {:{}} {}\n", name, kNameColumns, onOneLine(text));
}

/// Prints one `name  value` per line, in the JSON's words, and one line per limit. Zeros and what is empty are omitted.
void print(const json& object) {
    for (const auto& [key, value] : object.items()) {
        if (isEmpty(key, value)) continue;
        const bool isSize = key == "bytes" || key == "map_bytes" || key == "memory";
        if (isSize)
            printRow(key, humanBytes(value.get<std::uint64_t>()));
        else if (key == "limits")
            for (const json& limit : value) printRow(limit == value.front() ? key : "", limit.get<std::string>());
        else
            printRow(key, formatValue(value));
    }
}

bool hasHeights(const InfoArgs& args) {
    return !args.object.height.path.empty() || !args.object.height.function.empty();
}

void checkUsage(const InfoArgs& args) {
    if (args.files.empty() && !args.listsDevices) fail(Failure::usage, "info needs files, or --devices");
    const HeightDesc& height = args.object.height;
    if (!hasHeights(args) || std::ranges::count_if(args.files, isCage) == 1) return;
    if (!height.path.empty())
        fail(Failure::usage, "--{} {}: name the one cage that the map is for", height.vectors ? "vector" : "height",
             height.path);
    fail(Failure::usage, "--height-function {}: name the one cage that the function is for", height.function);
}

int info(const InfoArgs& args) {
    checkUsage(args);
    // With heights the cage is read a second time, and its warnings are printed then.
    const Warn warn = makeWarn(args.isQuiet || hasHeights(args));
    json all = json::array();
    for (const std::string& file : args.files) {
        all.push_back(isCage(file) ? describeCage(file, args.object, warn) : describePicture(file));
        if (isCage(file) && hasHeights(args)) all.back().update(describeHeights(args.object, file, args.isQuiet));
    }
    if (args.listsDevices)
        for (json& device : describeDevices()) all.push_back(std::move(device));
    if (args.isJson) {
        printJson(all);
        return 0;
    }
    for (const json& object : all) {
        const char* title = object.contains("file") ? "file" : "device";
        std::cout << onOneLine(object[title].get<std::string>()) << '\n';
        json rest = object;
        rest.erase(title);
        print(rest);
    }
    return 0;
}

} // namespace

Run addInfo(CLI::App& app) {
    auto args = std::make_shared<InfoArgs>();
    app.add_option("files", args->files, "cages (.obj .gltf .glb), height maps and other pictures")
        ->option_text("FILE...");
    addHeightedSurface(app, args->object);
    app.add_flag("--devices", args->listsDevices,
                 "list the Vulkan devices of this machine: the default --path on each, and what each cannot do");
    app.add_flag("--json", args->isJson, "print JSON on stdout");
    app.add_flag("-q,--quiet", args->isQuiet, "print no warnings");
    app.footer(
        "With --height, --vector or --height-function, the report of a cage says how far the heights on the two\n"
        "sides of its edges differ.\n"
        "examples:\n"
        "  relief info cage.obj heights.exr\n"
        "  relief info cage.obj --height heights.exr --scale 0.2\n"
        "  relief info cage.obj --height-function golf\n"
        "  relief info --devices");
    return [args] { return info(*args); };
}

} // namespace relief::app
