#include "view/events.h"

#include <cmath>
#include <sstream>

#include "view/keys.h"

namespace relief {
namespace {

template <typename Value, std::size_t kCount>
std::optional<Value> valueOf(const Word<Value> (&table)[kCount], const std::string& word) {
    for (const Word<Value>& row : table)
        if (row.word == word) return row.value;
    return {};
}

/// Numbers that a kind of event has after its name.
int countNumbers(EventKind kind) {
    switch (kind) {
    case EventKind::move:
    case EventKind::size: return 2;
    case EventKind::point:
    case EventKind::wheel:
    case EventKind::frame:
    case EventKind::wait:
    case EventKind::frames: return 1;
    default: return 0;
    }
}

bool hasText(EventKind kind) {
    return kind == EventKind::point || kind == EventKind::text || kind == EventKind::drop ||
           kind == EventKind::screenshot;
}

bool hasButton(EventKind kind) { return kind == EventKind::press || kind == EventKind::release; }

[[noreturn]] void refuse(const std::string& line, const std::string& place, const std::string& expected) {
    fail(Failure::input, "{}: \"{}\" is no event; expected {}", place, line, expected);
}

/// The words after the button: modifiers that are held.
void readModifiers(std::istringstream& words, Event& event, const std::string& line, const std::string& place) {
    for (std::string word; words >> word;) {
        if (word == "shift")
            event.isShifted = true;
        else if (word == "control")
            event.isControlled = true;
        else
            refuse(line, place, "shift or control after the button");
    }
}

} // namespace

std::optional<Event> parseEvent(const std::string& line, const std::string& place) {
    std::istringstream words(line);
    std::string name;
    if (!(words >> name) || name.starts_with('#')) return {};
    const std::optional<EventKind> kind = valueOf(kEventKinds, name);
    if (!kind) refuse(line, place, "move, point, press, release, wheel, key, text, drop, size, frame, rest, wait, ...");
    Event event{.kind = *kind};

    // What follows the name depends on the kind.
    for (int i = 0; i < countNumbers(*kind); ++i)
        if (!(words >> event.at[i]) || !std::isfinite(event.at[i])) refuse(line, place, "a number");
    if (*kind == EventKind::point && (event.at[0] < 0 || event.at[0] > 1))
        refuse(line, place, "a share of the widget's width, 0 to 1");
    std::string word;
    if (hasButton(*kind)) {
        const std::optional<Button> button = words >> word ? valueOf(kButtons, word) : std::nullopt;
        if (!button) refuse(line, place, "left, middle or right");
        event.button = *button;
        readModifiers(words, event, line, place);
    }
    if (*kind == EventKind::key) {
        const std::optional<int> key = words >> word ? valueOf(kKeys, word) : std::nullopt;
        if (!key) refuse(line, place, "the name of a key, such as F or Space");
        event.key = *key;
    }
    if (hasText(*kind)) {
        std::getline(words >> std::ws, event.text);
        if (event.text.empty()) refuse(line, place, "text");
    }
    return event;
}

std::vector<Event> readEvents(const std::string& path) {
    constexpr std::uint64_t kMostBytes = 1u << 26;
    std::istringstream lines(readFile(path, kMostBytes));
    std::vector<Event> events;
    int number = 0;
    for (std::string line; std::getline(lines, line);)
        if (const auto event = parseEvent(line, fmt::format("{}:{}", path, ++number))) events.push_back(*event);
    return events;
}

std::string toLine(const Event& event) {
    std::string line = wordOf(kEventKinds, event.kind);
    for (int i = 0; i < countNumbers(event.kind); ++i) line += fmt::format(" {}", event.at[i]);
    if (hasButton(event.kind)) line += fmt::format(" {}", wordOf(kButtons, event.button));
    if (event.isShifted) line += " shift";
    if (event.isControlled) line += " control";
    if (event.kind == EventKind::key) line += fmt::format(" {}", wordOf(kKeys, event.key));
    if (hasText(event.kind)) line += " " + event.text;
    return line;
}

} // namespace relief
