// Discs of pixels around the gaze at full resolution: the inset that is drawn over what a method made of the
// rest, and the pixels whose light kernel foveated rendering hands to finer texels.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/methods/foveation_method.h"
#include "renderer/methods/sample_counter.h"
#include "renderer/shared/bridge.h"

namespace parafovea {

struct GazeDisc {
    shared::vec2 centre;  // in the image that is drawn, pixels from its top left corner
    float radius_px = 0;
    VkRect2D within;  // the part of the image where it may be drawn
};

// Rectangles that do not overlap and hold every pixel whose centre is in the disc, and few others. Triangles
// around the centre would shade the blocks of pixels along their sides several times on software devices.
std::vector<VkRect2D> rectangles_over(const GazeDisc& disc);

// Inside rendering: draws the disc with a pipeline that covers the image with one triangle (fullscreen.vert),
// and counts the pixels with a query that was reset. `layout`: set 0 the source's, set 1 the method's; push
// constants are a Jitter.
void draw_gaze_disc(const MethodFrame& frame, const GazeDisc& disc, VkPipeline pipeline,
                    VkPipelineLayout layout, VkDescriptorSet method_set, const SampleCounter& counter,
                    std::uint32_t query);

// The native inset, see shaders/inset.frag; set 1 of the layout has the kernel map block at binding 0.
OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants);
void record_native_inset(const MethodFrame& frame, shared::vec2 gaze, float radius_px, VkPipeline pipeline,
                         VkPipelineLayout layout, VkDescriptorSet map_set, const SampleCounter& counter,
                         std::uint32_t query);

}  // namespace parafovea
