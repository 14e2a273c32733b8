// The golden pictures: what they show, small changes that must not pass for them, and how one is drawn and compared.
#pragma once

#include <map>
#include <optional>

#include "comparison.h"
#include "scenes.h"

namespace relief::test {

/// A picture of the command line, committed as NAME.png.
struct Golden {
    const char* name;
    const char* words; ///< see SceneFolder::render
};

inline void PrintTo(const Golden& golden, std::ostream* stream) { *stream << golden.name; }

// White behind most: the studio's noise does not compress. Uniform and adaptive rates, both paths, every kind of cage.
inline constexpr Golden kGoldens[] = {
    {"cube_creases_tessellation", "^cube --rate 32 --azimuth 35 --elevation 25 --background 1,1,1 --path tessellation"},
    {"cube_creases_grid", "^cube --rate 32 --azimuth 35 --elevation 25 --background 1,1,1 --path grid"},
    {"torus_waves_tessellation",
     "^torus --height @waves.exr --scale 0.06 --rate 12 --elevation 35 --background 1,1,1 --path tessellation"},
    {"torus_waves_grid",
     "^torus --height @waves.exr --scale 0.06 --rate 12 --elevation 35 --background 1,1,1 --path grid"},
    {"lantern_tessellation",
     "^lantern --edge-pixels 4 --azimuth 20 --elevation 18 --background 1,1,1 --path tessellation"},
    {"lantern_grid", "^lantern --edge-pixels 4 --azimuth 20 --elevation 18 --background 1,1,1 --path grid"},
    {"octahedron_loop_tessellation",
     "@octahedron.obj --scheme loop --height @waves.exr --scale 0.02 --rate 32 --background 1,1,1 --path tessellation"},
    {"octahedron_loop_grid",
     "@octahedron.obj --scheme loop --height @waves.exr --scale 0.02 --rate 32 --background 1,1,1 --path grid"},
    {"plane_terrain",
     "^plane --height @terrain.png --scale 0.8 --wrap clamp --path grid --edge-pixels 2 --elevation 30 "
     "--roughness 0.9 --color 0.4,0.45,0.3"},
    {"ball_albedo",
     "^ball --height @waves.exr --scale 0.05 --albedo @checker.png --path grid --rate 12 --roughness 0.2 "
     "--transparent --light -60,20"},
    {"ball_wireframe",
     "^ball --height @waves.exr --scale 0.1 --rate 6 --show wireframe --background 1,1,1 --path tessellation"},
    {"lantern_faces", "^lantern --path grid --rate 4 --show faces --azimuth 20 --elevation 18 --background 1,1,1"},
    {"torus_normal",
     "^torus --height @waves.exr --scale 0.06 --path grid --rate 12 --show normal --elevation 35 --background 1,1,1"},
    {"torus_rate", "^torus --edge-pixels 3 --show rate --elevation 35 --background 1,1,1 --path grid"},
    {"plane_height", "^plane --height @terrain.png --scale 0.8 --wrap clamp --path grid --rate 16 --show height "
                     "--elevation 50 --background 1,1,1"},
    {"cube_polygons", "^cube --scheme none --azimuth 35 --elevation 25 --background 1,1,1"},
};

/// A change of a golden that a person would hardly see: words of it, and what stands there instead.
struct Mutant {
    const char *golden, *from, *to;
};

inline constexpr Mutant kMutants[] = {
    {"torus_waves_grid", "--scale 0.06", "--scale 0.0612"},               // heights by 2 %
    {"plane_height", "--scale 0.8", "--scale 0.816"},                     // the same, in colors of --show
    {"cube_creases_grid", "--background", "--light -19,50 --background"}, // the key light by a degree
};

/// Throws where the golden or the words do not exist.
inline std::string mutatedWords(const Mutant& mutant) {
    std::map<std::string, std::string> words;
    for (const Golden& golden : kGoldens) words[golden.name] = golden.words;
    std::string changed = words.at(mutant.golden);
    return changed.replace(changed.find(mutant.from), std::string_view(mutant.from).size(), mutant.to);
}

inline std::string committedPath(const std::string& golden) {
    return fmt::format("{}/tests/goldens/{}.png", RELIEF_SOURCE, golden);
}

/// Draws words as a golden is drawn, in a folder of the build named after the driver.
inline std::string drawGolden(const SceneFolder& scenes, const std::string& name, const std::string& words,
                              const char* driver) {
    const std::string folder = fmt::format("{}/goldens/{}", RELIEF_BINARY_DIR, driver);
    std::filesystem::create_directories(folder);
    const std::string drawn = fmt::format("{}/{}.png", folder, name);
    scenes.render(fmt::format("{} --size 256,256 --device {}", words, driver), drawn);
    return drawn;
}

/// Compares a picture in the build folder with the committed golden; empty where their sizes differ.
inline std::optional<Comparison> compareWithGolden(const std::string& drawn, const std::string& golden) {
    const Image now = readImage(drawn), before = readImage(committedPath(golden));
    const bool hasShape = now.width == before.width && now.height == before.height && now.channels == before.channels;
    EXPECT_TRUE(hasShape) << drawn;
    return hasShape ? std::optional(compare(now, before)) : std::nullopt;
}

/// Expects `isSame` of the picture and the committed golden. One that differs stays in the build folder, with ten times
/// the difference beside it.
template <typename Same>
void expectGolden(const std::string& drawn, const std::string& golden, const Same& isSame) {
    const std::optional<Comparison> result = compareWithGolden(drawn, golden);
    if (!result) return;
    const std::string difference = drawn.substr(0, drawn.size() - 4) + "_x10.png";
    if (isSame(*result)) {
        std::filesystem::remove(drawn);
        std::filesystem::remove(difference);
        return;
    }
    writeImage(difference, result->tenfold, SampleType::uint8);
    ADD_FAILURE() << *result << "\n  drawn      " << drawn << "\n  committed  " << committedPath(golden)
                  << "\n  difference " << difference;
}

} // namespace relief::test
