// Contrast preservation: what is flat and what is in the fovea stays, the mean stays, the periphery's
// contrast rises.
#include "renderer/contrast_stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/frame_renderer.h"
#include "renderer/scene_catalog.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

constexpr SizePx kSize{128, 72};

// Samples as far apart as this in the right half of the screen, at every pixel in the left half.
SpacingGrid coarse_on_the_right(float spacing_px) {
    SpacingGrid grid;
    for (shared::uint j = 0; j < shared::kSpacingRows; ++j) {
        for (shared::uint i = 0; i < shared::kSpacingColumns; ++i) {
            const float spacing = i < shared::kSpacingColumns / 2 ? 1 : spacing_px;
            grid.emplace_back(spacing, spacing);
        }
    }
    return grid;
}

Image with_contrast(Gpu& gpu, const Image& picture, const SpacingGrid& spacing, double gain) {
    const auto width = static_cast<std::uint32_t>(picture.size.width);
    const auto height = static_cast<std::uint32_t>(picture.size.height);
    GpuImage source(gpu, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                          .width = width,
                          .height = height,
                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    upload(gpu, source, std::as_bytes(std::span(picture.rgba)));
    GpuImage target(gpu, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                          .width = width,
                          .height = height,
                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    ContrastStage stage(gpu, VK_FORMAT_R8G8B8A8_SRGB);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        image_barrier(commands, target, kUseNone, kUseColorTarget);
        stage.record(commands, source, spacing, gain, target);
    });
    const std::vector<std::byte> bytes = read_back(gpu, target, kUseColorTarget);
    Image image{picture.size, std::vector<std::uint8_t>(bytes.size())};
    std::memcpy(image.rgba.data(), bytes.data(), bytes.size());
    return image;
}

double linear(std::uint8_t srgb) {
    const double v = srgb / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

struct Moments {
    double mean = 0;
    double deviation = 0;
};

// Of display-linear green in columns [first, last).
Moments moments(const Image& image, int first, int last) {
    double sum = 0, squares = 0;
    int count = 0;
    for (int y = 0; y < image.size.height; ++y) {
        for (int x = first; x < last; ++x) {
            const double v = linear(image.rgba[static_cast<std::size_t>(y * image.size.width + x) * 4 + 1]);
            sum += v;
            squares += v * v;
            ++count;
        }
    }
    return {sum / count, std::sqrt(squares / count - sum / count * (sum / count))};
}

// Noise around middle grey that stays within the range when its contrast rises.
Image grey_noise() {
    Image image = noise_picture(kSize, 5);
    for (std::uint8_t& value : image.rgba) value = static_cast<std::uint8_t>(150 + value / 8);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return image;
}

TEST(ContrastStage, FlatPictureIsUnchanged) {
    Gpu gpu({.validation = true});
    Image flat{kSize, {}};
    for (int i = 0; i < kSize.width * kSize.height; ++i)
        flat.rgba.insert(flat.rgba.end(), {200, 17, 96, 255});
    EXPECT_TRUE(with_contrast(gpu, flat, coarse_on_the_right(9), 1) == flat);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(ContrastStage, FoveaIsUnchangedBitForBit) {
    Gpu gpu({.validation = true});
    const Image noise = grey_noise();
    const Image found = with_contrast(gpu, noise, coarse_on_the_right(6), 0.5);
    int changed_on_the_right = 0;
    for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
            const std::size_t at = static_cast<std::size_t>(y * kSize.width + x) * 4;
            const bool same = std::equal(&noise.rgba[at], &noise.rgba[at] + 4, &found.rgba[at]);
            // The grid's last cell of the left half is 2 pixels wide.
            if (x < kSize.width / 2 - 2) {
                EXPECT_TRUE(same) << x << ", " << y;
            } else if (!same) {
                ++changed_on_the_right;
            }
        }
    }
    EXPECT_GT(changed_on_the_right, kSize.width * kSize.height / 4);
}

TEST(ContrastStage, MeanIsKeptAndPeripheralContrastRisesByTheGain) {
    Gpu gpu({.validation = true});
    const Image noise = grey_noise();
    double before = 1;
    for (const float spacing : {2.0f, 4.0f, 7.0f}) {
        const Image found = with_contrast(gpu, noise, coarse_on_the_right(spacing), 0.2);
        const int first = kSize.width / 2 + 10;
        const Moments was = moments(noise, first, kSize.width), is = moments(found, first, kSize.width);
        EXPECT_NEAR(is.mean, was.mean, 0.005 * was.mean) << spacing;
        // White noise is nearly all contrast to its surroundings' mean: the more so the wider they are.
        const double gain = 1 + 0.2 * std::sqrt(2.0) * 0.5 * (spacing - 1);
        EXPECT_LE(is.deviation / was.deviation, 1.02 * gain) << spacing;
        EXPECT_GE(is.deviation / was.deviation, 1 + 0.8 * (gain - 1)) << spacing;
        EXPECT_GT(is.deviation / was.deviation, before);
        before = is.deviation / was.deviation;
    }
}

TEST(ContrastStage, LeavesFullResolutionAloneAndRaisesTheContrastOfAFoveatedScene) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const SizePx size{160, 90};
    const CameraView view = view_through(scene.cameras[0], size);
    const PointPx gaze{20, 45};
    const Image full = renderer.render(size, view, {}, gaze).image;
    EXPECT_TRUE(renderer.render(size, view, {"full", {{"contrast", 0.2}}, {}}, gaze).image == full);
    const Image plain = renderer.render(size, view, {"kfr", {{"sigma", 4}}, {}}, gaze).image;
    const Image lifted =
        renderer.render(size, view, {"kfr", {{"sigma", 4}, {"contrast", 0.2}}, {}}, gaze).image;
    EXPECT_GT(moments(lifted, 80, 160).deviation, 1.005 * moments(plain, 80, 160).deviation);
    // The clamp of the published code cuts off what would be darker than black.
    EXPECT_NEAR(moments(lifted, 80, 160).mean, moments(plain, 80, 160).mean,
                0.04 * moments(plain, 80, 160).mean);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

}  // namespace
}  // namespace parafovea
