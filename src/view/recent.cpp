#include "view/recent.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/base.h"

namespace relief {
namespace {

constexpr std::size_t kMostRecent = 8;
constexpr std::uint64_t kMostBytes = 1 << 16;

std::string listPath() {
    const std::string folder = cacheFolder();
    return folder.empty() ? "" : folder + "/recent";
}

} // namespace

std::vector<std::string> readRecent() {
    std::vector<std::string> paths;
    std::error_code error;
    if (listPath().empty() || !std::filesystem::is_regular_file(listPath(), error)) return paths;
    try {
        std::istringstream lines(readFile(listPath(), kMostBytes));
        for (std::string line; std::getline(lines, line) && paths.size() < kMostRecent;)
            if (std::filesystem::path(line).is_absolute() && std::filesystem::is_regular_file(line, error))
                paths.push_back(line);
    } catch (const Error&) { // a list of conveniences is no reason to close
        paths.clear();
    }
    return paths;
}

void addRecent(const std::string& path) {
    std::error_code error;
    const std::string whole = std::filesystem::absolute(path, error).lexically_normal().string();
    if (error || listPath().empty() || whole.find('\n') != whole.npos) return;
    std::vector<std::string> paths = readRecent();
    if (!paths.empty() && paths.front() == whole) return;
    std::erase(paths, whole);
    paths.insert(paths.begin(), whole);
    if (paths.size() > kMostRecent) paths.resize(kMostRecent);
    std::filesystem::create_directories(cacheFolder(), error);
    try {
        writeFile(listPath(), fmt::format("{}\n", fmt::join(paths, "\n")));
    } catch (const Error&) {
        return; // as for reading
    }
}

} // namespace relief
