// Negative numbers after a space: they are values and no options.
#include "program.h"

namespace relief::test {
namespace {

class NegativeNumbers : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    /// A picture by these words, which stand before the cage.
    std::string draw(const Words& words) {
        const std::string target = folder_ / "a.png";
        Words all{"render"};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), {cagePath("torus"), "--size", "32,32", "--rate", "2", "-o", target});
        expectDone(relief(all));
        return readFile(target);
    }
};

TEST_F(NegativeNumbers, areValuesWithASpaceAsWithAnEqualsSign) {
    const std::pair<const char*, const char*> cases[] = {{"--azimuth", "-30"},         {"--elevation", "-10.5"},
                                                         {"--light", "-30,20"},        {"--look-at", "-1,0,0"},
                                                         {"--look-at", "-.5,-.25,-1"}, {"--elevation", "-.5"}};
    for (const auto& [option, value] : cases)
        EXPECT_EQ(draw({option, value}), draw({std::string(option) + "=" + value})) << option << " " << value;
}

TEST_F(NegativeNumbers, mayStandApart) {
    EXPECT_EQ(draw({"--look-at", "-1", "-.5", "0"}), draw({"--look-at=-1,-0.5,0"}));
    EXPECT_EQ(draw({"--light", "-30", "-20"}), draw({"--light=-30,-20"}));
}

TEST_F(NegativeNumbers, areScalesMidsAndTimes) {
    writeImage(folder_ / "map.exr", sineImage(16, 1), SampleType::real);
    const auto drawWith = [&](Words words) {
        words.insert(words.begin(), {"--height", folder_ / "map.exr", "--deform", "twist(angle=90*t)"});
        return draw(words);
    };
    EXPECT_EQ(drawWith({"--scale", "-1e-1"}), drawWith({"--scale=-0.1"}));
    EXPECT_EQ(drawWith({"--mid", "-.5"}), drawWith({"--mid=-0.5"}));
    EXPECT_EQ(drawWith({"--time", "-1"}), drawWith({"--time=-1"}));
}

TEST_F(NegativeNumbers, areFrames) {
    const auto animate = [&](const Words& frames) {
        Words words{"animate"};
        words.insert(words.end(), frames.begin(), frames.end());
        words.insert(words.end(),
                     {cagePath("torus"), "--deform", "twist(angle=90*t)", "--json", "-o", folder_ / "a.pc2"});
        return jsonOf(relief(words)).at("frames");
    };
    const nlohmann::json frames = animate({"--frames", "-5:5"});
    ASSERT_EQ(frames.size(), 11u);
    EXPECT_EQ(frames[0].at("frame"), -5);
    EXPECT_EQ(frames, animate({"--frames=-5:5"}));
    EXPECT_EQ(animate({"--frames", "-2:-1"}).size(), 2u);
    EXPECT_EQ(animate({"--frames", "-3"}).size(), 1u);
}

} // namespace
} // namespace relief::test
