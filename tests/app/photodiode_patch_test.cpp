// The photodiode's patch, by pixels: in a window, on a headless stage, and absent where nobody asked for it.
#include "app/photodiode_patch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "app/headless_stage.h"
#include "app/window_picture.h"
#include "app/window_surface.h"

namespace parafovea {
namespace {

constexpr ViewGeometry kView{{96, 64}, 40};
constexpr SizePx kWindow{120, 90};

int grey_at(const std::vector<std::byte>& rgba, SizePx size, int x, int y) {
    return std::to_integer<int>(rgba[4 * static_cast<std::size_t>(y * size.width + x)]);
}

// A window's picture as the graphics device makes it, with a picture of one grey in it.
std::vector<std::byte> window_with(std::optional<bool> patch) {
    GpuOptions options;
    options.validation = true;
    Gpu gpu(options);
    const GpuImage picture = make_picture_image(gpu, kView.size);
    fill_picture_image(gpu, picture, std::vector<std::uint8_t>(4 * 96 * 64, 100));
    const GpuImage target = make_picture_image(gpu, kWindow);
    const WindowPicture window(gpu, kView);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        window.record(commands, picture, target.get(), kWindow, patch, kUseTransferSource);
    });
    std::vector<std::byte> pixels = read_back(gpu, target, kUseTransferSource);
    EXPECT_TRUE(gpu.validation_messages().empty());
    return pixels;
}

TEST(PhotodiodePatch, StandsInTheWindowsLowerLeftCornerAndNowhereElse) {
    const int side = patch_side_px(kView);
    ASSERT_GT(side, 4);
    const std::vector<std::byte> none = window_with(std::nullopt), white = window_with(true),
                                 black = window_with(false);
    const Placement place = placement_of(kView.size, kWindow);
    for (int y = 0; y < kWindow.height; ++y)
        for (int x = 0; x < kWindow.width; ++x) {
            const bool in_picture =
                x >= place.left_px && x < place.left_px + 96 && y >= place.top_px && y < place.top_px + 64;
            const bool in_patch = x < side && y >= kWindow.height - side;
            const int without = in_picture ? 100 : 0;
            ASSERT_EQ(grey_at(none, kWindow, x, y), without) << x << ", " << y;
            ASSERT_EQ(grey_at(white, kWindow, x, y), in_patch ? 255 : without) << x << ", " << y;
            ASSERT_EQ(grey_at(black, kWindow, x, y), in_patch ? 0 : without) << x << ", " << y;
        }
}

class LookingAudience final : public Audience {
  public:
    bool looks_at(const Picture&, HostTime) override { return true; }
    void sees(const RenderedPicture& picture, HostTime) override { seen = picture; }

    RenderedPicture seen;
};

TEST(PhotodiodePatch, IsInWhatAHeadlessStageShowsButNotInTheStimulusHash) {
    SimulatedClock clock;
    PictureSource pictures(kView);
    LookingAudience audience;
    HeadlessStage stage(kView, 70, clock, pictures, audience);
    Picture picture;
    picture.kind = PictureKind::stimulus;
    picture.scene = "primitives";
    picture.method.method = "full";
    picture.fovea = centre_of(kView.size);
    const ShownFrame plain = stage.show(picture);
    const RenderedPicture without = audience.seen;
    picture.patch = true;
    EXPECT_EQ(stage.show(picture).image_hash, plain.image_hash);
    const RenderedPicture with = audience.seen;
    picture.patch = false;
    EXPECT_EQ(stage.show(picture).image_hash, plain.image_hash);
    const int side = patch_side_px(kView);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) {
            const std::size_t at = 4 * static_cast<std::size_t>(y * 96 + x);
            const bool in_patch = x < side && y >= 64 - side;
            for (std::size_t c = 0; c < 3; ++c) {
                ASSERT_EQ(with.rgba[at + c], in_patch ? 255 : without.rgba[at + c]) << x << ", " << y;
                ASSERT_EQ(audience.seen.rgba[at + c], in_patch ? 0 : without.rgba[at + c]) << x << ", " << y;
            }
        }
}

}  // namespace
}  // namespace parafovea
