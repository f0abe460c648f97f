// Draws pictures of a scene with any foveation method, keeping what frames have in common.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "renderer/frame_statistics.h"
#include "renderer/image.h"
#include "renderer/methods/foveation_method.h"
#include "renderer/scene_camera.h"
#include "renderer/scene_passes.h"

namespace parafovea {

struct RenderedFrame {
    Image image;  // empty if the pixels were not asked for
    FrameStatistics statistics;
};

class FrameRenderer {
  public:
    // Uploads the scene. Throws std::runtime_error with one line if memory runs out.
    FrameRenderer(Gpu& gpu, const Scene& scene, const ScenePassOptions& options = {});
    ~FrameRenderer();

    // Draws one frame and waits for it. `gaze` in pixels from the top left, anywhere; one that is not a
    // number counts as the centre. The same arguments give the same pixels, whatever was drawn before. Throws
    // std::runtime_error if the method is unknown, a parameter out of range or the size more than the device
    // allows.
    RenderedFrame render(SizePx size, const CameraView& view, const RenderMethod& method, PointPx gaze,
                         bool read_pixels = true);

    // What render() drew last, in the layout of kUseColorTarget, or of kUseTransferSource where the pixels
    // were read. Drawn again by the next render().
    const GpuImage& target() const { return target_; }

  private:
    void make_targets(SizePx size);
    FoveationMethod& method_called(const std::string& name);

    Gpu& gpu_;
    ScenePasses passes_;
    PassTimer timer_;
    SizePx size_;
    GpuImage target_;
    GpuBuffer pixels_;
    std::map<std::string, std::unique_ptr<FoveationMethod>> methods_;
};

}  // namespace parafovea
