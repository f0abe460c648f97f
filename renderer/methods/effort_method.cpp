// Shades every pixel with an effort that falls with the distance from the gaze.
#include "renderer/methods/effort_method.h"

#include <array>

#include "renderer/kernel_setting.h"
#include "renderer/methods/method_parameters.h"
#include "shader_code/effort_primitives.h"
#include "shader_code/full_meshes.h"
#include "shader_code/full_picture.h"

namespace parafovea {
namespace {

const ShadingCode kCode{shader_code::full_meshes, shader_code::effort_primitives, shader_code::full_picture};

std::vector<ShaderConstant> constants_for(const ShadingSource& source, SavedEffort saved) {
    std::vector<ShaderConstant> constants = source.constants;
    constants.push_back({0, saved == SavedEffort::steps ? 1U : 0U});
    return constants;
}

}  // namespace

shared::EffortFalloff effort_falloff(const RenderMethod& method) {
    MethodParameters parameters(method);
    shared::EffortFalloff falloff{};
    falloff.slope = static_cast<float>(parameters.number("mar_slope", 5.6, 0.1, 200));
    falloff.start = static_cast<float>(parameters.number("mar_start", 0.09, 0, 1));
    falloff.least = static_cast<float>(parameters.number("least", 0.25, 0.05, 1));
    parameters.check_all_taken();
    return falloff;
}

EffortMethod::EffortMethod(Gpu& gpu, const ShadingSource& source, VkFormat target_format, SavedEffort saved)
    : has_loops_(source.thing == ShadedThing::primitives),
      saved_(saved),
      set_(gpu, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}}),
      block_(gpu, sizeof(shared::EffortFalloff), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      layout_(make_pipeline_layout(gpu, {source.layout, set_.layout()}, sizeof(Jitter))),
      pipeline_(make_fullscreen_pipeline(gpu, kCode.of(source.thing), layout_.get(), {target_format},
                                         constants_for(source, saved))) {
    set_.set_buffer(0, block_);
}

void EffortMethod::configure(const RenderMethod& method) {
    falloff_ = effort_falloff(method);
}

void EffortMethod::prepare(SizePx screen, PointPx gaze) {
    screen_ = screen;
    const PointPx usable = usable_gaze(screen, gaze);
    shared::EffortFalloff block = falloff_;
    block.gaze = {static_cast<float>(usable.x), static_cast<float>(usable.y)};
    block.slope /= static_cast<float>(shorter_side_px(screen));
    block.start *= static_cast<float>(shorter_side_px(screen));
    block_.write(block);
}

void EffortMethod::record(const MethodFrame& frame) {
    frame.timer->start(frame.commands, "pass_1");
    begin_rendering(frame.commands, frame.target->extent(),
                    {ColorTarget{.view = frame.target->view(), .discard = true}});
    push_jitter(frame.commands, layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, pipeline_.get(), layout_.get(),
                    std::array{frame.shading_set, set_.get()});
    vkCmdEndRendering(frame.commands);
    frame.timer->stop(frame.commands);
}

MethodStatistics EffortMethod::statistics() const {
    MethodStatistics statistics;
    statistics.buffer = screen_;
    statistics.shaded_samples =
        static_cast<std::uint64_t>(screen_.width) * static_cast<std::uint64_t>(screen_.height);
    const char* const name =
        saved_ == SavedEffort::steps ? "fewer steps along rays" : "fewer occlusion samples";
    if (has_loops_)
        statistics.built = {{name, "the farther from the gaze, the fewer; every pixel is shaded"}};
    else
        statistics.left_out = {{name, "only a ray-marched scene has such loops"}};
    return statistics;
}

}  // namespace parafovea
