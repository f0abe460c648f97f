// For tests of foveation methods: a picture in the place of a scene, and a method that draws from it.
#pragma once

#include <cmath>
#include <concepts>
#include <cstring>
#include <memory>

#include "devices/random.h"
#include "renderer/gpu_pipeline.h"
#include "renderer/image.h"
#include "renderer/methods/method_list.h"

namespace parafovea {

// Noise, the hardest picture to interpolate.
inline Image noise_picture(SizePx size, std::uint64_t seed = 1) {
    Random random(seed);
    Image image{size, {}};
    image.rgba.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 4);
    for (std::uint8_t& value : image.rgba) value = static_cast<std::uint8_t>(random.below(256));
    return image;
}

// Slow waves of colour, which foveation hardly changes.
inline Image smooth_picture(SizePx size) {
    Image image{size, {}};
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (const double wave : {x * 0.011 + y * 0.003, y * 0.013, (x - y) * 0.007}) {
                image.rgba.push_back(static_cast<std::uint8_t>(std::lround(127.5 + 120 * std::sin(wave))));
            }
            image.rgba.push_back(255);
        }
    }
    return image;
}

// Draws a picture through a method of the list; sRGB targets, the picture's values are taken as
// display-linear.
class PictureMethod {
  public:
    PictureMethod(Gpu& gpu, const Image& picture, const std::string& name)
        : PictureMethod(gpu, picture,
                        [&](const ShadingSource& source) { return make_method(gpu, name, source); }) {}

    // With any method that `make` builds for a ShadingSource.
    template <std::invocable<const ShadingSource&> Make>
    PictureMethod(Gpu& gpu, const Image& picture, Make&& make)
        : gpu_(gpu),
          size_(picture.size),
          source_(gpu, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                        .width = static_cast<std::uint32_t>(size_.width),
                        .height = static_cast<std::uint32_t>(size_.height),
                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}),
          target_(gpu, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                        .width = static_cast<std::uint32_t>(size_.width),
                        .height = static_cast<std::uint32_t>(size_.height),
                        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}),
          sampler_(make_sampler(gpu, {.filter = VK_FILTER_NEAREST})),
          set_(gpu, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}}),
          timer_(gpu, 16),
          method_(make({.thing = ShadedThing::picture, .layout = set_.layout(), .constants = {}})) {
        upload(gpu, source_, std::as_bytes(std::span(picture.rgba)));
        set_.set_sampled_image(0, source_.view(), sampler_.get());
    }

    Image draw(const RenderMethod& setting, PointPx gaze, Jitter jitter = {}) {
        method_->configure(setting);
        method_->prepare(size_, gaze);
        gpu_.submit_and_wait([&](VkCommandBuffer commands) {
            timer_.reset(commands);
            image_barrier(commands, target_, kUseNone, kUseColorTarget);
            method_->record({commands, set_.get(), &target_, &timer_, jitter});
        });
        const std::vector<std::byte> bytes = read_back(gpu_, target_, kUseColorTarget);
        Image image{size_, std::vector<std::uint8_t>(bytes.size())};
        std::memcpy(image.rgba.data(), bytes.data(), bytes.size());
        return image;
    }

    SampleSpacing spacing_at(PointPx position) const { return method_->spacing_at(position); }
    MethodStatistics statistics() const { return method_->statistics(); }
    std::vector<PassTimer::Pass> passes() const { return timer_.passes(); }

  private:
    Gpu& gpu_;
    SizePx size_;
    GpuImage source_;
    GpuImage target_;
    OwnedSampler sampler_;
    DescriptorSet set_;
    PassTimer timer_;
    std::unique_ptr<FoveationMethod> method_;
};

}  // namespace parafovea
