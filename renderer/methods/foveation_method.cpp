// What methods share.
#include "renderer/methods/foveation_method.h"

namespace parafovea {

std::span<const std::uint32_t> ShadingCode::of(ShadedThing thing) const {
    switch (thing) {
        case ShadedThing::meshes:
            return meshes;
        case ShadedThing::primitives:
            return primitives;
        case ShadedThing::picture:
            return picture;
    }
    return {};
}

bool shaders_can_write(const Gpu& gpu, VkFormat format) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu.physical_device(), format, &properties);
    return gpu.features().shaderStorageImageWriteWithoutFormat &&
           (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
}

void push_jitter(VkCommandBuffer commands, VkPipelineLayout layout, const Jitter& jitter) {
    vkCmdPushConstants(commands, layout, kPushConstantStages, 0, sizeof jitter, &jitter);
}

}  // namespace parafovea
