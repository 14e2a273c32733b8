#include "view/process.h"

#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace relief {
namespace {

std::string makeFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "relief-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) fail(Failure::file, "{}: no folder can be made there", path);
    return path;
}

std::string printedPath(const Temporary& folder) { return folder.path() + "/printed"; }

} // namespace

Process::Process(std::vector<std::string> words) : folder_(std::make_unique<Temporary>(makeFolder)) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const std::string printed = printedPath(*folder_);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, printed.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = -1;
    const int error = posix_spawn(&child, "/proc/self/exe", &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) fail(Failure::device, "no more processes can be started");
    id_ = child;
}

std::optional<int> Process::poll() {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) != id_) return {};
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string Process::output() const {
    const std::string path = printedPath(*folder_);
    return std::filesystem::exists(path) ? readFile(path) : "";
}

} // namespace relief
