// A progress bar on stderr.
#pragma once

#include <cstdint>
#include <string>

namespace relief {

enum class ShowProgress { automatic, always, never };

/// One line on stderr, redrawn in place: `rendering  42 % ████░░░░`. With a unit it also shows the speed and the time
/// that is left: `animating  42 % ████░░░░  3.2 frames/s, 0:41 left`.
/// `automatic` shows it only where stderr is a terminal and the work takes over a second. One thread advances it.
class Progress {
public:
    Progress(std::string title, std::uint64_t total, ShowProgress show, std::string unit = "");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::uint64_t steps = 1);

private:
    void draw();
    [[nodiscard]] std::string speed() const;
    std::string title_, unit_;
    std::uint64_t total_, done_ = 0;
    int shownPercent_ = -1;
    bool isShown_;
    double startSeconds_, quietUntil_;
};

} // namespace relief
