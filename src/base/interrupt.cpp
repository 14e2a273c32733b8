// What an interrupt must not leave behind.
#include "base/base.h"

#include <csignal>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace relief {

namespace fs = std::filesystem;

namespace {

/// The temporary files and folders of this process, for an interrupt to remove.
struct Temporaries {
    std::mutex mutex;
    std::set<std::string> paths;
};

/// Never destroyed: an interrupt may come while the program's other objects end.
Temporaries& temporaries() {
    static auto& all = *new Temporaries;
    return all;
}

} // namespace

void endAtOnce(std::string_view line, int exitCode) {
    const std::lock_guard lock(temporaries().mutex); // kept to the end: nobody makes another one
    std::error_code ignored;
    for (const std::string& path : temporaries().paths) fs::remove_all(path, ignored);
    printOnStderr(line);
    _exit(exitCode);
}

Temporary::Temporary(const std::function<std::string()>& make) {
    const std::lock_guard lock(temporaries().mutex); // an interrupt finds nothing that is not listed
    path_ = make();
    temporaries().paths.insert(path_);
}

Temporary::~Temporary() {
    const std::lock_guard lock(temporaries().mutex);
    temporaries().paths.erase(path_);
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void endCleanlyOnInterrupt() {
    sigset_t watched, before;
    sigemptyset(&watched);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction current {};
        sigaction(signal, nullptr, &current);
        if (current.sa_handler != SIG_IGN) sigaddset(&watched, signal); // as under nohup and in a script's background
    }
    // A thread that waits may lock and allocate, which a signal handler must not.
    pthread_sigmask(SIG_BLOCK, &watched, &before);
    try {
        std::thread([watched] {
            int signal = 0;
            sigwait(&watched, &signal);
            endAtOnce("relief: interrupted\n", 128 + signal);
        }).detach();
    } catch (const std::system_error&) { // no more threads for this user: then an interrupt ends the program at once
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
    }
}

} // namespace relief
