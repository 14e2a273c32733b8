// Events in their order: the user's, or those of a file, which wait for what they are about.
#include "view/viewer.h"

namespace relief {

void Viewer::takeEvents(double now) {
    std::deque<Event>& live = window_.events();
    if (!played_.empty()) {
        live.clear(); // the user's own wait until the file has been played
        if (takePlayed(now)) uiFrames_ = kFramesAfterEvent;
        return;
    }
    // Panels see each press by itself, and at the place that the cursor has moved to.
    bool hasMoved = false;
    while (!live.empty()) {
        const Event event = live.front();
        if (event.kind == EventKind::press && hasMoved) return;
        live.pop_front();
        record(event);
        // What the desktop has done to the window is done; it may have changed its mind since.
        const bool isOfDesktop =
            event.kind == EventKind::size || event.kind == EventKind::minimise || event.kind == EventKind::restore;
        if (!isOfDesktop) apply(event);
        uiFrames_ = kFramesAfterEvent;
        hasMoved = hasMoved || event.kind == EventKind::move;
        if (event.kind != EventKind::move && event.kind != EventKind::wheel) return;
    }
}

/// Applies the next played event if it is its turn; returns whether it was.
bool Viewer::takePlayed(double now) {
    const Event event = played_.front();
    const bool isResting = pacing_.isAtRest() && uiFrames_ == 0 && framesToPlay_ == 0 && !loader_.isBusy() &&
                           !otherLoader_.isBusy() && !check_;
    // Events that wait stay in front of the queue until what they wait for has happened.
    switch (event.kind) {
    case EventKind::rest:
        if (isResting) played_.pop_front();
        pacing_.settle();
        return false;
    case EventKind::wait:
        if (playedUntil_ == 0) playedUntil_ = now + event.at.x;
        if (now < playedUntil_) return false;
        playedUntil_ = 0;
        played_.pop_front();
        return false;
    case EventKind::frames:
        framesToPlay_ = int(event.at.x);
        played_.front() = {.kind = EventKind::wait}; // goes on once they are drawn
        playedUntil_ = 0;
        return false;
    case EventKind::point:
        if (framesToPlay_ > 0) return false;
        if (state_.reveals.empty()) { // the panel scrolls there first
            state_.reveals = event.text, framesToPlay_ = kFramesAfterEvent;
            return false;
        }
        break;
    default: break;
    }
    // All others act at once, one per frame, as a person's would.
    if (framesToPlay_ > 0) return false;
    played_.pop_front();
    record(event);
    apply(event.kind == EventKind::point ? toMove(event) : event);
    return event.kind != EventKind::report;
}

/// Writes an event, and before it that the picture was at rest, so that the session plays the same on any device.
void Viewer::record(const Event& event) {
    if (!record_.is_open()) return;
    if (pacing_.isAtRest() && report_.pictureCount != recordedPictures_) {
        record_ << toLine({.kind = EventKind::rest}) << '\n';
        recordedPictures_ = report_.pictureCount;
    }
    record_ << toLine(event) << '\n' << std::flush;
}

/// The cursor's way to a widget that was drawn last.
Event Viewer::toMove(const Event& event) {
    state_.reveals.clear();
    const auto found = places_.find(event.text);
    if (found == places_.end()) fail(Failure::input, "{}: there is no widget \"{}\" now", desc_.play, event.text);
    const Place& place = found->second;
    return {.kind = EventKind::move,
            .at = {glm::mix(place.low.x, place.high.x, event.at.x), 0.5 * (place.low.y + place.high.y)}};
}

} // namespace relief
