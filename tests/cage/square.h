// The vertices that most OBJ texts of the tests begin with.
#pragma once

#include <string>

namespace relief::test {

inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"; // lines 1 to 4

} // namespace relief::test
