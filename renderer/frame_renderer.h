// Draws pictures of a scene with any foveation method, keeping what frames have in common.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "renderer/contrast_stage.h"
#include "renderer/frame_stages.h"
#include "renderer/frame_statistics.h"
#include "renderer/image.h"
#include "renderer/marched_depth.h"
#include "renderer/methods/foveation_method.h"
#include "renderer/scene_camera.h"
#include "renderer/scene_passes.h"
#include "renderer/temporal_filter.h"

namespace parafovea {

struct RenderedFrame {
    Image image;  // empty if the pixels were not asked for
    FrameStatistics statistics;
};

class FrameRenderer {
  public:
    static constexpr VkFormat kTargetFormat = VK_FORMAT_R8G8B8A8_SRGB;

    // Uploads the scene. Throws std::runtime_error with one line if memory runs out.
    FrameRenderer(Gpu& gpu, const Scene& scene, const ScenePassOptions& options = {});
    ~FrameRenderer();

    // Draws one picture and waits for it. `gaze` in pixels from the top left, anywhere; one that is not a
    // number counts as the centre. The same arguments give the same pixels, whatever was drawn before: with
    // `taa` (frame_stages.h) that many frames are drawn and blended from a fresh history. Parameters that
    // tell two eyes apart (eye_dominance.h) are those of the dominant one. Throws std::runtime_error if the
    // method is unknown, a parameter out of range or the size more than the device allows.
    RenderedFrame render(SizePx size, const CameraView& view, const RenderMethod& method, PointPx gaze,
                         bool read_pixels = true);

    // Draws the next frame of a moving view: see MovingView, which keeps the filter.
    RenderedFrame render_next(TemporalFilter& filter, SizePx size, const CameraView& view,
                              const RenderMethod& method, PointPx gaze, bool read_pixels);

    // What was drawn last, in the layout of kUseColorTarget, or of kUseTransferSource where the pixels
    // were read. Drawn again by the next picture.
    const GpuImage& target() const { return target_; }

    // How many samples a method takes for a pixel at each pixel of a screen, rows from the top. Draws
    // nothing. Throws as render() does.
    std::vector<double> sample_density(SizePx size, const RenderMethod& method, PointPx gaze);

    Gpu& gpu() { return gpu_; }

  private:
    // A picture to be drawn: what was asked for, taken apart.
    struct Order {
        SizePx size;
        CameraView view;
        RenderMethod method;  // without what the stages took
        FrameStages stages;
        PointPx gaze;
        bool read_pixels = true;
    };
    Order order(SizePx size, const CameraView& view, const RenderMethod& method, PointPx gaze,
                bool read_pixels) const;
    FoveationMethod& prepare(const Order& order);
    // One frame; `filter` nullptr: without anti-aliasing over time. The last one of a picture gets its
    // contrast and is read back.
    void draw(const Order& order, FoveationMethod& drawing, TemporalFilter* filter, bool last);
    void count(const FoveationMethod& drawing, FrameStatistics& sum) const;
    RenderedFrame finished(const Order& order, const FoveationMethod& drawing, FrameStatistics sum) const;
    void make_targets(const Order& order);
    ShadingSource shading_source() const;
    FoveationMethod& method_called(const std::string& name);

    Gpu& gpu_;
    ScenePasses passes_;
    bool shade_in_compute_;
    PassTimer timer_;
    SizePx size_;
    GpuImage target_;
    GpuImage before_stages_;    // the method's picture, where a stage follows it
    GpuImage before_contrast_;  // what anti-aliasing over time makes, where contrast follows it
    GpuBuffer pixels_;
    std::optional<TemporalFilter> still_;
    std::optional<ContrastStage> contrast_;
    std::optional<MarchedDepth> marched_depth_;  // ray-marched and moving
    std::map<std::string, std::unique_ptr<FoveationMethod>> methods_;
};

}  // namespace parafovea
