// A window manager for tests, of what minimising needs: under Xvfb alone nobody minimises a window.
#pragma once

#include <atomic>
#include <thread>

namespace relief::test {

/// Maps and unmaps the windows of the display that DISPLAY names, and says so by WM_STATE (ICCCM 2.0, section 4.1.4).
/// It has to end before the display does.
class WindowManager {
public:
    WindowManager();
    ~WindowManager();
    WindowManager(const WindowManager&) = delete;
    WindowManager& operator=(const WindowManager&) = delete;

    /// Destroys all windows of the display, whoever they belong to.
    static void destroyWindows();

private:
    std::atomic<bool> isReady_ = false, isEnding_ = false;
    std::thread thread_;
};

} // namespace relief::test
