#include "app/light_options.h"

#include <algorithm>

#include "app/options.h"

namespace relief::app {
namespace {

constexpr const char* kGroup = "shading";

/// The word of --environment-shape that leaves it to the picture.
constexpr const char* kAutomatic = "auto";

/// Numbers with commas between them; none where one is no number up to 1e12.
std::vector<double> parseNumbers(const std::string& word) {
    std::vector<double> numbers;
    for (const std::string& part : CLI::detail::split(word, ',')) {
        double value = 0;
        if (!CLI::detail::lexical_cast(part, value) || !(std::abs(value) <= 1e12)) return {};
        numbers.push_back(value);
    }
    return numbers;
}

/// Reads a floor such as "0.5,0.6,0.5,0.4,0.25"; empty where the word is none.
std::optional<WaterFloor> parseWaterFloor(const std::string& word) {
    const std::vector<double> numbers = parseNumbers(word);
    const std::size_t count = numbers.size();
    if ((count != 1 && count != 4 && count != 5) || !(numbers[0] > 0)) return {};
    WaterFloor floor{.depth = numbers[0]};
    for (std::size_t i = 1; i < count; ++i)
        if (numbers[i] < 0 || (i < 4 && numbers[i] > 1)) return {};
    if (count > 3) floor.color = vec3(numbers[1], numbers[2], numbers[3]);
    if (count > 4) floor.tile = numbers[4];
    return floor;
}

void addWaterFloor(CLI::App& app, WaterFloor& floor) {
    const auto check = [](const std::string& word) {
        return parseWaterFloor(word) ? std::string()
                                     : fmt::format("{} is not a floor: DEPTH, DEPTH,R,G,B or DEPTH,R,G,B,TILE", word);
    };
    CLI::Option* option = app.add_option_function<std::string>(
        "--water-floor", [&floor](const std::string& word) { floor = *parseWaterFloor(word); },
        fmt::format(
            "--shading water: depth of the floor below the lowest point of the cage, its linear albedo 0..1, and "
            "the side of light and dark tiles on it, in cage units (default: {},{:.2f},{:.2f},{:.2f}, no tiles)",
            floor.depth, floor.color.x, floor.color.y, floor.color.z));
    listIn(kGroup, "D[,R,G,B[,T]]", option->check(CLI::Validator(check, "")));
}

void addLights(CLI::App& app, LightingDesc& lighting) {
    const auto check = [](const std::string& word) {
        return parseLight(word) ? std::string()
                                : fmt::format("{} is not a light: AZ,EL, AZ,EL,STRENGTH or AZ,EL,STRENGTH,R,G,B", word);
    };
    // The first light is the key light; others have the strength and the color that their own defaults give.
    const auto set = [&lighting](const std::vector<std::string>& words) {
        lighting.others.clear();
        for (std::size_t i = 0; i < words.size(); ++i) {
            const LightWord light = *parseLight(words[i]);
            if (i == 0)
                lighting.key = light.direction, lighting.keyStrength = light.strength, lighting.keyColor = light.color;
            else
                lighting.others.push_back({.azimuth = light.direction.x,
                                           .elevation = light.direction.y,
                                           .strength = light.strength.value_or(DistantLight().strength),
                                           .color = light.color.value_or(DistantLight().color)});
        }
    };
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        "--light", set,
        fmt::format("azimuth and elevation of a light in degrees, its strength and its linear color. The first one is "
                    "the key light (default: {} from the camera's azimuth,{},{}), each further one is added (default "
                    "strength: {}, white)",
                    Lighting().keyAzimuth - CameraOptions().azimuth, Lighting().keyElevation, Lighting().keyStrength,
                    DistantLight().strength));
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->check(CLI::Validator(check, ""));
    option->allow_extra_args(false); // else a cage that follows would be taken for one more light
    listIn(kGroup, "AZ,EL[,S[,R,G,B]]", option);
}

} // namespace

std::optional<LightWord> parseLight(const std::string& word) {
    const std::vector<double> numbers = parseNumbers(word);
    const std::size_t count = numbers.size();
    if (count != 2 && count != 3 && count != 6) return {};
    if (!std::ranges::all_of(numbers.begin() + 2, numbers.end(), [](double x) { return x >= 0; })) return {};
    LightWord light{.direction = {numbers[0], numbers[1]}, .strength = {}, .color = {}};
    if (count > 2) light.strength = numbers[2];
    if (count > 3) light.color = vec3(numbers[3], numbers[4], numbers[5]);
    return light;
}

void addReflection(CLI::App& app, MaterialDesc& material) {
    listIn(kGroup, "R",
           app.add_option("--roughness", material.roughness,
                          fmt::format("roughness of the surface, 0..1; below 0.05 a mirror, as with --metallic 0 "
                                      "(default: {:.2g})",
                                      material.roughness))
               ->check(numberIn(0, 1)));
    listIn(kGroup, "M",
           app.add_option("--metallic", material.metallic,
                          "0 a dielectric .. 1 a metal. The material then conserves energy: what it reflects, also "
                          "between its facets, is what it does not scatter")
               ->check(numberIn(0, 1)));
}

void addEnvironmentShape(CLI::App& app, std::optional<EnvironmentShape>& shape) {
    std::vector<WordHelp> words = listWords(kEnvironmentShapes);
    words.push_back({kAutomatic, "what the sides of the picture say"});
    const auto set = [&shape](const std::string& word) {
        shape.reset();
        for (const Word<EnvironmentShape>& row : kEnvironmentShapes)
            if (word == row.word) shape = row.value;
    };
    listIn(kGroup, "SHAPE",
           app.add_option_function<std::string>(
                  "--environment-shape", set,
                  describeWords(fmt::format("what the picture of an environment is (default: {})", kAutomatic), words))
               ->check(oneOf(words)));
}

void addLighting(CLI::App& app, LightingDesc& lighting) {
    listIn(kGroup, "HDR",
           app.add_option("--environment", lighting.environment,
                          "environment light: .hdr .exr .png; six files where the name has {face} (default: a neutral "
                          "studio)"));
    addEnvironmentShape(app, lighting.shape);
    listIn(
        kGroup, "A",
        app.add_option("--environment-azimuth", lighting.environmentAzimuth,
                       "degrees that the environment is turned by about Y, in the direction of --azimuth (default: 0)")
            ->check(anyCoordinate()));
    addLights(app, lighting);
    const auto setShadows = [&lighting](std::int64_t) { lighting.castsShadows = false; };
    app.add_flag_function("--no-shadows", setShadows, "the lights cast no shadows")->group(kGroup);
    CLI::Option* occlusion = app.add_option(
        "--occlusion", lighting.occlusionRadius,
        "how far away the surface hides the environment from itself, as a share of the object's size, 0..1: 0.1 "
        "darkens creases (default: 0, nothing does)");
    listIn(kGroup, "SHARE", occlusion->check(numberIn(0, 1)));
}

void addPhong(CLI::App& app, PhongCoefficients& phong) {
    const auto set = [&phong](const std::vector<double>& k) {
        phong = {.ambient = float(k[0]), .diffuse = float(k[1]), .specular = float(k[2]), .exponent = float(k[3])};
    };
    CLI::Option* option = app.add_option_function<std::vector<double>>(
        "--phong", set,
        fmt::format("k_a, k_d, k_s and e of --shading phong and table (default: {},{},{},{})", phong.ambient,
                    phong.diffuse, phong.specular, phong.exponent));
    option->delimiter(',')->expected(4)->allow_extra_args(false)->check(numberIn(0, 1e4));
    listIn(kGroup, "KA,KD,KS,E", option);
}

void addShading(CLI::App& app, ShadingDesc& shading) {
    listIn(kGroup, "SHADING", addEnum(app, "--shading", shading.shading, kShadings, "how surfaces shade"));
    addPhong(app, shading.phong);
    const auto setVertices = [&shading](const std::string& word) { shading.tableAtVertices = word == "vertices"; };
    const WordHelp words[] = {{"pixels", "of every pixel"},
                              {"vertices", "of vertices, and interpolated: highlights between them are missed"}};
    listIn(kGroup, "WHERE",
           app.add_option_function<std::string>(
                  "--table-at", setVertices,
                  describeWords("--shading table: where n.l and v.r are computed (default: pixels)", words))
               ->check(oneOf(words)));
    addWaterFloor(app, shading.waterFloor);
    listIn(kGroup, "BALL",
           app.add_option("--matcap", shading.matcap,
                          "picture of a ball for --shading matcap (default: of the object's own material and lights)"));
}

} // namespace relief::app
