// The panels of the window: sessions that click, drag and type as a user does.
#include <set>

#include <fmt/format.h>

#include "display.h"

namespace relief::test {
namespace {

/// A session in the making: each widget by its label, wherever it is drawn.
struct Session {
    std::string lines = "rest\n";
    std::set<std::string> used;

    /// A click at a share of a widget's width: presses a button, opens a list, sets a slider.
    void click(const std::string& widget, double share = 0.5) {
        lines += fmt::format("point {} {}\npress left\nrelease left\n", share, widget);
        used.insert(widget);
    }
    void pick(const std::string& list, const std::string& word) { click(list), click(list + ": " + word); }
    /// From the middle of a number to the right, across a third of it. Before that a while passes: two presses at one
    /// place are a double click, after which the number is typed.
    void drag(const std::string& widget) {
        lines += fmt::format("wait 0.35\npoint 0.5 {0}\npress left\npoint 0.8 {0}\nrelease left\n", widget);
        used.insert(widget);
    }
    void add(const std::string& line) { lines += line + "\n"; }
};

/// Widgets of the second session.
const std::set<std::string> kButtonsBelow = {"copy command", "screenshot", "turntable", "certificate", "##recent"};

/// The value of an option in the command line of a report; nothing where it is not among its words.
std::optional<std::string> optionOf(const nlohmann::json& report, const std::string& name) {
    for (const std::string word : report["command"]) {
        if (word == name) return "";
        if (word.starts_with(name + "=")) return word.substr(name.size() + 1);
    }
    return {};
}

double numberOf(const nlohmann::json& report, const std::string& name) {
    const std::optional<std::string> value = optionOf(report, name);
    EXPECT_TRUE(value.has_value()) << name << " in " << report["command"];
    return value ? std::stod(*value) : std::nan("");
}

// Each widget does what an option does: the picture is that of the command line that the window gives, which has them.
TEST(WindowPanels, doWhatOptionsDo) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    writeWaves(folder / "waves.png", 3);
    Session session;
    // What is seen, from where.
    for (const char* section : {"Camera and light", "Warnings"}) session.click(section, 0.2);
    session.pick("show", "error");
    for (const char* widget : {"cage", "freeze rates", "freeze rates", "front", "right", "top", "parallel", "frame"})
        session.click(widget, 0.1);
    session.add("report");
    session.click("parallel", 0.1);
    session.pick("split", "smooth");
    session.click("difference, 8 times", 0.1);
    session.add("rest");
    session.pick("split", "off");
    session.pick("show", "shaded");
    // Heights, triangles, light and material.
    session.pick("detail", "both");
    session.drag("scale"), session.drag("midlevel");
    session.pick("normal", "first-order");
    session.click("same rate everywhere", 0.05);
    session.click("rate", 0.3);
    session.add("report");
    session.click("same rate everywhere", 0.05);
    session.click("edge pixels", 0.4);
    session.pick("spacing", "fractional");
    session.pick("path", "dice");
    const std::pair<const char*, double> sliders[] = {
        {"field of view", 0.15}, {"exposure", 0.4},  {"light from", 0.3}, {"light above", 0.4},
        {"environment", 0.35},   {"roughness", 0.3}, {"occlusion", 0.1}};
    for (const auto& [widget, share] : sliders) session.click(widget, share);
    session.click("shadows", 0.1);
    session.pick("shading", "phong");
    session.pick("filter", "bilinear");
    // Deformers and time.
    session.drag("twist angle");
    session.click("expression", 0.8);
    session.add("key End\ntext translate(x=0.1)\nkey Enter\nrest");
    for (const char* widget : {"play", "play", "loop"}) session.click(widget);
    session.click("time", 0.5);
    session.click("Measured", 0.2);
    for (const char* section : {"View", "Heights", "Triangles", "Deformers"})
        session.click(section, 0.2), session.click(section, 0.2); // closed and open again
    session.add("rest\nscreenshot " + folder / "a.png");
    session.add("report\nclose");
    const std::vector<nlohmann::json> reports =
        reportsOf(relief({"view", cagePath("torus"), "--height", folder / "waves.png", "--scale", "0.2", "--deform",
                          "twist(axis=y, angle=40)", "--frames", "0:20", "--size", "540,240", "--edge-pixels", "12",
                          "--play", writeSession(folder, "session", session.lines)}));
    ASSERT_EQ(reports.size(), 3u);

    // Sliders stand where they were clicked, less half of what is moved: a sixteenth of their range.
    const auto expectAt = [](const nlohmann::json& report, const char* option, dvec2 range, double share) {
        EXPECT_NEAR(numberOf(report, option), glm::mix(range.x, range.y, share), (range.y - range.x) / 16) << option;
    };
    EXPECT_EQ(optionOf(reports[0], "--show"), "error");
    EXPECT_EQ(numberOf(reports[0], "--fov"), 1);
    EXPECT_EQ(numberOf(reports[0], "--azimuth"), 0);
    EXPECT_EQ(numberOf(reports[0], "--elevation"), 90);
    expectAt(reports[1], "--rate", {1, 64}, 0.3);
    const nlohmann::json& last = reports[2];
    const std::pair<const char*, const char*> words[] = {
        {"--detail", "both"},   {"--normal", "first-order"}, {"--spacing", "fractional"}, {"--path", "dice"},
        {"--shading", "phong"}, {"--filter", "bilinear"},    {"--no-shadows", ""},        {"--frames", "10:10"}};
    for (const auto& [option, word] : words) EXPECT_EQ(optionOf(last, option), word) << last["command"];
    for (const char* option : {"--show", "--rate"}) EXPECT_FALSE(optionOf(last, option).has_value()) << option;
    expectAt(last, "--fov", {1, 120}, 0.15);
    expectAt(last, "--exposure", {-4, 4}, 0.4);
    expectAt(last, "--environment-azimuth", {-360, 360}, 0.35);
    expectAt(last, "--roughness", {0.05, 1}, 0.3);
    expectAt(last, "--occlusion", {0, 0.5}, 0.1);
    EXPECT_NEAR(std::log2(numberOf(last, "--edge-pixels")), -1 + 7 * 0.4, 7.0 / 16); // from 0.5 to 64
    EXPECT_GT(numberOf(last, "--scale"), 0.25);
    EXPECT_GT(numberOf(last, "--mid"), 0.55); // from that of unsigned integers, 0.5
    EXPECT_TRUE(optionOf(last, "--light").has_value());
    const std::string deformers = optionOf(last, "--deform").value_or("");
    EXPECT_TRUE(deformers.starts_with("twist(") && !contains(deformers, "angle=40)")) << deformers; // dragged
    EXPECT_TRUE(contains(deformers, "translate(x=0.1")) << deformers;                               // typed
    EXPECT_EQ(last["error"], "");
    expectSame(last, folder / "a.png", folder);

    // None was forgotten, but for the buttons below.
    for (const std::string label : last["widgets"]) {
        const bool isUsed = session.used.contains(label) || kButtonsBelow.contains(label);
        EXPECT_TRUE(isUsed || contains(label, ": ") || label.starts_with("twist ") || label.starts_with("translate "))
            << label;
    }
}

// The buttons of files, and the keys that do the same. The certificate is that of relief check, with its warnings.
TEST(WindowPanels, writeWhatTheirButtonsSay) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    Session session;
    session.add("key Tab\nkey Tab");
    session.click("copy command");
    session.add("rest\nreport");
    session.click("screenshot");
    session.add("key F12\nkey C\nkey R\nrest");
    session.click("certificate");
    session.add("rest\nreport\nkey Escape\ndrop " + cagePath("cube") + "\nrest");
    session.click("##recent");
    session.click("recent: " + cagePath("torus"));
    session.add("rest\nreport");
    session.click("turntable");
    session.add("wait 0.2\nkey Q");
    writeSession(folder, "session", session.lines);
    writeImage(folder / "eight.png", sineImage(16, 1), SampleType::uint8);
    const std::string options = " --rate 3 --scale 0.01 --height " + folder / "eight.png";
    const std::vector<nlohmann::json> reports =
        reportsOf(shell("cd $IN && RELIEF_CACHE=$IN/cache $RELIEF view " + cagePath("torus") + options +
                            " --size 340,160 --play $IN/session",
                        folder));
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_TRUE(contains(reports[0]["notice"], "copied: relief render")) << reports[0];
    expectSame(reports[0], folder / "relief-1.png", folder);
    EXPECT_TRUE(readFile(folder / "relief-1.png") == readFile(folder / "relief-2.png"));
    const Outcome check = relief({"check", cagePath("torus")}, options);
    EXPECT_EQ(reports[1]["certificate"], check.out);
    EXPECT_TRUE(contains(check.out, "open edges")) << check.out;
    EXPECT_EQ(reports[1]["notice"].get<std::string>() + "\n", check.err);
    EXPECT_TRUE(contains(check.err, "warning: ") && contains(check.err, "8-bit")) << check.err;
    EXPECT_GE(reports[1]["reloads"], 1);
    EXPECT_EQ(reports[2]["command"][2], cagePath("torus"));
    EXPECT_EQ(reports[2]["certificate"], "");
    EXPECT_EQ(readFile(folder / "cache/recent"), cagePath("torus") + "\n" + cagePath("cube") + "\n");
    // The turntable is written by a process of its own, which goes on when the window is closed.
    EXPECT_TRUE(waitForFile(folder / "turntable-1.mp4"));
}

// A certificate that cannot be had is an error in the words of relief check.
TEST(WindowPanels, sayWhyThereIsNoCertificate) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    writeFile(folder / "mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n");
    const std::vector<nlohmann::json> reports =
        reportsOf(relief({"view", folder / "mesh.obj", "--size", "96,64", "--play",
                          writeSession(folder, "session", "rest\nkey K\nrest\nreport\nclose\n")}));
    ASSERT_EQ(reports.size(), 1u);
    const Outcome check = relief({"check", folder / "mesh.obj"});
    EXPECT_EQ(reports[0]["error"].get<std::string>() + "\n", check.err);
    EXPECT_TRUE(contains(check.err, "certificates are for")) << check.err;
    EXPECT_EQ(reports[0]["notice"], "");
}

TEST(WindowPanels, haveNoOtherWidgets) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    expectRefused(relief({"view", cagePath("torus"), "--size", "96,64", "--play",
                          writeSession(folder, "session", "rest\npoint 0.5 nothing\n")}),
                  Failure::input, {"nothing"});
}

} // namespace
} // namespace relief::test
