// Makes the list of texels with three compute shaders.
#include "renderer/methods/texel_list.h"

#include <cstddef>
#include <span>

#include "renderer/shared/texel_list.h"
#include "shader_code/texel_list.h"
#include "shader_code/texel_list_rows.h"
#include "shader_code/texel_list_words.h"

namespace parafovea {
namespace {

constexpr std::uint32_t kRowsOfGroup = 64;  // see texel_list.comp

constexpr ResourceUse kUseHeader{
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};

GpuImage list_image(Gpu& gpu, std::uint32_t texels) {
    return GpuImage(gpu, {.format = VK_FORMAT_R32_UINT,
                          .width = shared::kListWidth,
                          .height = (texels + shared::kListWidth - 1) / shared::kListWidth,
                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

GpuBuffer storage(Gpu& gpu, std::size_t count) {
    return GpuBuffer(gpu, count * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                     BufferPlace::device);
}

DescriptorSet making_set(Gpu& gpu) {
    return DescriptorSet(gpu, {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                               {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                               {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                               {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                               {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}});
}

}  // namespace

TexelList::Maker::Maker(Gpu& gpu)
    : set(making_set(gpu)),
      layout(make_pipeline_layout(gpu, {set.layout()})),
      words(make_compute_pipeline(gpu, shader_code::texel_list_words, layout.get())),
      rows(make_compute_pipeline(gpu, shader_code::texel_list_rows, layout.get())),
      list(make_compute_pipeline(gpu, shader_code::texel_list, layout.get())),
      nearest(make_sampler(gpu, {.filter = VK_FILTER_NEAREST, .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST})) {}

TexelList::TexelList(Gpu& gpu, const Maker& maker, const GpuImage& mask)
    : height_(mask.extent().height),
      words_of_row_((mask.extent().width + shared::kTexelsPerWord - 1) / shared::kTexelsPerWord),
      header_(gpu, sizeof(shared::TexelListHeader),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                  VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
              BufferPlace::device),
      listed_(list_image(gpu, mask.extent().width * height_)),
      words_(storage(gpu, std::size_t{words_of_row_} * height_)),
      first_of_row_(storage(gpu, height_)),
      nearest_(maker.nearest.get()),
      set_(making_set(gpu)) {
    shared::TexelListHeader header{};
    header.groups_z = 1;
    header.width = mask.extent().width;
    header.height = height_;
    upload(gpu, header_, std::as_bytes(std::span(&header, 1)));
    set_.set_buffer(0, header_);
    set_.set_storage_image(1, listed_.view());
    set_.set_buffer(2, words_);
    set_.set_buffer(3, first_of_row_);
    set_.set_sampled_image(4, mask.view(), nearest_);
}

void TexelList::bind_to(DescriptorSet& reading) const {
    reading.set_buffer(kHeaderBinding.binding, header_);
    reading.set_sampled_image(kListBinding.binding, listed_.view(), nearest_);
}

void TexelList::record(VkCommandBuffer commands, const Maker& maker) const {
    const std::uint32_t groups = (height_ + kRowsOfGroup - 1) / kRowsOfGroup;
    const VkDescriptorSet set = set_.get();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, maker.layout.get(), 0, 1, &set, 0,
                            nullptr);
    memory_barrier(commands, kUseHeader, kUseComputeStorage);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, maker.words.get());
    vkCmdDispatch(commands, groups, words_of_row_, 1);
    memory_barrier(commands, kUseComputeStorage, kUseComputeStorage);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, maker.rows.get());
    vkCmdDispatch(commands, 1, 1, 1);
    memory_barrier(commands, kUseComputeStorage, kUseComputeStorage);
    image_barrier(commands, listed_, kUseSampledBefore, kUseComputeStorage);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, maker.list.get());
    vkCmdDispatch(commands, groups, words_of_row_, 1);
    memory_barrier(commands, kUseComputeStorage, kUseHeader);
    image_barrier(commands, listed_, kUseComputeStorage, kUseSampled);
}

void TexelList::dispatch(VkCommandBuffer commands) const {
    vkCmdDispatchIndirect(commands, header_.get(), offsetof(shared::TexelListHeader, groups_x));
}

}  // namespace parafovea
