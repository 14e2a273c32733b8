#include "view/process.h"

#include <filesystem>

#include <csignal>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace relief {
namespace {

std::string makeFolder() {
    std::error_code error;
    std::string path = (std::filesystem::temp_directory_path(error) / "relief-XXXXXX").string();
    if (error) fail(Failure::file, "there is no folder for temporary files: {}", error.message());
    if (mkdtemp(path.data()) == nullptr) fail(Failure::file, "{}: no folder can be made there", path);
    return path;
}

std::string printedPath(const Temporary& folder) { return folder.path() + "/printed"; }
std::string complaintsPath(const Temporary& folder) { return folder.path() + "/complaints"; }

/// Empty where the process has not begun, or the file is gone.
std::string readIfThere(const std::string& path) {
    try {
        return readFile(path);
    } catch (const Error&) {
        return "";
    }
}

} // namespace

Process::Process(std::vector<std::string> words, bool endsWithThis)
    : folder_(std::make_unique<Temporary>(makeFolder)), endsWithThis_(endsWithThis) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const std::string printed = printedPath(*folder_), complaints = complaintsPath(*folder_);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, printed.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = -1;
    const int error = posix_spawn(&child, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) fail(Failure::device, "no more processes can be started");
    id_ = child;
}

Process::~Process() {
    if (id_ > 0 && endsWithThis_) kill(id_, SIGTERM), waitpid(id_, nullptr, 0);
}

std::optional<int> Process::poll() {
    int status = 0;
    const pid_t ended = waitpid(id_, &status, WNOHANG);
    if (ended == 0) return {};
    id_ = -1;
    if (ended < 0) return 127; // where nobody keeps what has ended, such as with SIGCHLD ignored
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Process::output() const { return readIfThere(printedPath(*folder_)); }
std::string Process::complaints() const { return readIfThere(complaintsPath(*folder_)); }

} // namespace relief
