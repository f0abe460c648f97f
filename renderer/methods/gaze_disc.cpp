// Draws discs around the gaze.
#include "renderer/methods/gaze_disc.h"

#include <array>
#include <utility>

#include "shader_code/gaze_disc_vert.h"
#include "shader_code/inset_meshes.h"
#include "shader_code/inset_picture.h"
#include "shader_code/inset_primitives.h"

namespace parafovea {

GraphicsPipelineDescription gaze_disc(std::span<const std::uint32_t> fragment, VkPipelineLayout layout,
                                      VkFormat format, std::vector<ShaderConstant> constants) {
    GraphicsPipelineDescription disc;
    disc.vertex = shader_code::gaze_disc_vert;
    disc.fragment = fragment;
    disc.layout = layout;
    disc.color_formats = {format};
    disc.constants = std::move(constants);
    return disc;
}

void draw_gaze_disc(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                    VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query) {
    constexpr std::uint32_t kVertices = 3 * 64;  // see gaze_disc.vert
    counter.begin(frame.commands, query);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    push_jitter(frame.commands, layout, frame.jitter);
    const std::array sets{frame.shading_set, map_set};
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, sets.size(),
                            sets.data(), 0, nullptr);
    vkCmdDraw(frame.commands, kVertices, 1, 0, 0);
    counter.end(frame.commands, query);
}

OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants) {
    const ShadingCode code{shader_code::inset_meshes, shader_code::inset_primitives,
                           shader_code::inset_picture};
    GraphicsPipelineDescription inset =
        gaze_disc(code.of(source.thing), layout, target_format, std::move(constants));
    inset.alpha_blend = true;
    return make_graphics_pipeline(gpu, inset);
}

void record_native_inset(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                         VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query) {
    image_barrier(frame.commands, *frame.target, kUseColorTarget, kUseColorTarget);
    counter.reset(frame.commands, query);
    begin_rendering(frame.commands, frame.target->extent(), {ColorTarget{.view = frame.target->view()}});
    draw_gaze_disc(frame, pipeline, layout, map_set, counter, query);
    vkCmdEndRendering(frame.commands);
}

}  // namespace parafovea
