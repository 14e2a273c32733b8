// Internal: this program once more, with other words, while the window goes on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace relief {

/// A process that this program started. What it prints is kept; its errors go where this program's go.
class Process {
public:
    /// `words`: its arguments, beginning with a name. Throws Failure::device where no process can be started.
    explicit Process(std::vector<std::string> words);

    /// Its exit code once it has ended, 128 and more after a signal; nothing before.
    std::optional<int> poll();
    /// What it has printed so far.
    [[nodiscard]] std::string output() const;

private:
    std::unique_ptr<Temporary> folder_;
    int id_ = -1;
};

} // namespace relief
