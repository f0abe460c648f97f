// Draws discs around the gaze.
#include "renderer/methods/gaze_disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "shader_code/inset_meshes.h"
#include "shader_code/inset_picture.h"
#include "shader_code/inset_primitives.h"

namespace parafovea {
namespace {

constexpr std::int32_t kRowsOfRectangle = 16;

}  // namespace

std::vector<VkRect2D> rectangles_over(const GazeDisc& disc) {
    const std::int32_t left = disc.within.offset.x, top = disc.within.offset.y;
    const auto right = left + static_cast<std::int32_t>(disc.within.extent.width);
    const auto bottom = top + static_cast<std::int32_t>(disc.within.extent.height);
    const auto pixel = [](float position, std::int32_t low, std::int32_t high) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(position), static_cast<float>(low), static_cast<float>(high)));
    };
    const std::int32_t first = pixel(disc.centre.y - disc.radius_px, top, bottom);
    const std::int32_t end = pixel(disc.centre.y + disc.radius_px + 1, top, bottom);
    std::vector<VkRect2D> rectangles;
    for (std::int32_t row = first; row < end;) {
        const std::int32_t next = std::min((row / kRowsOfRectangle + 1) * kRowsOfRectangle, end);
        // Its row that is nearest to the gaze is the widest.
        const float nearest = std::clamp(disc.centre.y, static_cast<float>(row), static_cast<float>(next));
        const float dy = nearest - disc.centre.y;
        const float half = std::sqrt(std::max(disc.radius_px * disc.radius_px - dy * dy, 0.0f));
        const std::int32_t from = pixel(disc.centre.x - half, left, right);
        const std::int32_t to = pixel(disc.centre.x + half + 1, left, right);
        if (from < to) {
            rectangles.push_back(
                {{from, row},
                 {static_cast<std::uint32_t>(to - from), static_cast<std::uint32_t>(next - row)}});
        }
        row = next;
    }
    return rectangles;
}

void draw_gaze_disc(const MethodFrame& frame, const GazeDisc& disc, VkPipeline pipeline,
                    VkPipelineLayout layout, VkDescriptorSet method_set, const SampleCounter& counter,
                    std::uint32_t query) {
    counter.begin(frame.commands, query);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    push_jitter(frame.commands, layout, frame.jitter);
    const std::array sets{frame.shading_set, method_set};
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, sets.size(),
                            sets.data(), 0, nullptr);
    for (const VkRect2D& rectangle : rectangles_over(disc)) {
        vkCmdSetScissor(frame.commands, 0, 1, &rectangle);
        vkCmdDraw(frame.commands, 3, 1, 0, 0);
    }
    counter.end(frame.commands, query);
}

OwnedPipeline make_inset_pipeline(Gpu& gpu, const ShadingSource& source, VkPipelineLayout layout,
                                  VkFormat target_format, std::vector<ShaderConstant> constants) {
    const ShadingCode code{shader_code::inset_meshes, shader_code::inset_primitives,
                           shader_code::inset_picture};
    GraphicsPipelineDescription inset =
        fullscreen_pass(code.of(source.thing), layout, {target_format}, std::move(constants));
    inset.alpha_blend = true;
    return make_graphics_pipeline(gpu, inset);
}

void record_native_inset(const MethodFrame& frame, shared::vec2 gaze, float radius_px, VkPipeline pipeline,
                         VkPipelineLayout layout, VkDescriptorSet map_set, const SampleCounter& counter,
                         std::uint32_t query) {
    image_barrier(frame.commands, *frame.target, kUseColorTarget, kUseColorTarget);
    counter.reset(frame.commands, query);
    begin_rendering(frame.commands, frame.target->extent(), {ColorTarget{.view = frame.target->view()}});
    draw_gaze_disc(frame, {gaze, radius_px, {{0, 0}, frame.target->extent()}}, pipeline, layout, map_set,
                   counter, query);
    vkCmdEndRendering(frame.commands);
}

}  // namespace parafovea
