#include "app/output.h"

#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

namespace relief::app {
namespace {

/// Whether `path` is a file of a numbered sequence: digits where the pattern has braces.
bool isOfSequence(const std::string& pattern, const std::string& path) {
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
    return std::filesystem::equivalent(input, target, ignored) || isOfSequence(input, target);
}

} // namespace

std::vector<std::string> inputsOf(const SurfaceArgs& args) {
    return {args.cage, args.height, args.pose.cache, args.pose.skin};
}

std::vector<std::string> inputsOf(const SurfaceArgs& surface, const PictureArgs& picture) {
    std::vector<std::string> inputs = inputsOf(surface);
    inputs.insert(inputs.end(), {picture.albedo, picture.environment});
    return inputs;
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

} // namespace relief::app
