#include "base/base.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

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

/// Removes the file unless it has been renamed away.
struct TemporaryFile {
    fs::path path;

    explicit TemporaryFile(fs::path path) : path(std::move(path)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

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
    const TemporaryFile temporary(makeTemporary(target));
    write(temporary.path.string());
    std::error_code error;
    fs::rename(temporary.path, target, error);
    if (error) fail(Failure::file, "{}: cannot be written: {}", path, error.message());
}

void writeFile(const std::string& path, std::string_view bytes) {
    writeWhole(path, [&](const std::string& temporary) {
        std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
        if (!file) failToWrite(path);
        if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failToWrite(path);
        if (std::fclose(file.release()) != 0) failToWrite(path); // a full disk may show only here
    });
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
