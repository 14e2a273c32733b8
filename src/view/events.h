// Internal: what a user does in the window, as lines of text that can be recorded and played again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/base.h"

namespace relief {

enum class Button { left, right, middle };

inline constexpr Word<Button> kButtons[] = {
    {"left", Button::left, "turn; with shift move, with control turn the light"},
    {"middle", Button::middle, "move"},
    {"right", Button::right, "zoom; with control turn the environment"},
};

enum class EventKind {
    move,
    point,
    press,
    release,
    wheel,
    key,
    text,
    drop,
    size,
    minimise,
    restore,
    frame,
    rest,
    wait,
    frames,
    screenshot,
    report,
    close
};

inline constexpr Word<EventKind> kEventKinds[] = {
    {"move", EventKind::move, "X Y: the cursor, in pixels from the upper left corner"},
    {"point", EventKind::point, "SHARE WIDGET: the cursor to a widget, at that share of its width, 0..1"},
    {"press", EventKind::press, "BUTTON, and shift or control where they are held"},
    {"release", EventKind::release, "BUTTON"},
    {"wheel", EventKind::wheel, "STEPS, positive away from the user"},
    {"key", EventKind::key, "NAME"},
    {"text", EventKind::text, "what is typed"},
    {"drop", EventKind::drop, "FILE"},
    {"size", EventKind::size, "W H: the window, in pixels"},
    {"minimise", EventKind::minimise, "the window, where the desktop does that"},
    {"restore", EventKind::restore, "a minimised window"},
    {"frame", EventKind::frame, "K: the time line"},
    {"rest", EventKind::rest, "until the full picture is shown"},
    {"wait", EventKind::wait, "SECONDS"},
    {"frames", EventKind::frames, "N frames, drawn without waiting"},
    {"screenshot", EventKind::screenshot, "FILE"},
    {"report", EventKind::report, "prints what was drawn so far"},
    {"close", EventKind::close, "the window"},
};

struct Event {
    EventKind kind = EventKind::move;
    dvec2 at{0};                                  ///< move, size; of a wheel, a time, a share or a count in x
    Button button{};                              ///< press, release
    int key = 0;                                  ///< a value of kKeys
    bool isShifted = false, isControlled = false; ///< press
    std::string text;                             ///< text, drop, screenshot; the label of a widget
};

/// Reads one line. Nothing for an empty one and for a comment after '#'.
/// Throws Failure::input with `place`, such as "file:3", for a line that is no event.
std::optional<Event> parseEvent(const std::string& line, const std::string& place);
/// Reads a file of events, one per line. Throws as readFile and parseEvent do.
std::vector<Event> readEvents(const std::string& path);
/// The line that parseEvent reads as the same event.
std::string toLine(const Event& event);

} // namespace relief
