// The disc around the gaze at full resolution, drawn over what a method made of the rest; see
// shaders/inset.frag.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/methods/foveation_method.h"
#include "renderer/methods/sample_counter.h"

namespace parafovea {

// `layout`: set 0 the source's, set 1 with the kernel map block at binding 0; push constants are a Jitter.
OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants);

// Counts its pixels.
void record_native_inset(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                         VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query);

}  // namespace parafovea
