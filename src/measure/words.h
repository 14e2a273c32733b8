// Internal: from names back to enumerations, and groups of methods.
#pragma once

#include "measure/results.h"

namespace relief {

/// Each throws std::invalid_argument, with the word, where no value has that name.
void parseWord(const std::string& word, Suite& value);
void parseWord(const std::string& word, Method& value);
void parseWord(const std::string& word, Axis& value);
void parseWord(const std::string& word, Metric& value);
void parseWord(const std::string& word, Origin& value);

/// Whether the method is a cage with a map of any format.
bool isCageAndMap(Method method);

} // namespace relief
