#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "base/base.h"

namespace relief {
namespace {

std::string stderrOf(const std::function<void()>& action) {
    testing::internal::CaptureStderr();
    action();
    return testing::internal::GetCapturedStderr();
}

TEST(Warnings, areOneLineOnStderr) {
    EXPECT_EQ(stderrOf([] { warnOnStderr("8-bit"); }), "warning: 8-bit\n");
}

TEST(Progress, isSilentWhenStderrIsNoTerminal) {
    EXPECT_EQ(stderrOf([] { Progress("work", 2, ShowProgress::automatic).advance(2); }), "");
}

/// What `action` prints while stderr is a terminal.
std::string terminalOf(const std::function<void()>& action) {
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    EXPECT_EQ(grantpt(master), 0);
    EXPECT_EQ(unlockpt(master), 0);
    const int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
    EXPECT_EQ(isatty(terminal), 1);
    const int before = dup(STDERR_FILENO);
    dup2(terminal, STDERR_FILENO);
    action();
    std::fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    std::string text(1 << 12, '\0');
    fcntl(master, F_SETFL, O_NONBLOCK);
    const ssize_t count = read(master, text.data(), text.size());
    text.resize(std::size_t(std::max<ssize_t>(count, 0)));
    close(terminal), close(master);
    return text;
}

TEST(Progress, isSilentOnATerminalWhileTheWorkIsShort) {
    EXPECT_EQ(terminalOf([] { Progress("work", 2, ShowProgress::automatic).advance(2); }), "");
}

TEST(Progress, showsOnATerminalAfterASecond) {
    const std::string text = terminalOf([] {
        Progress progress("work", 2, ShowProgress::automatic);
        std::this_thread::sleep_for(std::chrono::milliseconds(1010));
        progress.advance();
    });
    EXPECT_NE(text.find("work   50 %"), std::string::npos) << text;
}

TEST(Progress, isSilentWhenNotWanted) {
    EXPECT_EQ(stderrOf([] { Progress("work", 2, ShowProgress::never).advance(2); }), "");
}

TEST(Progress, redrawsOneLineAndEndsIt) {
    const std::string text = stderrOf([] {
        Progress progress("work", 4, ShowProgress::always);
        progress.advance();
        progress.advance(100); // more than the total
    });
    EXPECT_TRUE(text.starts_with("\rwork    0 % ░░░░"));
    EXPECT_NE(text.find("\rwork   25 % █████░"), std::string::npos);
    EXPECT_TRUE(text.ends_with("█\n"));
    EXPECT_NE(text.find("\rwork  100 % "), std::string::npos);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(Progress, drawsEachPercentOnce) {
    const std::string text = stderrOf([] {
        Progress progress("work", 100000, ShowProgress::always);
        for (int i = 0; i < 100000; ++i) progress.advance();
    });
    EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 101);
}

TEST(Progress, acceptsATotalOfZero) {
    EXPECT_TRUE(stderrOf([] { Progress("work", 0, ShowProgress::always).advance(); }).ends_with("\n"));
}

} // namespace
} // namespace relief
