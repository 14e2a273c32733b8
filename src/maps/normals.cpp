#include <algorithm>
#include <cmath>

#include "displacement/neighbours.h"
#include "maps/maps.h"

namespace relief {

MapSize computeMapSize(int width, int height) { return {1, double(height) / width}; }

NormalMap computeNormalMap(const HeightMap& map, const MapSize& size) {
    RELIEF_CHECK(size.x > 0);
    RELIEF_CHECK(size.y > 0);
    NormalMap normals{.width = map.width, .height = map.height, .normals = {}, .wrap = map.wrap};
    normals.normals.reserve(map.texels.size());
    // Differences of two texels, as slopes.
    const double perX = 0.5 * map.scale * map.width / size.x, perY = 0.5 * map.scale * map.height / size.y;
    eachDifference(map.width, map.height, map.texels, map.wrap, [&](const dvec2& difference) {
        normals.normals.push_back(vec3(glm::normalize(dvec3(-perX * difference.x, -perY * difference.y, 1))));
    });
    return normals;
}

Image toCodes(const NormalMap& map, NormalY y) {
    Image image{.width = map.width, .height = map.height, .channels = 3, .texels = {}};
    image.texels.reserve(3 * map.normals.size());
    const float up = y == NormalY::up ? 1 : -1;
    for (const vec3& n : map.normals)
        for (const float component : {n.x, up * n.y, n.z}) image.texels.push_back(0.5f * component + 0.5f);
    return image;
}

double computeSteepestSlope(const NormalMap& map) {
    double steepest = 0;
    for (const vec3& n : map.normals)
        steepest = std::max(steepest, std::atan2(std::hypot(double(n.x), double(n.y)), double(n.z)));
    return glm::degrees(steepest);
}

} // namespace relief
