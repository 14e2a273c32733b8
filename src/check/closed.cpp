// Whether a surface has an inside.
#include "check/check.h"

namespace relief {

bool enclosesVolume(const Surface& surface) {
    const EdgeTouches touches = incidentTouches(surface);
    for (std::size_t edge = 0; edge < surface.edges.size(); ++edge) {
        int balance = 0;
        for (const Touch& touch : touches.of(edge)) balance += touch.start < touch.end ? 1 : -1;
        if (balance != 0) return false;
    }
    return true;
}

} // namespace relief
