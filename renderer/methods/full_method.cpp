// Shades every pixel.
#include "renderer/methods/full_method.h"

#include <array>

#include "renderer/methods/method_parameters.h"
#include "shader_code/full_meshes.h"
#include "shader_code/full_picture.h"
#include "shader_code/full_primitives.h"

namespace parafovea {
namespace {

const ShadingCode kCode{shader_code::full_meshes, shader_code::full_primitives, shader_code::full_picture};

}  // namespace

FullMethod::FullMethod(Gpu& gpu, const ShadingSource& source, VkFormat target_format)
    : layout_(make_pipeline_layout(gpu, {source.layout}, sizeof(Jitter))),
      pipeline_(make_fullscreen_pipeline(gpu, kCode.of(source.thing), layout_.get(), {target_format},
                                         source.constants)) {}

void FullMethod::configure(const RenderMethod& method) {
    MethodParameters(method).check_all_taken();
}

void FullMethod::prepare(SizePx screen, PointPx) {
    screen_ = screen;
}

void FullMethod::record(const MethodFrame& frame) {
    frame.timer->start(frame.commands, "pass_1");
    begin_rendering(frame.commands, frame.target->extent(),
                    {ColorTarget{.view = frame.target->view(), .discard = true}});
    push_jitter(frame.commands, layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, pipeline_.get(), layout_.get(), std::array{frame.shading_set});
    vkCmdEndRendering(frame.commands);
    frame.timer->stop(frame.commands);
}

MethodStatistics FullMethod::statistics() const {
    MethodStatistics statistics;
    statistics.buffer = screen_;
    statistics.shaded_samples =
        static_cast<std::uint64_t>(screen_.width) * static_cast<std::uint64_t>(screen_.height);
    statistics.built = {{"shading at every pixel", "full resolution"}};
    return statistics;
}

}  // namespace parafovea
