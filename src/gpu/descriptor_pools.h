// Internal: descriptor pools that many sets share.
#pragma once

#include "gpu/pipeline.h"

namespace relief {

/// Room for some sets, all of which must have ended before it is reset.
struct DescriptorPool {
    static constexpr std::uint32_t kSets = 32;

    Owned<VkDescriptorPool> handle;
    std::uint32_t setCount = 0; ///< since it was reset
    bool isFull = false;
};

/// Pools are filled one after another, and reset when no set of them is left: a frame's sets have ended before the next
/// frame's are made, so that frames share one pool. Submissions are waited for, so no ended set is still in use.
class DescriptorPools {
public:
    explicit DescriptorPools(Device& device) : device_(device) {}
    BindingSet allocate(VkDescriptorSetLayout layout);
    [[nodiscard]] std::size_t poolCount() const { return pools_.size(); }

private:
    std::shared_ptr<DescriptorPool> makePool() const;
    BindingSet allocateFrom(const std::shared_ptr<DescriptorPool>& pool, VkDescriptorSetLayout layout) const;

    Device& device_;
    std::vector<std::shared_ptr<DescriptorPool>> pools_;
};

} // namespace relief
