// Counts samples with occlusion queries.
#include "renderer/methods/sample_counter.h"

namespace parafovea {

SampleCounter::SampleCounter(Gpu& gpu, std::uint32_t queries) : device_(gpu.device()) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_OCCLUSION;
    info.queryCount = queries;
    VkQueryPool pool = VK_NULL_HANDLE;
    check_vulkan(vkCreateQueryPool(device_, &info, nullptr, &pool), "creating a sample counter");
    pool_ = {device_, pool};
}

void SampleCounter::reset(VkCommandBuffer commands, std::uint32_t query) const {
    vkCmdResetQueryPool(commands, pool_.get(), query, 1);
}

void SampleCounter::begin(VkCommandBuffer commands, std::uint32_t query) const {
    vkCmdBeginQuery(commands, pool_.get(), query, VK_QUERY_CONTROL_PRECISE_BIT);
}

void SampleCounter::end(VkCommandBuffer commands, std::uint32_t query) const {
    vkCmdEndQuery(commands, pool_.get(), query);
}

std::uint64_t SampleCounter::count(std::uint32_t query) const {
    std::uint64_t samples = 0;
    check_vulkan(vkGetQueryPoolResults(device_, pool_.get(), query, 1, sizeof samples, &samples,
                                       sizeof samples, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                 "counting samples");
    return samples;
}

}  // namespace parafovea
