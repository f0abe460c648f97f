// Flicker of highlights and textures along a camera path: filtering over the foveated footprint calms it, and
// so does anti-aliasing over time.
#include <gtest/gtest.h>

#include <vector>

#include "analysis/visible_difference_video.h"
#include "app/picture_pair_judge.h"
#include "renderer/scene_catalog.h"
#include "renderer/temporal_view.h"

namespace parafovea {
namespace {

constexpr SizePx kSize{240, 136};
constexpr int kFrames = 4;
constexpr double kFramesPerSecond = 70;

CameraView view_of_frame(const Scene& scene, int i) {
    return view_through(camera_on_path(scene, static_cast<float>(1 + i / kFramesPerSecond)), kSize);
}

// One video along the scene's path, after the history has filled.
std::vector<Image> fly(FrameRenderer& renderer, const Scene& scene, const RenderMethod& method,
                       PointPx gaze) {
    MovingView moving(renderer);
    std::vector<Image> frames;
    for (int i = -kFrames; i < kFrames; ++i) {
        const bool shown = i >= 0;
        if (!shown && !method.numbers.contains("taa")) continue;
        RenderedFrame frame = moving.render(kSize, view_of_frame(scene, i), method, gaze, shown);
        if (shown) frames.push_back(std::move(frame.image));
    }
    return frames;
}

// The same video without flicker: every frame is what the method shows when the view stands still there.
std::vector<Image> calm(FrameRenderer& renderer, const Scene& scene, RenderMethod method, PointPx gaze) {
    method.numbers["taa"] = 4;
    std::vector<Image> frames;
    for (int i = 0; i < kFrames; ++i)
        frames.push_back(renderer.render(kSize, view_of_frame(scene, i), method, gaze).image);
    return frames;
}

// The transient channel's visible difference from the reference, the mean over the frames after the first.
double flicker(const std::vector<Image>& video, const std::vector<Image>& reference, PointPx gaze) {
    VideoVisibleDifference difference(display_model({kSize, 60}, 100), kFramesPerSecond);
    double sum = 0;
    for (std::size_t i = 0; i < video.size(); ++i) {
        const auto seen = [](const Image& image) {
            return RgbaView{image.rgba, image.size.width, image.size.height};
        };
        const FrameDifference frame =
            difference.add_frame(seen(video[i]), seen(reference[i]), {gaze.x, gaze.y});
        if (i > 0) sum += frame.transient.q;
    }
    return sum / static_cast<double>(video.size() - 1);
}

TEST(Flicker, IsCalmerWithFilteringOverTheFootprintAndWithAntiAliasingOverTime) {
    Gpu gpu;
    const Scene scene = load_scene("atrium");
    const PointPx gaze{10, 68};  // most of the picture is periphery
    const RenderMethod kfr{"kfr", {{"sigma", 2.4}}, {}};
    const RenderMethod smooth{"kfr", {{"sigma", 2.4}, {"taa", 8}}, {}};

    FrameRenderer filtering(gpu, scene), not_filtering(gpu, scene, {.filter_over_spacing = false});
    const double unfiltered =
        flicker(fly(not_filtering, scene, kfr, gaze), calm(not_filtering, scene, kfr, gaze), gaze);
    const std::vector<Image> reference = calm(filtering, scene, kfr, gaze);
    const double filtered = flicker(fly(filtering, scene, kfr, gaze), reference, gaze);
    const double over_time = flicker(fly(filtering, scene, smooth, gaze), reference, gaze);
    RecordProperty("unfiltered", std::to_string(unfiltered));
    RecordProperty("filtered", std::to_string(filtered));
    RecordProperty("over_time", std::to_string(over_time));
    EXPECT_LT(filtered, unfiltered);
    EXPECT_LT(over_time, filtered);
}

}  // namespace
}  // namespace parafovea
