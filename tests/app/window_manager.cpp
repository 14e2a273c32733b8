#include "window_manager.h"

#include <chrono>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace relief::test {
namespace {

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

void setState(::Display* display, ::Window window, long state) {
    const Atom name = XInternAtom(display, "WM_STATE", 0);
    const long words[] = {state, 0}; // without a window for the icon
    XChangeProperty(display, window, name, name, 32, PropModeReplace, reinterpret_cast<const unsigned char*>(words), 2);
}

void answer(::Display* display, XEvent& event) {
    if (event.type == MapRequest) {
        XMapWindow(display, event.xmaprequest.window);
        setState(display, event.xmaprequest.window, NormalState);
    } else if (event.type == ConfigureRequest) {
        const XConfigureRequestEvent& asked = event.xconfigurerequest;
        XWindowChanges changes{asked.x,     asked.y,     asked.width, asked.height, asked.border_width,
                               asked.above, asked.detail};
        XConfigureWindow(display, asked.window, unsigned(asked.value_mask), &changes);
    } else if (event.type == ClientMessage) {
        const XClientMessageEvent& message = event.xclient;
        if (message.message_type != XInternAtom(display, "WM_CHANGE_STATE", 0)) return;
        XUnmapWindow(display, message.window);
        setState(display, message.window, message.data.l[0]);
    }
}

} // namespace

WindowManager::WindowManager()
    : thread_([this] {
          XSetErrorHandler([](::Display*, XErrorEvent*) { return 0; }); // of windows that are gone meanwhile
          ::Display* display = XOpenDisplay(nullptr);
          if (display != nullptr) {
              XSelectInput(display, DefaultRootWindow(display), SubstructureRedirectMask | SubstructureNotifyMask);
              XSync(display, 0);
          }
          for (isReady_ = true; display != nullptr && !isEnding_; pause())
              while (XPending(display) > 0) {
                  XEvent event;
                  XNextEvent(display, &event);
                  answer(display, event);
              }
          if (display != nullptr) XCloseDisplay(display);
      }) {
    while (!isReady_) pause();
}

void WindowManager::destroyWindows() {
    ::Display* display = XOpenDisplay(nullptr);
    if (display == nullptr) return;
    ::Window root = 0, parent = 0, *windows = nullptr;
    unsigned count = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &windows, &count);
    for (unsigned i = 0; i < count; ++i) XDestroyWindow(display, windows[i]);
    XFree(windows);
    XCloseDisplay(display);
}

WindowManager::~WindowManager() {
    isEnding_ = true;
    thread_.join();
}

} // namespace relief::test
