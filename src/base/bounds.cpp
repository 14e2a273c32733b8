#include "base/base.h"

#include <algorithm>

namespace relief {

double Bounds::longestSide() const {
    if (isEmpty()) return 0;
    const dvec3 size = upper - lower;
    return std::max({size.x, size.y, size.z});
}

} // namespace relief
