// Discs of pixels around the gaze at full resolution: the inset that is drawn over what a method made of the
// rest, and the pixels whose light kernel foveated rendering hands to finer texels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/methods/foveation_method.h"
#include "renderer/methods/sample_counter.h"

namespace parafovea {

// `layout` of all of these: set 0 the source's, set 1 with the kernel map block at binding 0, which says how
// large the disc is; push constants are a Jitter.

// Draws pixels of the disc with a fragment shader.
GraphicsPipelineDescription gaze_disc(std::span<const std::uint32_t> fragment, VkPipelineLayout layout,
                                      VkFormat format, std::vector<ShaderConstant> constants);

// Inside rendering; counts the pixels with a query that was reset.
void draw_gaze_disc(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                    VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query);

// The native inset, see shaders/inset.frag.
OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants);
void record_native_inset(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                         VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query);

}  // namespace parafovea
