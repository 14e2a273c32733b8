// Builds cages by hand: vertices, texture coordinates, quads, tubes and caps; and proves them sound.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "cage/cage.h"

namespace relief::meshes {

constexpr double kPi = 3.14159265358979323846;

inline double radians(double degrees) { return degrees * kPi / 180; }
inline double smoothstep(double from, double to, double x) {
    double t = glm::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// A polygon corner: position and texture coordinate, by index.
struct Corner {
    std::uint32_t point, tex;
};

class CageBuilder {
public:
    std::uint32_t point(const dvec3& p) { return cage_.positions.push_back(tidy(p)), lastOf(cage_.positions); }
    std::uint32_t tex(const dvec2& st) { return cage_.texCoords.push_back(tidy(st)), lastOf(cage_.texCoords); }
    [[nodiscard]] dvec3 position(std::uint32_t point) const { return cage_.positions[point]; }
    void move(std::uint32_t point, const dvec3& p) { cage_.positions[point] = tidy(p); }

    /// Faces added from here on belong to a part of this name.
    void part(const std::string& name) { cage_.parts.push_back({name, "", std::uint32_t(cage_.faceCount()), 0}); }
    void face(std::span<const Corner> corners);
    void quad(Corner a, Corner b, Corner c, Corner d) { face(std::array{a, b, c, d}); }
    void crease(std::uint32_t a, std::uint32_t b, float sharpness);
    void boundaryRule(BoundaryRule rule) { cage_.boundaryRule = rule; }

    /// Throws Failure::internal unless the cage is sound (checkCage).
    Cage finish(const std::string& name);

private:
    // Five decimals print short and hide the last bits of other machines' sines; + 0 turns -0 into 0.
    template <typename T>
    static T tidy(const T& value) {
        return glm::round(value * 1e5) / 1e5 + 0.0;
    }
    template <typename T>
    static std::uint32_t lastOf(const std::vector<T>& list) {
        return std::uint32_t(list.size() - 1);
    }
    Cage cage_;
};

inline void CageBuilder::face(std::span<const Corner> corners) {
    for (const Corner& corner : corners) {
        cage_.corners.push_back(corner.point);
        cage_.texCorners.push_back(corner.tex);
    }
    cage_.faceSizes.push_back(std::uint32_t(corners.size()));
    if (!cage_.parts.empty()) cage_.parts.back().faceCount++;
}

inline void CageBuilder::crease(std::uint32_t a, std::uint32_t b, float sharpness) {
    cage_.creaseEdges.insert(cage_.creaseEdges.end(), {a, b});
    cage_.creaseSharpness.push_back(sharpness);
}

/// Each directed edge occurs once (so edges have at most two faces, wound alike), no vertex is unused, nothing
/// degenerate.
inline void checkCage(const Cage& cage, const std::string& name) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> faceOfEdge;
    std::vector<bool> isUsed(cage.positions.size(), false);
    std::size_t first = 0;
    for (std::size_t face = 0; face < cage.faceCount(); first += cage.faceSizes[face++])
        for (std::size_t i = 0, n = cage.faceSizes[face]; i < n; ++i) {
            std::uint32_t a = cage.corners[first + i], b = cage.corners[first + (i + 1) % n];
            isUsed[a] = true;
            auto [other, isNew] = faceOfEdge.insert({{a, b}, face});
            if (a == b || !isNew)
                fail(Failure::internal, "{}: faces {} and {} both run the edge {}-{}", name, other->second, face, a, b);
        }
    for (std::size_t i = 0; i < isUsed.size(); ++i)
        if (!isUsed[i]) fail(Failure::internal, "{}: vertex {} is in no face", name, i);
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
        std::uint32_t a = cage.creaseEdges[2 * i], b = cage.creaseEdges[2 * i + 1];
        if (!faceOfEdge.contains({a, b}) && !faceOfEdge.contains({b, a}))
            fail(Failure::internal, "{}: crease {}-{} is no edge", name, a, b);
    }
}

inline Cage CageBuilder::finish(const std::string& name) {
    checkCage(cage_, name);
    validateCage(cage_, name);
    return std::move(cage_);
}

} // namespace relief::meshes
