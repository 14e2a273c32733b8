// Things strewn over a surface (suckers, warts, craters, seeds), found again by position.
#pragma once

#include <functional>
#include <unordered_map>

#include "noise.h"

namespace relief::meshes {

/// A round mark: where, how large, and which way it faces. `kind` and `luck` (0..1) are the painter's.
struct Stamp {
    dvec3 center{0};
    double radius = 1;
    dvec3 axis{0, 1, 0};
    double luck = 0;
    int kind = 0;
};

class Stamps {
public:
    /// Lookups find a stamp up to `extent` times its radius from its centre; `cell` is about that distance for most
    /// stamps.
    explicit Stamps(double cell, double extent = 1) : cell_(cell), extent_(extent) {}

    void add(const Stamp& stamp);
    /// True when no stamp whose extent contains p is nearer than `spacing` times the two radii.
    [[nodiscard]] bool isFree(const dvec3& p, double radius, double spacing) const;
    /// Calls `use(stamp, distance / radius)` for every stamp whose extent contains p.
    template <typename Use>
    void forEachNear(const dvec3& p, Use&& use) const {
        auto found = cells_.find(key(cellOf(p)));
        if (found == cells_.end()) return;
        for (std::uint32_t i : found->second) {
            double x = glm::distance(p, stamps_[i].center) / stamps_[i].radius;
            if (x < extent_) use(stamps_[i], x);
        }
    }
    [[nodiscard]] std::size_t size() const { return stamps_.size(); }

private:
    using ivec3 = glm::ivec3;
    [[nodiscard]] ivec3 cellOf(const dvec3& p) const { return glm::floor(p / cell_); }
    static std::uint64_t key(const ivec3& cell) {
        auto part = [](int x) { return std::uint64_t(x) + (1u << 20); };
        return part(cell.x) | part(cell.y) << 21 | part(cell.z) << 42;
    }
    double cell_, extent_;
    std::vector<Stamp> stamps_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_; ///< every stamp in each cell that it overlaps
};

inline void Stamps::add(const Stamp& stamp) {
    ivec3 low = cellOf(stamp.center - stamp.radius * extent_), high = cellOf(stamp.center + stamp.radius * extent_);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) cells_[key({x, y, z})].push_back(std::uint32_t(stamps_.size()));
    stamps_.push_back(stamp);
}

inline bool Stamps::isFree(const dvec3& p, double radius, double spacing) const {
    bool free = true;
    forEachNear(p, [&](const Stamp& other, double x) {
        if (x * other.radius < spacing * (radius + other.radius)) free = false;
    });
    return free;
}

} // namespace relief::meshes
