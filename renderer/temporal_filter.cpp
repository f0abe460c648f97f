// Keeps the history and records the step that a frame takes into it.
#include "renderer/temporal_filter.h"

#include <cassert>
#include <cstring>
#include <span>

#include "renderer/shared/temporal.h"
#include "shader_code/temporal_resolve.h"

namespace parafovea {
namespace {

constexpr VkFormat kHistoryFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr float kClipDeviations = 1;  // Salvi: 0.75 to 1.25
constexpr std::size_t kGridCells = std::size_t{shared::kSpacingColumns} * shared::kSpacingRows;

bool same_view(const CameraView& a, const CameraView& b) {
    return a.world_from_eye == b.world_from_eye && a.tan_left == b.tan_left && a.tan_right == b.tan_right &&
           a.tan_up == b.tan_up && a.tan_down == b.tan_down;
}

}  // namespace

TemporalFilter::TemporalFilter(Gpu& gpu, VkFormat target_format)
    : gpu_(gpu),
      linear_(make_sampler(gpu, {.mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      nearest_(make_sampler(gpu, {.filter = VK_FILTER_NEAREST,
                                  .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                  .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      set_(gpu, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                 {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                 {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                 {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                 {4, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}),
      layout_(make_pipeline_layout(gpu, {set_.layout()})),
      block_(gpu, sizeof(shared::Temporal), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      spacing_(gpu, 2 * kGridCells * sizeof(shared::vec2), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
               BufferPlace::upload) {
    for (std::uint32_t depth : {0u, 1u}) {
        pipelines_[depth] = make_fullscreen_pipeline(gpu, shader_code::temporal_resolve, layout_.get(),
                                                     {kHistoryFormat, target_format}, {{0, depth}});
    }
    set_.set_buffer(0, block_);
    set_.set_buffer(4, spacing_);
}

void TemporalFilter::cut() {
    frames_ = 0;
}

void TemporalFilter::make_history(VkExtent2D extent) {
    history_ = {};
    for (GpuImage& image : history_) {
        image = GpuImage(gpu_, {.format = kHistoryFormat,
                                .width = extent.width,
                                .height = extent.height,
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    }
    history_is_new_ = true;
    frames_ = 0;
}

void TemporalFilter::record(VkCommandBuffer commands, const Input& input) {
    assert(input.spacing->size() == kGridCells);
    const VkExtent2D extent = input.target->extent();
    if (!history_[0] || history_[0].extent().width != extent.width ||
        history_[0].extent().height != extent.height)
        make_history(extent);

    const SizePx size{static_cast<int>(extent.width), static_cast<int>(extent.height)};
    CameraView view = input.view;
    view.jitter_px = {};
    const bool fresh = frames_ == 0;
    shared::Temporal block{};
    block.camera = camera_block(view, size);
    const glm::mat4 previous = clip_from_world(fresh ? view : last_view_, size);
    std::memcpy(block.previous_clip_from_world.columns, &previous, sizeof previous);
    block.least_weight = static_cast<float>(input.least_weight);
    block.clip = kClipDeviations;
    block.fresh = fresh ? 1 : 0;
    block.still = !fresh && same_view(view, last_view_) ? 1 : 0;
    block_.write(block);
    SpacingGrid spacings = *input.spacing;
    const SpacingGrid& before = fresh ? *input.spacing : last_spacing_;
    spacings.insert(spacings.end(), before.begin(), before.end());
    spacing_.write(std::span<const shared::vec2>(spacings));

    const std::size_t next = 1 - newest_;
    set_.set_sampled_image(1, input.frame->view(), nearest_.get());
    set_.set_sampled_image(2, history_[newest_].view(), linear_.get());
    set_.set_sampled_image(3, (input.depth != nullptr ? input.depth : input.frame)->view(), nearest_.get());
    if (history_is_new_) image_barrier(commands, history_[newest_], kUseNone, kUseSampled);
    image_barrier(commands, history_[next], history_is_new_ ? kUseNone : kUseSampled, kUseColorTarget);
    begin_rendering(commands, extent,
                    {ColorTarget{.view = history_[next].view(), .discard = true},
                     ColorTarget{.view = input.target->view(), .discard = true}});
    draw_fullscreen(commands, pipelines_[input.depth != nullptr ? 1 : 0].get(), layout_.get(),
                    std::array{set_.get()});
    vkCmdEndRendering(commands);
    image_barrier(commands, history_[next], kUseColorTarget, kUseSampled);

    newest_ = next;
    history_is_new_ = false;
    ++frames_;
    last_view_ = view;
    last_spacing_ = *input.spacing;
}

}  // namespace parafovea
