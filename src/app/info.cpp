#include <algorithm>
#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "app/weld.h"
#include "check/check.h"

namespace relief::app {
namespace {

using nlohmann::json;

struct InfoArgs {
    std::vector<std::string> files;
    SurfaceArgs surface; ///< what --height asks of the one cage among the files
    bool listsDevices = false, isJson = false, isQuiet = false;
};

json ofBounds(const Bounds& b) {
    return {{"lower", {b.lower.x, b.lower.y, b.lower.z}},
            {"upper", {b.upper.x, b.upper.y, b.upper.z}},
            {"diagonal", b.diagonal()}};
}

json ofCage(const std::string& path, const std::string& weld, const Warn& warn) {
    const Cage cage = welded(readCage(path, warn), weld);
    checkTexCoords(cage, {}, warn);
    const CageSummary s = summarize(cage);
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
            {"bytes", cage.byteCount()},
            {"bounds", ofBounds(s.bounds)},
            {"parts", parts}};
}

double fractionOf(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// How far the faces along the cage's edges disagree about the map.
json ofSeams(SurfaceArgs args, const std::string& cage, bool isQuiet) {
    args.cage = cage;
    const Loaded loaded = load(args, {.isQuiet = isQuiet});
    const ReferenceSurface reference(loaded.cage, loaded.options);
    const SeamReport seams = reportSeams(loaded.surface, reference, *loaded.height);
    const double unit = loaded.coordinates().unit, reach = loaded.height->heightBound();
    json result{{"map", args.height},
                {"map_reach", unit * reach},
                {"map_seam_edges", seams.seamEdgeCount},
                {"seam_disagreement_max", unit * seams.max},
                {"seam_disagreement_mean", unit * seams.mean},
                {"seam_max_of_reach", fractionOf(seams.max, reach)},
                {"seam_mean_of_reach", fractionOf(seams.mean, reach)}};
    if (seams.max > 0)
        result["seam_disagreement_at"] = {{"face", seams.worst.face}, {"u", seams.worst.uv.x}, {"v", seams.worst.uv.y}};
    return result;
}

/// What each channel holds, counted strip by strip: the picture is never in memory as a whole.
std::vector<HeightCensus> censusOf(const std::string& path, const ImageInfo& info) {
    std::vector<HeightCensus> channels(std::size_t(info.channels), HeightCensus(info));
    readImageRows(path, [&](int, int, std::span<const float> texels) {
        for (std::size_t i = 0; i < texels.size(); i += channels.size())
            for (std::size_t c = 0; c < channels.size(); ++c) channels[c].add(texels[i + c]);
    });
    for (HeightCensus& channel : channels) channel.finish();
    return channels;
}

/// Ranges of heights, voids, and texels that are no numbers.
json ofTexels(const std::string& path, const ImageInfo& info) {
    json ranges = json::array(), voids = json::object(), notFinite = json::object();
    const std::vector<HeightCensus> channels = censusOf(path, info);
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

json ofPicture(const std::string& path) {
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
    if (info.noData) result["no_data"] = fmt::format("{}", *info.noData);
    result.update(ofTexels(path, info));
    return result;
}

json ofDevices() {
    json list = json::array();
    for (const DeviceTraits& t : listDevices())
        list.push_back({{"device", t.name},
                        {"driver", t.driver},
                        {"vulkan", t.api},
                        {"cpu", t.isCpu},
                        {"tessellation_shaders", t.hasTessellation},
                        {"largest_tessellation_level", t.maxTessellationLevel},
                        {"wireframe", t.hasWireframe},
                        {"largest_image_side", t.maxImageSide},
                        {"memory", t.heapBytes},
                        {"times_passes", t.timestampNanoseconds > 0},
                        {"tessellated_vertices_a_draw", t.tessellatedVerticesPerDraw},
                        {"mesh_triangles_in_flight", t.meshTrianglesInFlight}});
    return list;
}

bool isCage(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".obj" || extension == ".gltf" || extension == ".glb";
}

std::string text(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) // far from the origin six digits do not separate places
        return fmt::format("{:.{}g}", value.get<double>(), std::abs(value.get<double>()) < 1e5 ? 6 : 12);
    if (!value.is_structured()) return value.dump();
    std::string joined;
    for (const auto& [key, item] : value.items())
        joined += (joined.empty() ? "" : ", ") + (value.is_object() ? key + " " : "") + text(item);
    return value.is_array() ? "(" + joined + ")" : joined;
}

/// One `name  value` a line, in the JSON's words; what is zero or empty is left out.
void print(const json& object) {
    for (const auto& [key, value] : object.items()) {
        const bool isNothing = (value.is_number() && value.get<double>() == 0 && key != "default_mid") ||
                               (value.is_structured() && value.empty());
        if (isNothing) continue;
        const bool isSize = key == "bytes" || key == "map_bytes" || key == "memory";
        std::string name = key;
        std::ranges::replace(name, '_', ' ');
        std::cout << fmt::format("  {:28} {}\n", name,
                                 isSize ? humanBytes(value.get<std::uint64_t>()) : onOneLine(text(value)));
    }
}

void checkUsage(const InfoArgs& args) {
    if (args.files.empty() && !args.listsDevices) fail(Failure::usage, "info wants files, or --devices");
    if (!args.surface.height.empty() && std::ranges::count_if(args.files, isCage) != 1)
        fail(Failure::usage, "--height {}: name the one cage that the map is for", args.surface.height);
}

int info(const InfoArgs& args) {
    checkUsage(args);
    const bool hasMap = !args.surface.height.empty();
    // With a map the cage is read a second time, and warned of then.
    const Warn warn = args.isQuiet || hasMap ? Warn([](const std::string&) {}) : Warn(warnOnStderr);
    json all = json::array();
    for (const std::string& file : args.files) {
        all.push_back(isCage(file) ? ofCage(file, args.surface.weld, warn) : ofPicture(file));
        if (isCage(file) && hasMap) all.back().update(ofSeams(args.surface, file, args.isQuiet));
    }
    if (args.listsDevices)
        for (json& device : ofDevices()) all.push_back(std::move(device));
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
    app.add_option("files", args->files, "cages (.obj .gltf .glb), height maps, pictures")->option_text("FILE...");
    addSurfaceOptions(app, args->surface);
    app.add_flag("--devices", args->listsDevices, "the Vulkan devices of this machine");
    app.add_flag("--json", args->isJson, "print as JSON on stdout");
    app.add_flag("-q,--quiet", args->isQuiet, "no warnings");
    app.footer(
        "With --height, a cage is told with how far the two sides of its texture's seams disagree about that map.\n"
        "examples:\n"
        "  relief info cage.obj heights.exr\n"
        "  relief info cage.obj --height heights.exr --scale 0.2\n"
        "  relief info --devices");
    return [args] { return info(*args); };
}

} // namespace relief::app
