// Reads the table of modules in CMakeLists.txt and the includes of the sources.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace relief::test {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

inline const fs::path kProject = RELIEF_SOURCE;

struct Line {
    std::string file; ///< relative to the project
    int number = 0;
    std::string text;
};

inline std::vector<Line> linesOf(const fs::path& project, const std::string& file) {
    std::ifstream stream(project / file);
    std::vector<Line> lines;
    for (std::string text; std::getline(stream, text);) lines.push_back({file, int(lines.size()) + 1, text});
    return lines;
}

/// Every line of every file below a folder of the project.
inline std::vector<Line> linesBelow(const fs::path& project, const std::string& folder) {
    Names files;
    for (const auto& entry : fs::recursive_directory_iterator(project / folder))
        if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), project).string());
    std::vector<Line> lines;
    for (const std::string& file : files)
        for (Line& line : linesOf(project, file)) lines.push_back(std::move(line));
    return lines;
}

inline Names wordsOf(const std::string& text) {
    std::istringstream stream(text);
    Names words;
    for (std::string word; stream >> word;) words.insert(word);
    return words;
}

/// What each module USES, from the lines `add_module(NAME USES modules... LINKS libraries...)`.
using Modules = std::map<std::string, Names>;

inline Modules modulesOf(const std::vector<Line>& cmake) {
    static const std::regex call(R"(^add_module\((\w+)(?: USES ([\w ]+?))?(?: LINKS [^)]*)?\))");
    Modules modules;
    for (const Line& line : cmake)
        if (std::smatch found; std::regex_search(line.text, found, call)) modules[found[1]] = wordsOf(found[2]);
    return modules;
}

/// The folder below src or shaders that a file lies in: src/cage/cage.h is of cage, src/relief.h of "".
inline std::string moduleOf(const std::string& file) {
    const fs::path path(file);
    std::vector<std::string> parts;
    for (const fs::path& part : path) parts.push_back(part.string());
    return parts.size() > 2 ? parts[1] : "";
}

/// Who may include what: itself, what it USES, and what both sides of the bus share. The commands may include all.
inline Names allowedFor(const std::string& module, const Modules& modules) {
    Names allowed{module, "shared"};
    if (module == "shared") allowed = {"shared", "base"};
    if (const auto found = modules.find(module); found != modules.end())
        allowed.insert(found->second.begin(), found->second.end());
    if (module == "app" || module.empty())
        for (const auto& [name, uses] : modules) allowed.insert(name);
    return allowed;
}

/// One line `file:line: ...` for each include that the table does not allow.
inline std::vector<std::string> forbiddenIncludes(const std::vector<Line>& sources, const Modules& modules) {
    static const std::regex include(R"re(^\s*#\s*include\s*("(?:([^"/]+)/)?[^"]*"))re");
    std::vector<std::string> found;
    for (const Line& line : sources) {
        std::smatch match;
        if (!std::regex_search(line.text, match, include)) continue;
        const std::string module = moduleOf(line.file), target = match[2];
        const Names allowed = allowedFor(module, modules);
        if (allowed.contains(target)) continue;
        found.push_back(fmt::format("{}:{}: {} may not include {}; it may include {}", line.file, line.number,
                                    module.empty() ? "this file" : module, match[1].str(), fmt::join(allowed, ", ")));
    }
    return found;
}

} // namespace relief::test
