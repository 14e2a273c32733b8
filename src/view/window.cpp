#include "view/window.h"

#include <algorithm>
#include <string_view>

#include <dlfcn.h>

#include "base/files.h"
#include "gpu/gpu.h"
#include "view/keys.h"

namespace relief {
namespace {

std::string& lastError() {
    static std::string text;
    return text;
}

void keepError(int, const char* description) { lastError() = description; }

Window& windowOf(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

Button buttonOf(int button) {
    if (button == GLFW_MOUSE_BUTTON_RIGHT) return Button::right;
    return button == GLFW_MOUSE_BUTTON_MIDDLE ? Button::middle : Button::left;
}

/// UTF-8 of one character.
std::string encode(unsigned int code) {
    std::string text;
    if (code < 0x80)
        text += char(code);
    else if (code < 0x800)
        text += char(0xc0 | code >> 6), text += char(0x80 | (code & 63));
    else
        text += char(0xe0 | code >> 12), text += char(0x80 | (code >> 6 & 63)), text += char(0x80 | (code & 63));
    return text;
}

/// A function of a library that is loaded already, or null.
template <typename Function>
Function* findLoaded(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    return handle != nullptr ? reinterpret_cast<Function*>(dlsym(handle, name)) : nullptr;
}

/// How XErrorEvent of Xlib.h begins, whose macros would change other files.
struct XErrorStart {
    int type;
    void* display;
    unsigned long resource;
};

/// Xlib ends the process when its server goes away, even where its handler returns. This handler ends it first, with a
/// line of this program and the exit code of a lost device. GLFW has loaded the library where it shows windows by X.
void answerLostDisplay() {
    using Handler = int (*)(void*);
    if (auto* set = findLoaded<Handler(Handler)>("libX11.so.6", "XSetIOErrorHandler"))
        set([](void*) -> int { endAtOnce("relief: the display of the window is gone\n", int(Failure::device)); });
}

/// Xlib ends the process also when another program has destroyed the window. Errors about windows of others, such as
/// one that asked for the clipboard, are none of ours. GLFW takes handlers away: this one is set again and again.
void answerLostWindow(GLFWwindow* window) {
    using Handler = int (*)(void*, const XErrorStart*);
    static const auto idOf = findLoaded<unsigned long(GLFWwindow*)>("libglfw.so.3", "glfwGetX11Window");
    static const auto set = findLoaded<Handler(Handler)>("libX11.so.6", "XSetErrorHandler");
    if (idOf == nullptr || set == nullptr) return;
    static unsigned long own = 0;
    own = idOf(window);
    set([](void*, const XErrorStart* error) {
        if (error->resource == own)
            endAtOnce("relief: the window was destroyed by another program\n", int(Failure::device));
        return 0;
    });
}

} // namespace

Window::Window(const std::string& title, const ivec2& size) {
    glfwSetErrorCallback(keepError);
    if (glfwInit() != GLFW_TRUE)
        fail(Failure::device, "there is no display for a window ({}); relief render draws without one",
             lastError().empty() ? "DISPLAY is not set" : lastError());
    if (glfwVulkanSupported() != GLFW_TRUE) {
        glfwTerminate();
        fail(Failure::device, "Vulkan has no windows here: no driver presents to this display; relief render draws "
                              "without one");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    handle_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (handle_ == nullptr) {
        glfwTerminate();
        fail(Failure::device, "no window can be opened: {}", lastError());
    }
    answerLostDisplay();
    glfwSetWindowUserPointer(handle_, this);
    listen();
}

Window::~Window() {
    glfwDestroyWindow(handle_);
    glfwTerminate();
}

void Window::listen() {
    glfwSetCursorPosCallback(handle_, [](GLFWwindow* handle, double x, double y) {
        Window& window = windowOf(handle);
        window.add({.kind = EventKind::move, .at = dvec2(x, y) * window.scale()});
    });
    glfwSetMouseButtonCallback(handle_, [](GLFWwindow* handle, int button, int action, int modifiers) {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        windowOf(handle).add({.kind = action == GLFW_PRESS ? EventKind::press : EventKind::release,
                              .button = buttonOf(button),
                              .isShifted = action == GLFW_PRESS && (modifiers & GLFW_MOD_SHIFT) != 0,
                              .isControlled = action == GLFW_PRESS && (modifiers & GLFW_MOD_CONTROL) != 0});
    });
    glfwSetScrollCallback(handle_, [](GLFWwindow* handle, double, double y) {
        windowOf(handle).add({.kind = EventKind::wheel, .at = dvec2(y, 0)});
    });
    glfwSetKeyCallback(handle_, [](GLFWwindow* handle, int key, int, int action, int) {
        if (key == GLFW_KEY_KP_ADD) key = GLFW_KEY_EQUAL;
        if (key == GLFW_KEY_KP_SUBTRACT) key = GLFW_KEY_MINUS;
        if (key == GLFW_KEY_KP_ENTER) key = GLFW_KEY_ENTER;
        if (action == GLFW_RELEASE || *wordOf(kKeys, key) == 0) return;
        windowOf(handle).add({.kind = EventKind::key, .key = key});
    });
    glfwSetCharCallback(handle_, [](GLFWwindow* handle, unsigned int code) {
        windowOf(handle).add({.kind = EventKind::text, .text = encode(code)});
    });
    glfwSetDropCallback(handle_, [](GLFWwindow* handle, int count, const char** paths) {
        for (int i = 0; i < count; ++i) windowOf(handle).add({.kind = EventKind::drop, .text = paths[i]});
    });
    glfwSetFramebufferSizeCallback(handle_, [](GLFWwindow* handle, int width, int height) {
        windowOf(handle).add({.kind = EventKind::size, .at = dvec2(width, height)});
    });
    glfwSetWindowIconifyCallback(handle_, [](GLFWwindow* handle, int isMinimised) {
        windowOf(handle).isMinimised_ = isMinimised == GLFW_TRUE;
        windowOf(handle).add({.kind = isMinimised == GLFW_TRUE ? EventKind::minimise : EventKind::restore});
    });
    glfwSetWindowRefreshCallback(handle_, [](GLFWwindow* handle) { // shown again: as if the cursor moved
        double x = 0, y = 0;
        glfwGetCursorPos(handle, &x, &y);
        windowOf(handle).add({.kind = EventKind::move, .at = dvec2(x, y) * windowOf(handle).scale()});
    });
}

std::vector<const char*> Window::listExtensions() {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) fail(Failure::device, "Vulkan has no windows on this display");
    return {names, names + count};
}

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    checkVulkan(glfwCreateWindowSurface(instance, handle_, nullptr, &surface), "glfwCreateWindowSurface");
    return surface;
}

double Window::scale() const {
    ivec2 units(1);
    glfwGetWindowSize(handle_, &units.x, &units.y);
    return units.x > 0 ? double(pixels().x) / units.x : 1;
}

bool Window::isClosing() const { return glfwWindowShouldClose(handle_) != 0; }

ivec2 Window::pixels() const {
    ivec2 pixels(0);
    glfwGetFramebufferSize(handle_, &pixels.x, &pixels.y);
    return pixels;
}

/// Windows of X keep their size while they are minimised, those of Windows have none.
ivec2 Window::size() const { return isMinimised_ ? ivec2(0) : pixels(); }

void Window::minimise(bool isMinimised) {
    if (isMinimised)
        glfwIconifyWindow(handle_);
    else
        glfwRestoreWindow(handle_);
}

void Window::resize(const ivec2& size) {
    const double perUnit = scale();
    glfwSetWindowSize(handle_, std::max(1, int(size.x / perUnit)), std::max(1, int(size.y / perUnit)));
}

void Window::hide() {
    glfwHideWindow(handle_);
    glfwPollEvents();
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(handle_, title.c_str()); }
void Window::copyText(const std::string& text) { glfwSetClipboardString(handle_, text.c_str()); }

void Window::waitForEvents(double seconds) {
    answerLostWindow(handle_);
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

} // namespace relief
