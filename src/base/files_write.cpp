// Output files, written whole or not at all.
#include "base/base.h"
#include "base/files_together.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace relief {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40; ///< each to the next: the limit that the system has, too

[[noreturn]] void failToWrite(const std::string& path, int error) {
    fail(Failure::file, "{}: cannot be written: {}", path, std::generic_category().message(error));
}

/// Where the bytes really go: a link keeps pointing where it points, and what it points to is made where it is not
/// there yet. Devices and folders are refused, because the final rename would replace them; so are files that may not
/// be written, which it would replace too.
fs::path resolveTarget(const std::string& path) {
    if (path.empty()) fail(Failure::usage, "the output file has no name");
    std::error_code ignored;
    const fs::file_status end = fs::status(path, ignored);
    if (fs::exists(end) && !fs::is_regular_file(end))
        fail(Failure::file, "{}: cannot be written: it is not an ordinary file", path);
    fs::path target(path);
    for (int links = 0; links <= kMostLinks; ++links) {
        struct stat status {};
        if (lstat(target.c_str(), &status) != 0) {
            if (errno != ENOENT) failToWrite(path, errno);
            return target;
        }
        if (!S_ISLNK(status.st_mode)) {
            if (faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) failToWrite(path, errno);
            return target;
        }
        target = target.parent_path() / fs::read_symlink(target);
    }
    failToWrite(path, ELOOP);
}

/// A new file that is to replace another. It has no name until then where the system supports such files; a process
/// that is killed leaves nothing of those behind.
class NewFile {
public:
    explicit NewFile(fs::path target);
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;
    ~NewFile() {
        if (file_ >= 0) close(file_);
    }

    /// The name by which this process and its children open it. It is not the file's own name even where it has one:
    /// once an interrupt has removed that, no child can create it again.
    [[nodiscard]] std::string path() const { return hasDescriptorNames() ? descriptorName() : name_->path(); }

    /// Gives it a name beside the target, unless it has one, and closes it.
    void takeName();
    /// Renames it to the target.
    void takePlace();

private:
    [[nodiscard]] std::string descriptorName() const { return fmt::format("/proc/{}/fd/{}", getpid(), file_); }
    [[nodiscard]] bool hasDescriptorNames() const { return access(descriptorName().c_str(), F_OK) == 0; }
    [[nodiscard]] fs::path folder() const { return target_.has_parent_path() ? target_.parent_path() : "."; }
    std::string makeNamed(const std::function<bool(const std::string& name)>& make) const;
    void openNameless();
    void openNamed();
    void takePermissions() const;

    fs::path target_;
    int file_ = -1;
    std::optional<Temporary> name_;
};

NewFile::NewFile(fs::path target) : target_(std::move(target)) {
    openNameless();
    if (file_ < 0)
        openNamed(); // some file systems have no files without a name; this call also reports what else may be wrong
    takePermissions();
}

void NewFile::openNameless() {
    file_ = open(folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (file_ >= 0 && !hasDescriptorNames()) close(std::exchange(file_, -1)); // nobody could open it
}

void NewFile::openNamed() {
    name_.emplace([&] {
        return makeNamed([&](const std::string& name) {
            file_ = open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
            return file_ >= 0;
        });
    });
}

/// Tries names in the target's folder until `make` has made one that nobody else uses.
std::string NewFile::makeNamed(const std::function<bool(const std::string& name)>& make) const {
    static std::atomic<unsigned> counter{0};
    for (;;) {
        std::string name = folder() / fmt::format(".relief-{}-{}", getpid(), counter++);
        if (make(name)) return name;
        if (errno != EEXIST)
            fail(Failure::file, "{}: cannot write into its folder: {}", target_.string(),
                 std::generic_category().message(errno));
    }
}

/// Gives the new file the owner and the permissions of the one that it replaces, as far as the system permits it.
void NewFile::takePermissions() const {
    struct stat old {};
    if (stat(target_.c_str(), &old) != 0) return;
    [[maybe_unused]] const int ownerError = fchown(file_, old.st_uid, old.st_gid);
    [[maybe_unused]] const int modeError = fchmod(file_, old.st_mode & 0777);
}

void NewFile::takeName() {
    if (!name_)
        name_.emplace([&] {
            return makeNamed([&](const std::string& name) {
                return linkat(AT_FDCWD, descriptorName().c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
            });
        });
    if (file_ >= 0) close(std::exchange(file_, -1));
}

void NewFile::takePlace() {
    takeName();
    if (std::rename(name_->path().c_str(), target_.c_str()) != 0) failToWrite(target_.string(), errno);
}

/// What waits on this thread, while there is a FilesTogether.
thread_local std::vector<std::unique_ptr<NewFile>> waitingFiles;
thread_local bool filesWait = false;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

} // namespace

void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
    auto file = std::make_unique<NewFile>(resolveTarget(path));
    write(file->path());
    if (!filesWait) return file->takePlace();
    constexpr std::size_t kMostOpen = 256; // a process may have a thousand files open
    if (waitingFiles.size() >= kMostOpen) file->takeName();
    waitingFiles.push_back(std::move(file));
}

FilesTogether::FilesTogether() {
    RELIEF_CHECK(!filesWait);
    filesWait = true;
}

FilesTogether::~FilesTogether() {
    filesWait = false;
    waitingFiles.clear();
}

void FilesTogether::takePlaces() {
    for (const std::unique_ptr<NewFile>& file : waitingFiles) file->takeName();
    for (const std::unique_ptr<NewFile>& file : waitingFiles) file->takePlace();
    waitingFiles.clear();
}

void checkWritable(const std::string& path) { const NewFile attempt(resolveTarget(path)); }

void writeFile(const std::string& path, std::string_view bytes) {
    writeWhole(path, [&](const std::string& temporary) {
        std::unique_ptr<std::FILE, CloseFile> file(std::fopen(temporary.c_str(), "wb"));
        if (!file) failToWrite(path, errno);
        if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failToWrite(path, errno);
        if (std::fclose(file.release()) != 0) failToWrite(path, errno); // a full disk may show only here
    });
}

} // namespace relief
