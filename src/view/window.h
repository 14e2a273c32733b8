// Internal: a window of the desktop, by GLFW.
#pragma once

#include <deque>
#include <functional>

#include <vulkan/vulkan.h>

#include "view/events.h"

struct GLFWwindow;

namespace relief {

class Window {
public:
    /// Throws Failure::device where there is no display, or it has no Vulkan.
    Window(const std::string& title, const ivec2& size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Extensions of an instance that surface() needs.
    [[nodiscard]] static std::vector<const char*> listExtensions();
    [[nodiscard]] VkSurfaceKHR makeSurface(VkInstance instance) const;

    [[nodiscard]] bool isClosing() const;
    [[nodiscard]] ivec2 size() const; ///< pixels; 0 while it is minimised
    [[nodiscard]] bool isMinimised() const { return isMinimised_; }
    /// Asks the desktop to minimise the window, or to show it again. It does so later, or not at all.
    void minimise(bool isMinimised);
    void resize(const ivec2& size);
    void hide();
    void setTitle(const std::string& title);
    void copyText(const std::string& text);

    /// Waits at most so many seconds for events; 0: not at all.
    void waitForEvents(double seconds);
    /// What has happened since, in order.
    std::deque<Event>& events() { return events_; }

private:
    void listen();
    [[nodiscard]] ivec2 pixels() const; ///< also while it is minimised
    [[nodiscard]] double scale() const; ///< pixels per unit of the cursor
    void add(Event event) { events_.push_back(std::move(event)); }

    GLFWwindow* handle_ = nullptr;
    bool isMinimised_ = false;
    std::deque<Event> events_;
};

} // namespace relief
