// Files: reading with limits, writing whole or not at all, temporary files that an interrupt removes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace relief {

/// A regular file, open for reading. All input comes through it: folders, pipes, sockets and devices are refused
/// before anything waits for them.
class InputFile {
public:
    /// Throws Failure::file when the file cannot be opened or is not a regular file.
    explicit InputFile(std::string path);
    InputFile(InputFile&& other) noexcept;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::uint64_t size() const { return size_; } ///< bytes when it was opened
    /// Reads up to `count` bytes from `offset` on and returns how many; fewer only where the file ends.
    /// Throws Failure::file.
    std::size_t read(std::uint64_t offset, void* bytes, std::size_t count) const;

private:
    std::string path_;
    std::uint64_t size_ = 0;
    int file_ = -1;
};

/// Reads the whole file. Throws Failure::file, or Failure::input when it is longer than `limit` bytes.
std::string readFile(const std::string& path, std::uint64_t limit = 1ull << 32);

/// Calls `write` with the name of an empty temporary file, then renames that to `path`; on any exception `path` is as
/// it was before.
/// The temporary file is made in the target's folder, without a name where the system can do that, so that a process
/// that is killed leaves nothing behind. Symbolic links are followed, also to a file that does not exist yet; an
/// existing file keeps its permissions.
/// Throws Failure::file when the folder or the file cannot be written or `path` is not a file (a folder, a device).
void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// Throws what writeWhole would throw for a `path` that cannot be written, and leaves no file behind. Call it before
/// long work whose result goes there.
void checkWritable(const std::string& path);

/// Writes `bytes` as the file `path`, whole or not at all. Throws Failure::file when writing fails.
void writeFile(const std::string& path, std::string_view bytes);

/// The folder of what may be made again, such as compiled shaders: $RELIEF_CACHE, else relief in $XDG_CACHE_HOME or in
/// $HOME/.cache. Empty where RELIEF_CACHE is 0 or none of them is set to an absolute path. It need not exist.
std::string cacheFolder();

/// A file or folder that is removed, with all that is in it, at the end of the scope or by an interrupt before.
class Temporary {
public:
    /// `make` creates it and returns its path. Interrupts wait until it is listed for removal.
    explicit Temporary(const std::function<std::string()>& make);
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary();

    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// From now on an interrupt (SIGINT, SIGTERM, SIGHUP) removes everything temporary and ends the program with exit code
/// 128 + the signal's number: 130 for Ctrl-C. Call it first in main: threads that run already are not covered.
void endCleanlyOnInterrupt();
/// Ends the process with a line on stderr, from any thread: temporary files go, destructors do not run.
[[noreturn]] void endAtOnce(std::string_view line, int exitCode);

} // namespace relief
