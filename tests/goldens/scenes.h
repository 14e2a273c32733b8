// The scenes of the golden pictures: cages of this project, maps and small cages made here.
#pragma once

#include "program.h"

namespace relief::test {

/// A loop surface: the octahedron with texture coordinates, one corner crease.
inline constexpr std::string_view kOctahedron = R"(
v 1 0 0
v -1 0 0
v 0 1.3 0
v 0 -1.3 0
v 0 0 1
v 0 0 -1
vt 0 0
vt 1 0
vt 0.5 1
f 5/1 1/2 3/3
f 1/1 6/2 3/3
f 6/1 2/2 3/3
f 2/1 5/2 3/3
f 1/1 5/2 4/3
f 6/1 1/2 4/3
f 2/1 6/2 4/3
f 5/1 2/2 4/3
t crease 2/1/0 4 0 10
)";

/// Hills from a few sines and a plateau with steep sides, 0..1.
inline Image terrainImage(int side) {
    Image image{side, side, 1, std::vector<float>(std::size_t(side) * std::size_t(side))};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double s = (x + 0.5) / side, t = (y + 0.5) / side;
            const double hills = 0.5 + 0.2 * std::sin(9 * s + 2 * std::sin(7 * t)) + 0.12 * std::cos(23 * t - 11 * s);
            const double fade = std::min(1.0, 8 * std::min({s, t, 1 - s, 1 - t}));
            const bool isPlateau = std::abs(s - 0.3) < 0.1 && std::abs(t - 0.6) < 0.12;
            *image.at(x, y) = float(isPlateau ? 0.95 : 0.5 + fade * (hills - 0.5));
        }
    return image;
}

/// Two colors in squares.
inline Image checkerImage(int side, int squares) {
    Image image{side, side, 3, {}};
    for (int i = 0; i < side * side; ++i) {
        const bool isDark = ((i % side) * squares / side + (i / side) * squares / side) % 2 == 0;
        const std::initializer_list<float> color = {isDark ? 0.15f : 0.9f, isDark ? 0.35f : 0.85f,
                                                    isDark ? 0.5f : 0.7f};
        image.texels.insert(image.texels.end(), color);
    }
    return image;
}

/// A folder with everything that scenes name: DIR/waves.exr, DIR/terrain.png, DIR/checker.png, DIR/octahedron.obj.
struct SceneFolder : TemporaryFolder {
    SceneFolder() {
        writeImage(*this / "waves.exr", sineImage(128, 4), SampleType::real);
        writeImage(*this / "terrain.png", terrainImage(128), SampleType::uint16);
        writeImage(*this / "checker.png", checkerImage(64, 16), SampleType::uint8);
        putFile(*this / "octahedron.obj", kOctahedron);
    }

    /// Renders a line of words in which @ stands for this folder and ^ for the project's cages.
    void render(const std::string& line, const std::string& target) const {
        Words words = {"render", "-q", "-o", target};
        for (std::string word : split(line)) {
            if (word.starts_with('@')) word = *this / word.substr(1);
            if (word.starts_with('^')) word = cagePath(word.substr(1));
            words.push_back(word);
        }
        const Outcome outcome = relief(words);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
    }
};

} // namespace relief::test
