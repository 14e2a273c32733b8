// Runs the built program as a user does, with Vulkan's validation layer on (the program then fails on any message).
// RELIEF_PROGRAM and RELIEF_SOURCE are compile definitions.
#pragma once

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "support.h"

namespace relief::test {

using Words = std::vector<std::string>;

inline Words split(const std::string& line) {
    std::istringstream stream(line);
    Words words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

struct Outcome {
    int exitCode = -1; ///< 128 + signal when one ended it
    std::string out, err;
};

/// The program, started; its words go to files so that neither side ever waits for the other.
class Program {
public:
    explicit Program(const Words& arguments, const char* program = RELIEF_PROGRAM) {
        setenv("RELIEF_VALIDATE", "1", 1);
        Words all{program};
        all.insert(all.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& word : all) pointers.push_back(word.data());
        pointers.push_back(nullptr);

        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT, 0600);
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT, 0600);
        posix_spawnattr_t attributes; // a script's background job starts with SIGINT ignored; the program must not
        posix_spawnattr_init(&attributes);
        sigset_t defaults;
        sigemptyset(&defaults);
        sigaddset(&defaults, SIGINT);
        posix_spawnattr_setsigdefault(&attributes, &defaults);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
        const int error = posix_spawn(&process_, program, &files, &attributes, pointers.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        if (error != 0) ADD_FAILURE() << "cannot start " << program << ": " << strerror(error);
    }

    [[nodiscard]] std::string errorsSoFar() const { return std::filesystem::exists(err_) ? readFile(err_) : ""; }

    void signal(int number) const { kill(process_, number); }

    [[nodiscard]] pid_t id() const { return process_; }

    Outcome wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return {.exitCode = code, .out = readFile(out_), .err = readFile(err_)};
    }

private:
    TemporaryFolder folder_;
    std::string out_ = folder_ / "out", err_ = folder_ / "err";
    pid_t process_ = -1;
};

/// Runs it to its end; `more` is a line of further words.
inline Outcome relief(Words arguments, const std::string& more = "") {
    for (const std::string& word : split(more)) arguments.push_back(word);
    return Program(arguments).wait();
}

/// A line of shell in which $RELIEF is the program and $IN the folder: for limits and redirections.
inline Outcome shell(const std::string& line, const TemporaryFolder& folder) {
    setenv("RELIEF", RELIEF_PROGRAM, 1);
    setenv("IN", folder.path.c_str(), 1);
    return Program({"-c", line}, "/bin/sh").wait();
}

inline std::string cagePath(const std::string& name) { return std::string(RELIEF_SOURCE) + "/meshes/" + name + ".obj"; }

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Nothing but success, and nothing said on stdout.
inline void expectDone(const Outcome& outcome) {
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
}

/// This exit code, and one line on stderr that holds each of the parts.
inline void expectRefused(const Outcome& outcome, Failure failure, const Words& parts) {
    EXPECT_EQ(outcome.exitCode, int(failure)) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("relief: ")) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with("\n")) << outcome.err;
    for (const std::string& part : parts) EXPECT_TRUE(contains(outcome.err, part)) << part << " in " << outcome.err;
}

/// stdout as JSON; everything else must be silent success.
inline nlohmann::json jsonOf(const Outcome& outcome) {
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    nlohmann::json json = nlohmann::json::parse(outcome.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << outcome.out;
    return json;
}

/// One channel, `side` squared, of `waves` periods each way between -1 and 1, tileable; .exr keeps it exactly.
inline Image sineImage(int side, int waves) {
    Image image{side, side, 1, {}};
    image.texels.resize(std::size_t(side) * std::size_t(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double k = 2 * 3.141592653589793 * waves / side;
            *image.at(x, y) = float(std::sin(k * (x + 0.5)) * std::cos(k * (y + 0.5)));
        }
    return image;
}

} // namespace relief::test
