#include "model/stages.h"

namespace relief {

PipelineLayoutDesc passLayout() {
    PipelineLayoutDesc layout{std::vector<VkDescriptorType>(kBindCount, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER),
                              sizeof(PushConstants)};
    layout.bindings[kBindScene] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    for (const std::uint32_t image :
         {kBindAlbedo, kBindEnvironment, kBindShadow, kBindDepths, kBindNormals, kBindColors})
        layout.bindings[image] = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    return layout;
}

TexelBuffer uploadWords(Device& device, const std::string& name, std::span<const std::uint32_t> words) {
    return uploadTexels(device, {.name = name}, VK_FORMAT_R32_UINT, std::as_bytes(words));
}

Buffer makeSceneBuffer(Device& device) {
    return makeBuffer(device, {.name = "scene",
                               .bytes = sizeof(Scene),
                               .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
}

void writeScene(VkCommandBuffer commands, const Buffer& buffer, const Scene& scene) {
    vkCmdUpdateBuffer(commands, buffer.handle.get(), 0, sizeof(Scene), &scene);
    barrier(commands);
}

} // namespace relief
