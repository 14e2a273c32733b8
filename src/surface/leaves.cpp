#include "surface/surface.h"

namespace relief {
namespace {

void addLeaves(std::span<const std::uint32_t> tree, std::uint32_t entry, const TreeLeaf& at,
               std::vector<TreeLeaf>& leaves) {
    if (entry == kNoPatch) return;
    if ((entry & kLeafBit) != 0) {
        leaves.push_back({entry & ~kLeafBit, at.depth, at.u, at.v});
        return;
    }
    for (std::uint32_t child = 0; child < 4; ++child)
        addLeaves(tree, tree[entry + child], {0, at.depth + 1, 2 * at.u + child % 2, 2 * at.v + child / 2}, leaves);
}

} // namespace

std::vector<TreeLeaf> leavesOf(std::span<const std::uint32_t> tree, std::uint32_t root) {
    std::vector<TreeLeaf> leaves;
    addLeaves(tree, root, {}, leaves);
    return leaves;
}

} // namespace relief
