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

/// A line `add_module(NAME USES modules... OFFERS headers... LINKS libraries...)`.
struct Module {
    Names uses;   ///< modules
    Names offers; ///< headers besides NAME.h that other modules may include

    bool operator==(const Module&) const = default;
};
using Modules = std::map<std::string, Module>;

inline Modules modulesOf(const std::vector<Line>& cmake) {
    static const std::regex call(R"(^add_module\((\w+)([^)]*)\))");
    Modules modules;
    for (const Line& line : cmake) {
        std::smatch found;
        if (!std::regex_search(line.text, found, call)) continue;
        Module& module = modules[found[1]];
        Names others;
        Names* list = &others;
        std::istringstream words(found[2]);
        for (std::string word; words >> word;)
            if (word == "USES")
                list = &module.uses;
            else if (word == "OFFERS")
                list = &module.offers;
            else if (word == "LINKS")
                list = &others;
            else
                list->insert(word);
    }
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
        allowed.insert(found->second.uses.begin(), found->second.uses.end());
    if (module == "app" || module.empty())
        for (const auto& [name, module] : modules) allowed.insert(name);
    return allowed;
}

/// The file that an include names in quotes; "" for other lines.
inline std::string includedFile(const std::string& text) {
    static const std::regex include(R"re(^\s*#\s*include\s*"([^"]+)")re");
    std::smatch found;
    return std::regex_search(text, found, include) ? found[1].str() : "";
}

/// Headers of a module that everybody may include: NAME.h and what that includes of its own folder, as "base/files.h".
inline Names publicHeaders(const fs::path& project, const std::string& module) {
    Names headers{module + "/" + module + ".h"};
    std::vector<std::string> open(headers.begin(), headers.end());
    while (!open.empty()) {
        const std::string header = open.back();
        open.pop_back();
        for (const Line& line : linesOf(project, "src/" + header)) {
            const std::string file = includedFile(line.text);
            if (file.starts_with(module + "/") && headers.insert(file).second) open.push_back(file);
        }
    }
    return headers;
}

/// One line for each include of a header that is internal to another module than the including file's.
inline std::vector<std::string> internalIncludes(const fs::path& project, const std::vector<Line>& sources,
                                                 const Modules& modules) {
    std::map<std::string, Names> open;
    for (const auto& [name, module] : modules) {
        open[name] = publicHeaders(project, name);
        for (const std::string& header : module.offers) open[name].insert(name + "/" + header);
    }
    std::vector<std::string> found;
    for (const Line& line : sources) {
        const std::string file = includedFile(line.text), target = file.substr(0, file.find('/'));
        // Helpers of tests lie in folders of the same names.
        if (!modules.contains(target) || target == moduleOf(line.file) || !fs::exists(project / "src" / file)) continue;
        if (!open[target].contains(file))
            found.push_back(fmt::format("{}:{}: {} is internal to {}", line.file, line.number, file, target));
    }
    return found;
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
