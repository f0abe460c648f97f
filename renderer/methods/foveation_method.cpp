// What methods share when they record.
#include "renderer/methods/foveation_method.h"

namespace parafovea {

void push_jitter(VkCommandBuffer commands, VkPipelineLayout layout, const Jitter& jitter) {
    vkCmdPushConstants(commands, layout, kPushConstantStages, 0, sizeof jitter, &jitter);
}

}  // namespace parafovea
