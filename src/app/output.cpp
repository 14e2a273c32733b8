#include "app/output.h"

#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

#include "animation/animation.h"
#include "app/options.h"

namespace relief::app {
namespace {

/// Whether `path` is a file of the numbered sequence `pattern`: a number stands where that has braces.
bool matchesPattern(const std::string& pattern, const std::string& path) {
    const std::size_t open = pattern.find('{'), close = pattern.find('}');
    if (!isFramePattern(pattern) || close == std::string::npos) return false;
    const std::string before = pattern.substr(0, open), after = pattern.substr(close + 1);
    if (path.size() <= before.size() + after.size()) return false;
    const std::string number = path.substr(before.size(), path.size() - before.size() - after.size());
    return path.starts_with(before) && path.ends_with(after) &&
           number.find_first_not_of("-0123456789") == std::string::npos;
}

bool isSameFile(const std::string& input, const std::string& target) {
    std::error_code ignored;
    return std::filesystem::equivalent(input, target, ignored) || matchesPattern(input, target);
}

} // namespace

void addOutput(CLI::App& app, Output& output) {
    const char* group = "output";
    app.add_flag("--json", output.isJson, "print the result as JSON on stdout")->group(group);
    app.add_flag("-q,--quiet", output.isQuiet, "print no warnings and no summary")->group(group);
    app.add_flag("-v,--verbose", output.isVerbose, "print the time of every step")->group(group);
    addProgress(app, output.progress);
}

void addProgress(CLI::App& app, ShowProgress& progress) {
    listIn("output", "WHEN", addEnum(app, "--progress", progress, kProgressWords, "when progress is shown on stderr"));
}

Warn makeWarn(bool isQuiet) {
    if (isQuiet) return [](const std::string&) {};
    return [printed = std::make_shared<std::set<std::string>>()](const std::string& line) {
        if (printed->insert(line).second) warnOnStderr(line);
    };
}

void checkOutput(const std::string& target, const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs)
        if (isSameFile(input, target))
            fail(Failure::usage, "{}: the output would replace an input; give it another name", target);
    checkWritable(target);
}

void printJson(const nlohmann::json& value) {
    std::cout << value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void finishStdout() {
    if (!std::cout.flush())
        fail(Failure::file, "the result cannot be written to stdout; is it closed, or the disk full?");
}

void checkValidation(const Device& device) {
    const std::size_t count = device.validationMessages().size();
    if (count > 0) fail(Failure::internal, "the Vulkan validation layer has {} complaints", count);
}

} // namespace relief::app
