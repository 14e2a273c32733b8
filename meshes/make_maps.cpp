// make_maps OUTDIR [NAME...]: writes height maps (NAME.exr, cage units, mid 0) and color maps (NAME_albedo.png, sRGB)
// for the cages of this folder, and an environment (labels_albedo.png), all of them or the named ones. The same bytes
// every time.
#include <exception>
#include <filesystem>
#include <set>

#include "labels.h"
#include "lantern_map.h"
#include "maps_ball.h"
#include "maps_square.h"
#include "octopus_colors.h"
#include "strawberry_skin.h"

namespace {

using namespace relief;
using namespace relief::meshes;

struct Map {
    const char* name;
    ivec2 size;
    Painting (*paint)(const ivec2& size);
};
constexpr Map kMaps[] = {
    {"bricks", {1024, 1024}, paintBricks},   {"golf", {2048, 1024}, paintGolf},
    {"lantern", {1024, 1024}, paintLantern}, {"moon", {2304, 1536}, paintMoon},
    {"globe", {1536, 1024}, paintGlobe},     {"globe_detail", {2304, 1536}, paintGlobeDetail},
    {"octopus", {2048, 2048}, paintOctopus}, {"orange", {1536, 1024}, paintOrange},
    {"smooth", {512, 512}, paintSmooth},     {"strawberry", {2048, 2048}, paintStrawberry},
    {"terrain", {2048, 2048}, paintTerrain}, {"labels", {1024, 768}, paintLabels},
};

void writeMap(const std::string& folder, const Map& map) {
    Painting painting = map.paint(map.size);
    if (!painting.height.texels.empty())
        writeImage(fmt::format("{}/{}.exr", folder, map.name), painting.height, SampleType::real);
    if (!painting.albedo.texels.empty())
        writeImage(fmt::format("{}/{}_albedo.png", folder, map.name), painting.albedo, SampleType::uint8);
}

void writeMaps(const std::string& folder, std::set<std::string> names) {
    std::filesystem::create_directories(folder);
    bool isAll = names.empty();
    for (const Map& map : kMaps)
        if (isAll || names.erase(map.name)) writeMap(folder, map);
    if (names.empty()) return;
    std::vector<std::string> known;
    for (const Map& map : kMaps) known.emplace_back(map.name);
    fail(Failure::usage, "no map is called {}; there are {}", *names.begin(), fmt::join(known, ", "));
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 2) fail(Failure::usage, "usage: make_maps OUTDIR [NAME...]");
        writeMaps(argv[1], {argv + 2, argv + argc});
    } catch (const Error& error) {
        fmt::print(stderr, "make_maps: {}\n", error.what());
        return int(error.failure);
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_maps: {}\n", error.what());
        return int(Failure::internal);
    }
    return 0;
}
