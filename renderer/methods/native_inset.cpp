// Draws the native inset.
#include "renderer/methods/native_inset.h"

#include <array>
#include <utility>

#include "shader_code/inset_meshes.h"
#include "shader_code/inset_picture.h"
#include "shader_code/inset_primitives.h"
#include "shader_code/inset_vert.h"

namespace parafovea {

OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants) {
    const ShadingCode code{shader_code::inset_meshes, shader_code::inset_primitives,
                           shader_code::inset_picture};
    GraphicsPipelineDescription inset;
    inset.vertex = shader_code::inset_vert;
    inset.fragment = code.of(source.thing);
    inset.layout = layout;
    inset.color_formats = {target_format};
    inset.alpha_blend = true;
    inset.constants = std::move(constants);
    return make_graphics_pipeline(gpu, inset);
}

void record_native_inset(const MethodFrame& frame, VkPipeline pipeline, VkPipelineLayout layout,
                         VkDescriptorSet map_set, const SampleCounter& counter, std::uint32_t query) {
    constexpr std::uint32_t kVertices = 3 * 64;  // see inset.vert
    image_barrier(frame.commands, *frame.target, kUseColorTarget, kUseColorTarget);
    counter.reset(frame.commands, query);
    begin_rendering(frame.commands, frame.target->extent(), {ColorTarget{.view = frame.target->view()}});
    counter.begin(frame.commands, query);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    push_jitter(frame.commands, layout, frame.jitter);
    const std::array sets{frame.shading_set, map_set};
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, sets.size(),
                            sets.data(), 0, nullptr);
    vkCmdDraw(frame.commands, kVertices, 1, 0, 0);
    counter.end(frame.commands, query);
    vkCmdEndRendering(frame.commands);
}

}  // namespace parafovea
