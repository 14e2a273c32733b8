// Input files: one function checks what kind of file it is; files are read in steps of bounded size.
#include "base/base.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace relief {

namespace {

constexpr std::size_t kStepBytes = 1 << 20; ///< what is read at once

[[noreturn]] void failToRead(const std::string& path) {
    fail(Failure::file, "{}: cannot be read: {}", path, std::generic_category().message(errno));
}

[[noreturn]] void failTooLong(const std::string& path, std::uint64_t limit) {
    fail(Failure::input, "{}: the file is longer than {}, the most that is read", path, humanBytes(limit));
}

const char* kindOf(mode_t mode) {
    if (S_ISDIR(mode)) return "directory";
    if (S_ISFIFO(mode)) return "pipe";
    if (S_ISSOCK(mode)) return "socket";
    return "device";
}

void checkRegular(const std::string& path, const struct stat& status) {
    if (S_ISDIR(status.st_mode)) fail(Failure::file, "{}: cannot be read: it is a directory", path);
    if (!S_ISREG(status.st_mode))
        fail(Failure::file, "{}: cannot be read: it is a {}; only regular files are read, so write it into one first",
             path, kindOf(status.st_mode));
}

std::string folderOf(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && value[0] == '/' ? value : "";
}

} // namespace

InputFile::InputFile(std::string path) : path_(std::move(path)) {
    // Checked before opening, which can set a device to work and wakes whoever waits to write into a pipe.
    struct stat status {};
    if (stat(path_.c_str(), &status) != 0) failToRead(path_);
    checkRegular(path_, status);
    // Checked again after opening, because the name may stand for another file by now. O_NONBLOCK: that may be a pipe.
    file_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file_ < 0) failToRead(path_);
    try {
        if (fstat(file_, &status) != 0) failToRead(path_);
        checkRegular(path_, status);
    } catch (...) {
        close(file_);
        throw;
    }
    size_ = std::uint64_t(status.st_size);
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)), size_(other.size_), file_(std::exchange(other.file_, -1)) {}

InputFile::~InputFile() {
    if (file_ >= 0) close(file_);
}

std::size_t InputFile::read(std::uint64_t offset, void* bytes, std::size_t count) const {
    std::size_t done = 0;
    while (done < count) {
        const std::size_t step = std::min(count - done, kStepBytes);
        const ssize_t got = pread(file_, static_cast<char*>(bytes) + done, step, off_t(offset + done));
        if (got < 0) failToRead(path_);
        if (got == 0) break;
        done += std::size_t(got);
    }
    return done;
}

std::string readFile(const std::string& path, std::uint64_t limit) {
    const InputFile file(path);
    if (file.size() > limit) failTooLong(path, limit);
    std::string bytes;
    bytes.reserve(file.size());
    // Up to its end, wherever that is: the system's own files have no size, and others may grow.
    std::vector<char> step(std::min<std::uint64_t>(file.size() + 1, kStepBytes));
    while (const std::size_t count = file.read(bytes.size(), step.data(), step.size())) {
        if (bytes.size() + count > limit) failTooLong(path, limit);
        bytes.append(step.data(), count);
    }
    return bytes;
}

std::string cacheFolder() {
    const char* choice = std::getenv("RELIEF_CACHE");
    if (choice != nullptr && std::string_view(choice) == "0") return "";
    if (const std::string folder = folderOf("RELIEF_CACHE"); !folder.empty()) return folder;
    if (const std::string cache = folderOf("XDG_CACHE_HOME"); !cache.empty()) return cache + "/relief";
    const std::string home = folderOf("HOME");
    return home.empty() ? "" : home + "/.cache/relief";
}

} // namespace relief
