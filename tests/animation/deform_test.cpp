// Deformers against closed forms, and every expression that must be refused.
#include "animation/caches.h"

#include <cmath>
#include <numbers>
#include <random>

namespace relief::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Corners of the box from (-1, 2, -3) to (3, 10, 5), sides 4, 8, 8, centre (1, 6, 1), and points inside it.
Cage cloud() {
    Cage cage = cube();
    for (vec3& p : cage.positions) p = vec3(1, 6, 1) + p * vec3(2, 4, 4);
    std::mt19937 random(1);
    const auto unit = [&] { return float(random() / 4294967296.0); };
    for (int i = 0; i < 60; ++i) {
        cage.positions.push_back(vec3(-1, 2, -3) + vec3(unit(), unit(), unit()) * vec3(4, 8, 8));
        const auto last = std::uint32_t(cage.positions.size() - 1);
        addFace(cage, {0, 1, last});
    }
    return cage;
}
const dvec3 kCenter(1, 6, 1);

std::vector<vec3> deformed(const Cage& cage, const std::string& expression, double t = 0) {
    return deform(stillPose(cage), cage, expression)->pose(t).positions;
}

/// Expects `expected(p)` of every point, given and expected relative to the centre.
template <typename Expected>
void expectDeformed(const std::string& expression, double t, const Expected& expected) {
    const Cage cage = cloud();
    std::vector<vec3> points;
    for (const vec3& p : cage.positions) points.emplace_back(kCenter + expected(dvec3(p) - kCenter));
    expectNear(deformed(cage, expression, t), points, 4e-6);
}

TEST(Deformers, areTakenApartAndPutTogether) {
    std::vector<DeformerText> all = parseDeformers(" twist( axis = y , angle=-30) wave(speed=2*t) bend()");
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(toExpression(all), "twist(axis=y, angle=-30) wave(speed=2*t) bend()");
    EXPECT_EQ(all[0].values[1].number, -30);
    EXPECT_FALSE(all[0].values[0].number);  // an axis
    EXPECT_FALSE(all[1].values[3].number);  // a formula
    EXPECT_EQ(all[2].values[1].number, 90); // the default
    all[2].values[1].text = "45", all[2].values[1].isGiven = true;
    EXPECT_EQ(toExpression(all), "twist(axis=y, angle=-30) wave(speed=2*t) bend(angle=45)");
    EXPECT_THROW(parseDeformers("twist(angle"), Error);
}

TEST(Deformers, stayToTheBitWhereNothingIsAsked) {
    const Cage cage = cloud();
    for (const std::string expression :
         {"twist(angle=0)", "twist(angle=90*sin(t))", "bend(angle=0)", "wave(amplitude=0)", "squash(amount=0)",
          "taper(amount=0)", "translate()", "rotate(angle=-0)", "scale()", "twist(angle=0) bend(angle=t) scale(y=1)"})
        EXPECT_TRUE(haveSameBits(deformed(cage, expression), cage.positions)) << expression;
}

TEST(Twist, keepsDistancesToTheAxis) {
    const Cage cage = cloud();
    const std::vector<vec3> points = deformed(cage, "twist(axis=z, angle=200)");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const dvec3 before = dvec3(cage.positions[i]) - kCenter, after = dvec3(points[i]) - kCenter;
        EXPECT_NEAR(std::hypot(after.x, after.y), std::hypot(before.x, before.y), 2e-6);
        EXPECT_EQ(points[i].z, cage.positions[i].z);
    }
}

TEST(Twist, turnsTheEndsOfTheBoxByTheAngleAgainstEachOther) {
    for (const double angle : {90.0, -30.0})
        expectDeformed(fmt::format("twist(axis=y, angle={})", angle), 0, [&](const dvec3& p) {
            const double theta = angle * kPi / 180 * p.y / 8; // counter-clockwise seen from the tip of y: z toward x
            return dvec3(p.x * std::cos(theta) + p.z * std::sin(theta), p.y,
                         p.z * std::cos(theta) - p.x * std::sin(theta));
        });
}

TEST(Bend, laysARodOnAnArcOfItsLength) {
    Cage rod;
    for (int i = 0; i <= 32; ++i) rod.positions.emplace_back(1, -3 + 6 * i / 32.0, 2);
    for (std::uint32_t i = 0; i + 2 <= 32; ++i) addFace(rod, {i, i + 1, i + 2});
    for (const double degrees : {90.0, -200.0, 1e-3, 1e-9}) {
        const std::vector<vec3> points = deformed(rod, fmt::format("bend(axis=y, angle={}, toward=x)", degrees));
        const double radius = 6 / (degrees * kPi / 180);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double theta = degrees * kPi / 180 * (double(i) / 32 - 0.5);
            const double tolerance = std::abs(radius) * 1e-15 + 1e-6; // of the closed form, where the radius is large
            EXPECT_NEAR(points[i].x, 1 + radius * (1 - std::cos(theta)), tolerance);
            EXPECT_NEAR(points[i].y, radius * std::sin(theta), tolerance);
            EXPECT_EQ(points[i].z, 2);
        }
    }
}

TEST(Bend, turnsCrossSectionsWithoutStretchingThem) {
    const double k = kPi / 2 / 8; // 90 degrees over 8
    expectDeformed("bend(axis=y, angle=90, toward=z)", 0, [&](const dvec3& p) {
        const double theta = k * p.y, C = std::cos(theta), S = std::sin(theta);
        return dvec3(p.x, -S * (p.z - 1 / k), C * (p.z - 1 / k) + 1 / k); // Barr, "Global linear bends"
    });
}

TEST(Bend, goesOnStraightBeyondTheBox) {
    const Cage cage = cube(); // -1 to 1
    Cage longer = cage;
    for (vec3& p : longer.positions) p.y *= 3;
    const std::vector<vec3> ends = deformed(cage, "bend(axis=y, angle=180, toward=x)");
    const std::vector<vec3> points =
        deform(stillPose(longer), cage, "bend(axis=y, angle=180, toward=x)")->pose(0).positions;
    for (std::size_t i = 0; i < 8; ++i) // the ends' directions are +x and -x: theta = +-90 degrees
        EXPECT_LT(glm::distance(dvec3(points[i]), dvec3(ends[i]) + dvec3(2, 0, 0)), 1e-6);
}

TEST(Wave, travelsAlongItsAxis) {
    for (const double t : {0.0, 0.7, 100.0})
        expectDeformed("wave(axis=y, amplitude=0.25, wavelength=0.5, speed=0.125, along=x)", t, [&](const dvec3& p) {
            return p + dvec3(0, 2 * std::sin(2 * kPi * (p.x - t) / 4), 0); // the longest side is 8
        });
}

TEST(Wave, moveAFlatCageToo) {
    const Cage plane = boundaryGrid();
    EXPECT_FALSE(haveSameBits(deformed(plane, "wave()"), plane.positions));
}

TEST(Squash, keepsVolumes) {
    for (const std::string amount : {"0.5", "-1", "0.9"}) {
        const Cage cage = cloud();
        const std::vector<vec3> points = deformed(cage, "squash(axis=x, amount=" + amount + ")");
        for (std::size_t i = 3; i < points.size(); ++i) {
            const auto volume = [&](const std::vector<vec3>& of) {
                const dvec3 o(of[i]);
                return glm::dot(dvec3(of[0]) - o, glm::cross(dvec3(of[1]) - o, dvec3(of[2]) - o));
            };
            EXPECT_NEAR(volume(points), volume(cage.positions), 1e-3);
        }
    }
    expectDeformed("squash(axis=x, amount=0.75)", 0, [](const dvec3& p) { return p * dvec3(0.25, 2, 2); });
}

TEST(Taper, narrowsTowardTheUpperEnd) {
    expectDeformed("taper(axis=y, amount=0.5)", 0, [](const dvec3& p) {
        const double r = 1 - 0.5 * (p.y + 4) / 8;
        return p * dvec3(r, 1, r);
    });
}

TEST(RigidDeformers, moveTurnAndScaleAroundTheCentre) {
    expectDeformed("translate(x=0.5, y=-0.25, z=t)", 2, [](const dvec3& p) { return p + dvec3(4, -2, 16); });
    expectDeformed("rotate(axis=z, angle=90)", 0, [](const dvec3& p) { return dvec3(-p.y, p.x, p.z); });
    expectDeformed("rotate(axis=x, angle=90)", 0, [](const dvec3& p) { return dvec3(p.x, -p.z, p.y); });
    expectDeformed("scale(x=2, y=0, z=-1)", 0, [](const dvec3& p) { return p * dvec3(2, 0, -1); });
}

TEST(Deformers, takeTheNextAxisWhereNoneIsGiven) {
    const Cage cage = cloud();
    for (const auto& [given, same] :
         std::vector<std::pair<std::string, std::string>>{{"bend(axis=x)", "bend(axis=x, angle=90, toward=y)"},
                                                          {"bend()", "bend(toward=z, axis=y)"},
                                                          {"wave(axis=z)", "wave(axis=z, along=x)"},
                                                          {"wave(along=next)", "wave(along=z)"},
                                                          {"twist()", "twist(angle=90, axis=y)"}})
        EXPECT_TRUE(haveSameBits(deformed(cage, given, 1), deformed(cage, same, 1))) << given;
}

TEST(Deformers, leaveAFlatBoxAloneAlongItsNormal) {
    Cage plane = cube();
    for (vec3& p : plane.positions) p.y = 5;
    for (const std::string expression : {"twist(axis=y)", "bend(axis=y)", "taper(axis=y)"})
        EXPECT_TRUE(haveSameBits(deformed(plane, expression), plane.positions)) << expression;
}

TEST(Deformers, takeTheBoxOfFacesNotOfStrayPoints) {
    Cage stray = cloud();
    stray.positions.emplace_back(1000, 1000, 1000);
    std::vector<vec3> points = deformed(stray, "twist() wave()", 1);
    points.pop_back();
    EXPECT_TRUE(haveSameBits(points, deformed(cloud(), "twist() wave()", 1)));
}

TEST(Deformers, workOneAfterAnother) {
    expectDeformed("rotate(axis=z, angle=90) scale(x=2)", 0, [](const dvec3& p) { return dvec3(-2 * p.y, p.x, p.z); });
    expectDeformed(" scale( x = 2 )\n rotate(axis=z,angle=90,)", 0,
                   [](const dvec3& p) { return dvec3(-p.y, 2 * p.x, p.z); });
}

TEST(Deformers, movePosesOfCaches) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    writeFrames(folder / "a.pc2", cage, 5);
    const auto animation = deform(readQuietly(folder / "a.pc2", cage), cage, "translate(x=1)"); // 2 units
    std::vector<vec3> expected = movedPoints(cage, 3);
    for (vec3& p : expected) p.x += 2;
    expectNear(animation->pose(3 / 24.0).positions, expected, 1e-6);
    EXPECT_EQ(animation->rig(), nullptr);
}

/// One joint that moves everything by `t` along x.
class RiggedAnimation : public Animation {
public:
    explicit RiggedAnimation(const Cage& cage) {
        const std::size_t count = cage.positions.size();
        rig_ = {.rest = cage.positions, .jointCount = 1, .influenceCount = 1};
        rig_.joints.assign(count, 0), rig_.weights.assign(count, 1);
    }
    [[nodiscard]] Pose pose(double seconds) const override {
        mat4 joint(1);
        joint[3].x = float(seconds);
        return {.positions = {}, .joints = {joint}, .morphWeights = {}};
    }
    [[nodiscard]] const Rig* rig() const override { return &rig_; }
    [[nodiscard]] dvec2 keyRange() const override { return {-1, 10}; }

private:
    Rig rig_;
};

TEST(Deformers, giveThePositionsOfRigs) {
    const Cage cage = cube();
    const auto animation = deform(std::make_unique<RiggedAnimation>(cage), cage, "scale(y=2)");
    EXPECT_EQ(animation->rig(), nullptr);
    const Pose pose = animation->pose(3);
    EXPECT_TRUE(pose.joints.empty());
    std::vector<vec3> expected = cage.positions;
    for (vec3& p : expected) p = vec3(p.x + 3, 2 * p.y, p.z);
    expectNear(pose.positions, expected, 1e-6);
}

TEST(Deformers, haveTheRangeOfTheBaseAndFourSecondsWhereTheyMove) {
    const Cage cage = cube();
    const auto range = [&](const std::string& expression) {
        return deform(stillPose(cage), cage, expression)->keyRange();
    };
    EXPECT_EQ(range("twist(angle=90)"), dvec2(0));
    EXPECT_EQ(range("twist(angle=90*t)"), dvec2(0, 4));
    EXPECT_EQ(range("rotate() squash(amount=0.1*sin(t))"), dvec2(0, 4));
    EXPECT_EQ(range("wave()"), dvec2(0, 4)) << "it travels by itself";
    EXPECT_EQ(range("wave(speed=0)"), dvec2(0));
    const auto rigged = [&](const std::string& expression) {
        return deform(std::make_unique<RiggedAnimation>(cage), cage, expression)->keyRange();
    };
    EXPECT_EQ(rigged("rotate(angle=t)"), dvec2(-1, 10));
    EXPECT_EQ(rigged("rotate()"), dvec2(-1, 10));
    EXPECT_EQ(deform(deform(stillPose(cage), cage, "wave()"), cage, "twist()")->keyRange(), dvec2(0, 4));
}

// --- errors --------------------------------------------------------------------------------------------------------

void expectWordsRefused(const std::string& expression, int column, std::vector<std::string> words) {
    words.push_back(fmt::format("deformers: column {}: ", column));
    expectFailure(Failure::usage, words, [&] { deform(stillPose(cube()), cube(), expression); });
}

TEST(DeformerErrors, sayWhatWasFoundAndWhatExpected) {
    const std::string names = "twist, bend, wave, squash, taper, translate, rotate, scale";
    expectWordsRefused("", 1, {"found the end", "a deformer: " + names});
    expectWordsRefused("  ", 3, {"found the end"});
    expectWordsRefused("(", 1, {"found '('", names});
    expectWordsRefused("twits(angle=3)", 1, {"'twits'", names, "did you mean 'twist'?"});
    expectWordsRefused("melt()", 1, {"'melt'", names});
    expectWordsRefused("twist", 6, {"found the end", "'(' after twist"});
    expectWordsRefused("twist angle", 7, {"found 'angle'", "'(' after twist"});
    expectWordsRefused("twist(", 7, {"found the end", "a value of twist: axis, angle"});
    expectWordsRefused("twist(90)", 7, {"found '90'", "axis, angle"});
    expectWordsRefused("twist(angel=90)", 7, {"'angel'", "value of twist: axis, angle", "did you mean 'angle'?"});
    expectWordsRefused("twist(angle 90)", 13, {"found '90'", "'=' after angle"});
    expectWordsRefused("twist(angle=)", 13, {"found ')'", "a number, t, pi"});
    expectWordsRefused("twist(angle=90", 15, {"found the end", "an operator, ',' or ')'"});
    expectWordsRefused("twist(angle=90 axis=y)", 16, {"found 'axis'", "an operator, ',' or ')'"});
    expectWordsRefused("twist(axis=y angle=90)", 14, {"found 'angle'", "',' or ')'"});
    expectWordsRefused("twist(,)", 7, {"found ','", "axis, angle"});
    expectWordsRefused("twist() , bend()", 9, {"found ','", "a deformer"});
    expectWordsRefused("twist()) ", 8, {"found ')'", "a deformer"});
    expectWordsRefused("twist(angle=1, angle=2)", 16, {"angle is given twice"});
}

TEST(DeformerErrors, nameAxesThatDoNotExist) {
    expectWordsRefused("twist(axis=w)", 12, {"'w'", "axis: x, y, z, next"});
    expectWordsRefused("twist(axis=1)", 12, {"found '1'", "x, y, z or next"});
    expectWordsRefused("twist(axis=xy)", 12, {"'xy'"});
    expectWordsRefused("scale() twist(axis=next)", 9, {"axis of twist is x, y or z"});
    expectWordsRefused("bend(axis=z, toward=z)", 1, {"axis and toward of bend", "same axis"});
    expectWordsRefused("twist() wave(along=y)", 9, {"axis and along of wave", "same axis"});
}

TEST(DeformerErrors, nameDeformerValueAndTimeOfValuesThatMakeNoSense) {
    const Cage cage = cube();
    const auto refuse = [&](const std::string& expression, double t, const std::vector<std::string>& words) {
        const auto animation = deform(stillPose(cage), cage, expression);
        expectFailure(Failure::usage, words, [&] { (void)animation->pose(t); });
    };
    refuse("twist(angle=1/t)", 0, {"angle of twist is inf at t = 0 seconds", "finite"});
    refuse("twist() squash(amount=(t-2)^0.5)", 1.5, {"column 9", "amount of squash is", "nan at t = 1.5 seconds"});
    refuse("wave(wavelength=1-t)", 1, {"wavelength of wave is 0 at t = 1 seconds", "above 0"});
    refuse("wave(wavelength=1-t)", 3, {"wavelength of wave is -2 at t = 3 seconds", "above 0"});
    refuse("squash(amount=t)", 1, {"amount of squash is 1 at t = 1 seconds", "below 1"});
    refuse("translate(x=10^t)", 39, {"point 0", "t = 39 seconds", "smaller"});
    refuse("scale(x=10^300) scale(x=10^300)", 0, {"point 0", "t = 0 seconds"});
    for (const char* text : {"translate(x=1e30)", "scale(x=1e20, y=1e20, z=1e20)", "wave(amplitude=1e38)",
                             "wave(wavelength=1e-308)", "taper(amount=1e9)", "squash(amount=-1e12)"})
        refuse(text, 0.1, {"goes to (", "t = 0.1 seconds; use smaller values"});
    EXPECT_NO_THROW((void)deform(stillPose(cage), cage, "translate(x=1000) scale(y=1000)")->pose(0));
    EXPECT_NO_THROW((void)deform(stillPose(cage), cage, "twist(angle=1/t)")->pose(1));
    EXPECT_NO_THROW((void)deform(stillPose(cage), cage, "squash(amount=t)")->pose(0.99));
}

TEST(DeformerErrors, areAllThatComesOfAnyText) {
    const std::string valid = "twist(axis=y, angle=90*sin(t)) bend(angle=min(t, 2)^2)";
    const auto expectAnswer = [](const std::string& text) {
        try {
            const auto animation = deform(stillPose(cube()), cube(), text);
            (void)animation->pose(0.5);
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::usage) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    };
    for (std::size_t i = 0; i <= valid.size(); ++i) {
        expectAnswer(valid.substr(0, i));
        for (const char letter : std::string("(),=9.te^- \n\0\xff", 14)) {
            std::string text = valid;
            expectAnswer(text.insert(i, 1, letter));
            if (i < valid.size()) text = valid, text[i] = letter, expectAnswer(text);
        }
    }
}

TEST(DeformerHelp, listsDeformersAsTheyAreWritten) {
    const std::string help = deformerHelp();
    const Cage cage = cube();
    for (const std::string name : {"twist", "bend", "wave", "squash", "taper", "translate", "rotate", "scale"}) {
        const std::size_t first = help.find("  " + name + "("), end = help.find('\n', first);
        ASSERT_NE(first, std::string::npos) << name;
        const std::string listed = help.substr(first, end - first);
        EXPECT_TRUE(haveSameBits(deformed(cage, listed, 1), deformed(cage, name + "()", 1))) << listed;
    }
    for (const std::string word : {"arithmetic", "sin cos abs", "pi", "seconds"})
        EXPECT_NE(help.find(word), help.npos) << word;
}

} // namespace
} // namespace relief::test
