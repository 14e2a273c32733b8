// A kd-tree over points: finds those near a location in few steps, however the points are distributed.
#pragma once

#include <algorithm>
#include <numeric>

#include "base/base.h"

namespace relief {

class PointTree {
public:
    explicit PointTree(std::vector<dvec3> points) : points_(std::move(points)), order_(points_.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        if (!points_.empty()) addNode(0, std::uint32_t(points_.size()));
    }

    [[nodiscard]] const dvec3& operator[](std::uint32_t point) const { return points_[point]; }

    /// Calls `visit(point)` for every point of the leaves whose boxes have distance(box) <= limit, near boxes first;
    /// `visit` may lower the limit.
    template <typename Distance, typename Visit>
    void search(const Distance& distance, const double& limit, const Visit& visit) const {
        if (!nodes_.empty()) searchNode(0, distance, limit, visit);
    }

private:
    static constexpr std::uint32_t kLeafSize = 8;

    struct Node {
        Bounds box;
        std::uint32_t first = 0, end = 0; ///< into order_
        std::uint32_t right = 0;          ///< the second child; the first one follows its parent; 0 in leaves
    };

    std::uint32_t addNode(std::uint32_t first, std::uint32_t end) {
        const auto index = std::uint32_t(nodes_.size());
        Node node{.first = first, .end = end};
        for (std::uint32_t i = first; i < end; ++i) node.box.add(points_[order_[i]]);
        nodes_.push_back(node);
        if (end - first <= kLeafSize) return index;
        const dvec3 side = node.box.upper - node.box.lower;
        const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
        const std::uint32_t middle = first + (end - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
        addNode(first, middle);
        const std::uint32_t right = addNode(middle, end);
        nodes_[index].right = right;
        return index;
    }

    template <typename Distance, typename Visit>
    void searchNode(std::uint32_t index, const Distance& distance, const double& limit, const Visit& visit) const {
        const Node& node = nodes_[index];
        if (node.right == 0) {
            for (std::uint32_t i = node.first; i < node.end; ++i) visit(order_[i]);
            return;
        }
        std::uint32_t near = index + 1, far = node.right;
        double nearDistance = distance(nodes_[near].box), farDistance = distance(nodes_[far].box);
        if (farDistance < nearDistance) std::swap(near, far), std::swap(nearDistance, farDistance);
        if (nearDistance <= limit) searchNode(near, distance, limit, visit);
        if (farDistance <= limit) searchNode(far, distance, limit, visit);
    }

    std::vector<dvec3> points_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace relief
