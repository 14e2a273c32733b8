// Triangle meshes of known topology.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

#include "mesh/mesh.h"

namespace relief::test {

using PointAt = std::function<dvec3(double s, double t)>;

/// A grid of columns x rows quads over the unit square; with `wrapsS` and `wrapsT` the sides meet.
inline DenseMesh gridMesh(std::uint32_t columns, std::uint32_t rows, const PointAt& point, bool wrapsS = false,
                          bool wrapsT = false) {
    DenseMesh mesh;
    const std::uint32_t across = wrapsS ? columns : columns + 1, down = wrapsT ? rows : rows + 1;
    for (std::uint32_t j = 0; j < down; ++j)
        for (std::uint32_t i = 0; i < across; ++i)
            mesh.positions.emplace_back(point(double(i) / columns, double(j) / rows));
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j % down * across + i % across; };
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i)
            mesh.indices.insert(mesh.indices.end(),
                                {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

inline DenseMesh flatSquare(std::uint32_t n) {
    return gridMesh(n, n, [](double s, double t) { return dvec3(s, t, 0); });
}

/// A cube whose points lie on the unit sphere, scaled.
inline DenseMesh sphereMesh(std::uint32_t n, const dvec3& scale = dvec3(1)) {
    DenseMesh mesh;
    for (int side = 0; side < 6; ++side) {
        const DenseMesh one = gridMesh(n, n, [&](double s, double t) {
            const double quarter = std::numbers::pi / 4;
            const dvec3 p(std::tan(quarter * (2 * s - 1)), std::tan(quarter * (2 * t - 1)), 1);
            const int axis = side / 2;
            const dvec3 turned(p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]);
            const dvec3 mirrored = side % 2 == 0 ? turned : -dvec3(turned);
            const dvec3 unit = glm::normalize(mirrored);
            // Of a few digits, so that sides meet in the same floats.
            return scale * glm::round(unit * 1e6) / 1e6;
        });
        const auto first = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
        for (std::size_t i = 0; i < one.indices.size(); i += 3) {
            const bool turns = side % 2 != 0;
            mesh.indices.push_back(first + one.indices[i]);
            mesh.indices.push_back(first + one.indices[i + (turns ? 2 : 1)]);
            mesh.indices.push_back(first + one.indices[i + (turns ? 1 : 2)]);
        }
    }
    mesh.normals.clear();
    return mesh;
}

/// A sphere with a small round hole at its north pole; n quads around.
inline DenseMesh piercedSphere(std::uint32_t n) {
    DenseMesh mesh = gridMesh(
        n, n / 2,
        [n](double s, double t) {
            const double around = 2 * std::numbers::pi * s, first = 0.05;
            const double down = first + (std::numbers::pi - first) * t * (n / 2) / (n / 2 + 1);
            return dvec3(std::sin(down) * std::sin(around), std::sin(down) * std::cos(around), std::cos(down));
        },
        true);
    // The last row ends at the south pole.
    const auto last = std::uint32_t(mesh.positions.size());
    mesh.positions.emplace_back(0, 0, -1);
    for (std::uint32_t i = 0; i < n; ++i)
        mesh.indices.insert(mesh.indices.end(), {last - n + i, last - n + (i + 1) % n, last});
    return mesh;
}

/// A sphere with arms along its axes, each five times as long as the sphere is wide, bent and with waves: what single
/// squares hold badly.
inline DenseMesh jackMesh(std::uint32_t n) {
    DenseMesh mesh = sphereMesh(n);
    for (vec3& position : mesh.positions) {
        const dvec3 p(position);
        const dvec3 size = glm::abs(p);
        const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
        const double past = std::max(0.0, size[axis] - 0.93) / 0.07, arm = 10 * past * past;
        dvec3 moved = (1 + 0.05 * std::sin(14 * p.x) * std::sin(14 * p.y) * std::sin(14 * p.z)) * p;
        moved[axis] += (p[axis] > 0 ? 1 : -1) * arm;
        moved[(axis + 1) % 3] += 0.5 * std::sin(0.7 * arm);
        position = vec3(moved);
    }
    return mesh;
}

inline DenseMesh torusMesh(std::uint32_t n) {
    return gridMesh(
        n, n / 2,
        [](double s, double t) {
            const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
            return dvec3((1 + 0.4 * std::cos(b)) * std::cos(a), (1 + 0.4 * std::cos(b)) * std::sin(a),
                         0.4 * std::sin(b));
        },
        true, true);
}

/// The surface of the cells of a grid that are inside, smoothed.
inline DenseMesh cellSurface(const ivec2& size, int depth, const std::function<bool(int x, int y)>& isInside) {
    DenseMesh mesh;
    std::map<std::tuple<int, int, int>, std::uint32_t> vertices;
    const auto vertexAt = [&](int x, int y, int z) {
        const auto [entry, isNew] = vertices.try_emplace({x, y, z}, std::uint32_t(mesh.positions.size()));
        if (isNew) mesh.positions.emplace_back(x, y, z);
        return entry->second;
    };
    const auto inside = [&](int x, int y, int z) {
        return x >= 0 && y >= 0 && z >= 0 && x < size.x && y < size.y && z < depth && isInside(x, y);
    };
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < depth; ++z)
                for (int axis = 0; axis < 3 && inside(x, y, z); ++axis)
                    for (int side = 0; side < 2; ++side) {
                        glm::ivec3 step(0), u(0), v(0), base(x, y, z);
                        step[axis] = side == 1 ? 1 : -1, u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1;
                        if (inside(x + step.x, y + step.y, z + step.z)) continue;
                        base[axis] += side;
                        const auto at = [&](const glm::ivec3& p) { return vertexAt(p.x, p.y, p.z); };
                        std::uint32_t q[4] = {at(base), at(base + u), at(base + u + v), at(base + v)};
                        if (side == 0) std::swap(q[1], q[3]);
                        mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
                    }
    for (int round = 0; round < 6; ++round) {
        std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
        std::vector<double> counts(mesh.positions.size(), 0);
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            const std::uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
            sums[a] += dvec3(mesh.positions[b]), counts[a] += 1;
        }
        for (std::size_t v = 0; v < sums.size(); ++v) mesh.positions[v] = vec3(sums[v] / counts[v]);
    }
    return mesh;
}

inline DenseMesh doubleTorus() {
    return cellSurface({34, 18}, 7, [](int x, int y) {
        const auto isHole = [&](int from) { return x >= from && x < from + 6 && y >= 6 && y < 12; };
        return !isHole(6) && !isHole(22);
    });
}

} // namespace relief::test
