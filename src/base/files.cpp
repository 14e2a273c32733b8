#include "base/base.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

namespace relief {

namespace fs = std::filesystem;

namespace {

/// Where the bytes really go: a link keeps pointing where it points. Devices and folders are refused, because the final
/// rename would replace them.
fs::path resolveTarget(const std::string& path) {
    if (path.empty()) fail(Failure::usage, "the output file has no name");
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail(Failure::file, "{}: cannot be written: it is not an ordinary file", path);
    const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
    return target.empty() ? fs::path(path) : target;
}

/// Makes an empty file that nobody else uses, in the target's folder and with its extension.
fs::path makeTemporary(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    for (;;) {
        const std::string name = fmt::format(".relief-{}-{}{}", getpid(), counter++, target.extension().string());
        fs::path temporary = target.parent_path() / name;
        const int file = open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        if (file >= 0) {
            close(file);
            return temporary;
        }
        if (errno != EEXIST) {
            const std::string reason = std::generic_category().message(errno);
            fail(Failure::file, "{}: cannot write into its folder: {}", target.string(), reason);
        }
    }
}

/// The temporary files of this process, for an interrupt to remove.
struct Temporaries {
    std::mutex mutex;
    std::set<fs::path> paths;
};

/// Never destroyed: an interrupt may come while the program's other objects end.
Temporaries& temporaries() {
    static auto& all = *new Temporaries;
    return all;
}

/// A new temporary file; removed at the end of the scope unless it has been renamed away.
struct TemporaryFile {
    fs::path path;

    explicit TemporaryFile(const fs::path& target) {
        const std::lock_guard lock(temporaries().mutex); // an interrupt finds no file that is not listed
        path = makeTemporary(target);
        temporaries().paths.insert(path);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        const std::lock_guard lock(temporaries().mutex);
        temporaries().paths.erase(path);
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

[[noreturn]] void exitInterrupted(int signal) {
    const std::lock_guard lock(temporaries().mutex); // kept to the end: nobody makes another one
    std::error_code ignored;
    for (const fs::path& path : temporaries().paths) fs::remove(path, ignored);
    fmt::print(stderr, "relief: interrupted\n");
    _exit(128 + signal);
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void failToRead(const std::string& path) {
    fail(Failure::file, "{}: cannot be read: {}", path, std::generic_category().message(errno));
}

[[noreturn]] void failToWrite(const std::string& path) {
    fail(Failure::file, "{}: cannot be written: {}", path, std::generic_category().message(errno));
}

[[noreturn]] void failTooLong(const std::string& path, std::uint64_t limit) {
    fail(Failure::input, "{}: the file is longer than {}, the most that is read", path, humanBytes(limit));
}

} // namespace

void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
    const fs::path target = resolveTarget(path);
    const TemporaryFile temporary(target);
    write(temporary.path.string());
    std::error_code error;
    fs::rename(temporary.path, target, error);
    if (error) fail(Failure::file, "{}: cannot be written: {}", path, error.message());
}

void checkWritable(const std::string& path) { const TemporaryFile attempt(resolveTarget(path)); }

void writeFile(const std::string& path, std::string_view bytes) {
    writeWhole(path, [&](const std::string& temporary) {
        std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
        if (!file) failToWrite(path);
        if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failToWrite(path);
        if (std::fclose(file.release()) != 0) failToWrite(path); // a full disk may show only here
    });
}

void endCleanlyOnInterrupt() {
    sigset_t watched;
    sigemptyset(&watched);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction current {};
        sigaction(signal, nullptr, &current);
        if (current.sa_handler != SIG_IGN) sigaddset(&watched, signal); // as under nohup and in a script's background
    }
    // A thread that waits may lock and allocate, which a signal handler must not.
    pthread_sigmask(SIG_BLOCK, &watched, nullptr);
    std::thread([watched] {
        int signal = 0;
        sigwait(&watched, &signal);
        exitInterrupted(signal);
    }).detach();
}

std::string readFile(const std::string& path, std::uint64_t limit) {
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
    if (!file) failToRead(path);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error); // fails for pipes, which are read until they end
    if (!error && size > limit) failTooLong(path, limit);

    std::string bytes;
    if (!error) bytes.reserve(size);
    std::vector<char> block(1 << 16);
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
        if (bytes.size() + count > limit) failTooLong(path, limit);
        bytes.append(block.data(), count);
    }
    if (std::ferror(file.get())) failToRead(path);
    return bytes;
}

} // namespace relief
