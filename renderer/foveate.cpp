// Runs kernel foveated rendering with a picture in the place of a scene.
#include "renderer/foveate.h"

#include <cassert>
#include <cstring>
#include <span>

#include "renderer/gpu_pipeline.h"
#include "renderer/methods/kfr_method.h"

namespace parafovea {

Image foveate(Gpu& gpu, const Image& picture, const KernelSetting& setting, PointPx gaze,
              const FoveateOptions& options) {
    check(setting);
    assert(picture.size.width > 0 && picture.size.height > 0);
    const auto width = static_cast<std::uint32_t>(picture.size.width);
    const auto height = static_cast<std::uint32_t>(picture.size.height);
    const GpuImage source(gpu, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                                .width = width,
                                .height = height,
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    upload(gpu, source, std::as_bytes(std::span(picture.rgba)));
    const GpuImage target(gpu,
                          {.format = VK_FORMAT_R8G8B8A8_UNORM,
                           .width = width,
                           .height = height,
                           .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    const OwnedSampler sampler = make_sampler(gpu, {.filter = VK_FILTER_NEAREST});
    DescriptorSet set(gpu, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}});
    set.set_sampled_image(0, source.view(), sampler.get());

    KfrMethod method(gpu, {.thing = ShadedThing::picture, .layout = set.layout(), .constants = {}},
                     {.target = VK_FORMAT_R8G8B8A8_UNORM,
                      .reduced = VK_FORMAT_R32G32B32A32_SFLOAT,
                      .exact_bilinear = true});
    method.configure(KfrSetting{
        .kernel = setting, .internal_filter = options.internal_filter, .post_filter = options.post_filter});
    method.prepare(picture.size, gaze);
    PassTimer timer(gpu, 4);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        timer.reset(commands);
        image_barrier(commands, target, kUseNone, kUseColorTarget);
        method.record({commands, set.get(), &target, &timer});
    });
    Image result{picture.size, std::vector<std::uint8_t>(picture.rgba.size())};
    const std::vector<std::byte> bytes = read_back(gpu, target, kUseColorTarget);
    std::memcpy(result.rgba.data(), bytes.data(), bytes.size());
    return result;
}

}  // namespace parafovea
