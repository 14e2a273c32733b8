// Internal: what relief promises to save, and what a run found.
#pragma once

#include "measure/measure.h"

namespace relief {

struct Goal {
    std::string what, scene;
    double wanted = 0, found = 0;
    bool isAtLeast = true;
    std::string unit;
    std::string reason; ///< why it is hard to reach, said where it is missed

    [[nodiscard]] bool isMet() const { return isAtLeast ? found >= wanted : found <= wanted; }
};

/// Those that the suites of this run can tell. All but the times are about meshes of a million triangles: a quick run
/// compares smaller ones.
std::vector<Goal> goalsOf(const Results& results);

/// Rows of a suite, in order.
std::vector<const Row*> rowsOf(const Results& results, const std::string& suite, const std::string& axis);
/// Scenes of a suite, in order.
std::vector<std::string> scenesOf(const Results& results, const std::string& suite);

} // namespace relief
