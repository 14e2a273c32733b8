// Internal: a function's text among the text of other shaders.
#pragma once

#include "formula/formula.h"

namespace relief {

/// What the names that a function declares begin with in its isolated text.
inline constexpr std::string_view kFunctionPrefix = "formula_";

/// Text that cannot collide with other text, line by line that of the author.
struct IsolatedText {
    std::string text;
    bool statesBound = false;
};

/// Renames what the text declares, by kFunctionPrefix, and makes every loop count its turns by formula_turn().
/// Throws Failure::input, with file and line, for what a height function may not contain, and where it is missing.
IsolatedText isolate(const FunctionText& function);

} // namespace relief
