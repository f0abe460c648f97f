// Counts samples that are drawn: one number for each query.
#pragma once

#include <cstdint>

#include "renderer/gpu_pipeline.h"

namespace parafovea {

class SampleCounter {
  public:
    SampleCounter(Gpu& gpu, std::uint32_t queries);

    // Outside rendering, before begin().
    void reset(VkCommandBuffer commands, std::uint32_t query) const;
    // Around the draws, inside rendering.
    void begin(VkCommandBuffer commands, std::uint32_t query) const;
    void end(VkCommandBuffer commands, std::uint32_t query) const;

    // Once the commands are done.
    std::uint64_t count(std::uint32_t query) const;

  private:
    VkDevice device_;
    OwnedQueryPool pool_;
};

}  // namespace parafovea
