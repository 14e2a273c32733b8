#include "base/base.h"
#include "base/clock.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace relief {

namespace {

constexpr int kBarCells = 20;
constexpr double kQuietSeconds = 1; // work that ends sooner needs no bar

bool isWanted(ShowProgress show) {
    return show == ShowProgress::always || (show == ShowProgress::automatic && isatty(STDERR_FILENO) == 1);
}

} // namespace

std::string onOneLine(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    return text;
}

void printOnStderr(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

void warnOnStderr(const std::string& line) { printOnStderr(fmt::format("warning: {}\n", onOneLine(line))); }

Progress::Progress(std::string title, std::uint64_t total, ShowProgress show, std::string unit)
    : title_(std::move(title)), unit_(std::move(unit)), total_(std::max<std::uint64_t>(total, 1)),
      isShown_(isWanted(show)), startSeconds_(secondsNow()), quietUntil_(startSeconds_ + kQuietSeconds) {
    if (show != ShowProgress::always) return;
    quietUntil_ = startSeconds_;
    draw();
}

Progress::~Progress() {
    if (shownPercent_ >= 0) std::fputc('\n', stderr);
}

void Progress::advance(std::uint64_t steps) {
    done_ = std::min(done_ + steps, total_);
    if (isShown_ && secondsNow() >= quietUntil_) draw();
}

/// "  3.2 frames/s, 0:41 left": from what is done so far.
std::string Progress::speed() const {
    const double seconds = secondsNow() - startSeconds_;
    if (unit_.empty() || done_ == 0 || seconds <= 0) return "";
    const double perSecond = double(done_) / seconds;
    const auto left = std::uint64_t(std::llround(double(total_ - done_) / perSecond));
    return fmt::format("  {:.{}f} {}/s, {}:{:02} left ", perSecond, perSecond < 10 ? 1 : 0, unit_, left / 60,
                       left % 60);
}

void Progress::draw() {
    const double share = double(done_) / double(total_);
    const int percent = int(100 * share);
    if (percent == shownPercent_ && unit_.empty()) return;
    shownPercent_ = percent;
    const int full = int(kBarCells * share);
    std::string bar;
    for (int cell = 0; cell < kBarCells; ++cell) bar += cell < full ? "█" : "░";
    printOnStderr(fmt::format("\r{}  {:3} % {}{}", title_, percent, bar, speed()));
    std::fflush(stderr);
}

} // namespace relief
