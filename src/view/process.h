// Internal: runs this program as a child process.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace relief {

/// A process that this program started. What it prints and complains of is kept.
class Process {
public:
    /// `words`: its arguments, beginning with a name. `endsWithThis`: it is ended where this object ends first; else it
    /// goes on. Throws Failure::device where no process can be started, Failure::file where its output has no place.
    Process(std::vector<std::string> words, bool endsWithThis);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Its exit code once it has ended, 128 and more after a signal; nothing before.
    std::optional<int> poll();
    /// What it has printed so far.
    [[nodiscard]] std::string output() const;
    /// What it has written to stderr so far.
    [[nodiscard]] std::string complaints() const;

private:
    std::unique_ptr<Temporary> folder_;
    int id_ = -1; ///< -1: it has ended
    bool endsWithThis_;
};

} // namespace relief
