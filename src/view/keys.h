// Internal: the keys of the window: their names in recorded events, and what they do.
#pragma once

#include <vulkan/vulkan.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/words.h"

namespace relief {

/// Keys without help are for text fields alone.
inline constexpr Word<int> kKeys[] = {
    {"F", GLFW_KEY_F, "frame the object"},
    {"1", GLFW_KEY_1, "front; again: back"},
    {"3", GLFW_KEY_3, "right side; again: left side"},
    {"7", GLFW_KEY_7, "top; again: bottom"},
    {"5", GLFW_KEY_5, "parallel view and back"},
    {"W", GLFW_KEY_W, "shaded, wireframe, wireframe of the cage's faces"},
    {"H", GLFW_KEY_H, "cage, its creases coloured by sharpness"},
    {"N", GLFW_KEY_N, "next view: normal, height, rate, faces, wireframe, uv, error"},
    {"D", GLFW_KEY_D, "what heights do: displacement, bump, both, none"},
    {"+", GLFW_KEY_EQUAL, "finer triangles"},
    {"-", GLFW_KEY_MINUS, "coarser triangles"},
    {"T", GLFW_KEY_T, "equal or fractional spacing"},
    {"V", GLFW_KEY_V, "rates by size on screen, or the same everywhere"},
    {"Z", GLFW_KEY_Z, "freeze the camera that rates are measured from"},
    {"X", GLFW_KEY_X, "split view"},
    {"Space", GLFW_KEY_SPACE, "play and stop"},
    {"Left", GLFW_KEY_LEFT, "one frame back"},
    {"Right", GLFW_KEY_RIGHT, "one frame on"},
    {"K", GLFW_KEY_K, "certificate: what relief check finds"},
    {"R", GLFW_KEY_R, "read all files again"},
    {"C", GLFW_KEY_C, "copy the command line of this picture"},
    {"F12", GLFW_KEY_F12, "screenshot: what relief render writes"},
    {"Tab", GLFW_KEY_TAB, "panels on and off"},
    {"?", GLFW_KEY_SLASH, "this help"},
    {"Escape", GLFW_KEY_ESCAPE, "close help and errors"},
    {"Q", GLFW_KEY_Q, "close the window"},
    {"Enter", GLFW_KEY_ENTER, ""},
    {"Backspace", GLFW_KEY_BACKSPACE, ""},
    {"Delete", GLFW_KEY_DELETE, ""},
    {"Home", GLFW_KEY_HOME, ""},
    {"End", GLFW_KEY_END, ""},
};

} // namespace relief
