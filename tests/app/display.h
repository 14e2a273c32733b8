// A display without a screen (Xvfb) for the window, sessions that it plays, and what they leave. Validation is on, so
// that any message of Vulkan's layer is a failure.
#pragma once

#include "program.h"

namespace relief::test {

/// A display of 1280 x 800 pixels, whose content lies in a file.
class Display {
public:
    Display() {
        int ends[2] = {-1, -1};
        if (access("/usr/bin/Xvfb", X_OK) != 0 || pipe(ends) != 0) return;
        process_ = fork();
        if (process_ == 0) {
            dup2(ends[1], 7);
            const int none = open("/dev/null", O_WRONLY);
            dup2(none, STDERR_FILENO);
            execl("/usr/bin/Xvfb", "Xvfb", "-displayfd", "7", "-screen", "0", "1280x800x24", "-fbdir",
                  folder_.path.c_str(), "-nolisten", "tcp", nullptr);
            _exit(127);
        }
        close(ends[1]);
        std::string name = ":";
        for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) name += c;
        close(ends[0]);
        if (name.size() > 1) setenv("DISPLAY", name.c_str(), 1);
        isOpen_ = name.size() > 1;
    }
    ~Display() { stop(); }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    [[nodiscard]] bool isOpen() const { return isOpen_; }

    /// Ends it, whatever is shown on it.
    void stop() {
        if (process_ <= 0) return;
        kill(process_, SIGTERM);
        waitpid(process_, nullptr, 0);
        process_ = -1;
    }

    /// Red, green and blue of the upper left part of the screen (X window dump: 32 bits per pixel, blue first).
    [[nodiscard]] std::vector<std::uint8_t> pixels(std::size_t width, std::size_t height) const {
        const std::string dump = readFile(folder_ / "Xvfb_screen0");
        const auto word = [&](std::size_t i) {
            std::uint32_t value = 0;
            for (std::size_t k = 0; k < 4; ++k) value = value << 8 | std::uint8_t(dump[4 * i + k]);
            return std::size_t(value);
        };
        const std::size_t start = word(0) + 12 * word(19), row = word(12);
        std::vector<std::uint8_t> rgb;
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x)
                for (const std::size_t c : {2, 1, 0}) rgb.push_back(std::uint8_t(dump[start + y * row + 4 * x + c]));
        return rgb;
    }

private:
    TemporaryFolder folder_;
    pid_t process_ = -1;
    bool isOpen_ = false;
};

#define RELIEF_DISPLAY                                                                                                 \
    Display display;                                                                                                   \
    if (!display.isOpen()) GTEST_SKIP() << "no Xvfb here (Debian: apt-get install xvfb)"

/// A map of 32 x 32 texels with waves of that many periods.
inline void writeWaves(const std::string& path, double periods) {
    Image map{32, 32, 1, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) map.texels.push_back(float(0.5 + 0.4 * std::sin(0.196 * periods * (x + y))));
    writeImage(path, map, SampleType::uint16);
}

/// Waits until there is such a file, for a minute at most; returns whether there is.
inline bool waitForFile(const std::string& path) {
    for (int i = 0; i < 6000 && !std::filesystem::exists(path); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return std::filesystem::exists(path);
}

inline std::string writeSession(const TemporaryFolder& folder, const std::string& name, const std::string& lines) {
    writeFile(folder / name, lines);
    return folder / name;
}

/// One report per `report` of the session.
inline std::vector<nlohmann::json> reportsOf(const Outcome& outcome) {
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "vulkan:")) << outcome.err; // also what is said while the window is closed
    std::vector<nlohmann::json> reports;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) reports.push_back(nlohmann::json::parse(line));
    return reports;
}

/// Runs the command line that the window gives, and compares the picture with the window's own.
inline void expectSame(const nlohmann::json& report, const std::string& screenshot, const TemporaryFolder& folder) {
    Words words = report["command"];
    words.erase(words.begin());
    const bool isFrame = words.front() == "animate";
    for (const char* word : {"--quiet", "-o"}) words.emplace_back(word);
    words.push_back(folder / (isFrame ? "again.{frame:4}.png" : "again.png"));
    expectDone(relief(words));
    const std::string path =
        folder / (isFrame ? fmt::format("again.{:04}.png", report["frame"].get<int>()) : "again.png");
    EXPECT_TRUE(readFile(path) == readFile(screenshot)) << report["command"];
}

} // namespace relief::test
