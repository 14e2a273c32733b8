#include "animation/frames.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace relief {

namespace fs = std::filesystem;

namespace {

/// Something in braces that stands for the number of the frame, or is meant to.
struct Placeholder {
    std::size_t first = 0; ///< of the opening brace
    std::string text;      ///< with its braces
    int digits = 0;        ///< 0: it is not written as it should be
};

int digitsOf(std::string_view text) {
    constexpr std::string_view kStart = "{frame:";
    if (text == "{frame}") return 1;
    const bool isRight = text.size() == kStart.size() + 2 && text.starts_with(kStart) && text.ends_with('}');
    const char digit = isRight ? text[kStart.size()] : '0';
    return digit >= '1' && digit <= '9' ? digit - '0' : 0;
}

std::vector<Placeholder> findPlaceholders(const std::string& pattern) {
    std::vector<Placeholder> placeholders;
    for (std::size_t first = pattern.find('{'); first != std::string::npos; first = pattern.find('{', first + 1)) {
        const std::size_t end = std::min(pattern.find('}', first), pattern.size() - 1);
        const std::string text = pattern.substr(first, end + 1 - first);
        const std::string word = text.substr(1, text.find_first_of(":}") - 1);
        if (!nearestWord(word, {"frame"}).empty()) placeholders.push_back({first, text, digitsOf(text)});
    }
    return placeholders;
}

Placeholder findPlaceholder(const std::string& pattern) {
    const std::vector<Placeholder> placeholders = findPlaceholders(pattern);
    if (placeholders.empty())
        fail(Failure::usage,
             "{}: the number of the frame has no place in this name; write {{frame}} or {{frame:4}} there", pattern);
    for (const Placeholder& placeholder : placeholders)
        if (placeholder.digits == 0)
            fail(Failure::usage, "{}: found '{}', expected {{frame}} or {{frame:DIGITS}} with 1 to 9 digits", pattern,
                 placeholder.text);
    if (placeholders.size() > 1)
        fail(Failure::usage, "{}: there are {} places for the number of the frame; keep one", pattern,
             placeholders.size());
    return placeholders.front();
}

std::string nameAt(const std::string& pattern, const Placeholder& placeholder, int frame) {
    const std::string number =
        fmt::format("{}{:0{}}", frame < 0 ? "-" : "", std::abs(std::int64_t(frame)), placeholder.digits);
    return std::string(pattern).replace(placeholder.first, placeholder.text.size(), number);
}

/// The frame whose file has this name; empty where no frame has it.
std::optional<int> frameOf(const std::string& pattern, const Placeholder& placeholder, const std::string& name) {
    const std::size_t rest = pattern.size() - placeholder.text.size(); // letters beside the number
    if (name.size() <= rest) return std::nullopt;
    const char* first = name.data() + placeholder.first;
    int frame = 0;
    const auto [end, error] = std::from_chars(first, first + (name.size() - rest), frame);
    if (error != std::errc() || nameAt(pattern, placeholder, frame) != name) return std::nullopt;
    return frame;
}

} // namespace

std::string frameName(const std::string& pattern, int frame) {
    return nameAt(pattern, findPlaceholder(pattern), frame);
}

bool isFramePattern(const std::string& pattern) { return !findPlaceholders(pattern).empty(); }

std::vector<int> framesOnDisk(const std::string& pattern) {
    findPlaceholder(pattern);
    const fs::path path(pattern);
    const std::string name = path.filename().string();
    if (!isFramePattern(name))
        fail(Failure::usage, "{}: the number of the frame must be in the file's name, not in its folder's", pattern);
    const Placeholder placeholder = findPlaceholder(name);

    std::vector<int> frames;
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::optional<int> frame = frameOf(name, placeholder, entry->path().filename().string());
        std::error_code ignored;
        if (frame && entry->is_regular_file(ignored)) frames.push_back(*frame);
    }
    if (error) fail(Failure::file, "{}: its folder cannot be read: {}", pattern, error.message());
    if (frames.empty()) fail(Failure::file, "{}: there is no such file, whatever the frame", pattern);
    std::sort(frames.begin(), frames.end());
    return frames;
}

} // namespace relief
