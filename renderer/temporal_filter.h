// Anti-aliasing over time: blends every frame into a history of the screen that follows the view. The same
// for all methods, because it works on their finished pictures.
//
// Sources: Karis 2014, "High-quality temporal supersampling"; Salvi 2016, "An excursion in temporal
// supersampling". What is added for foveation: surroundings are looked for as far away as the method's
// samples lie there, and history counts for less the coarser it was drawn, so that after a saccade the new
// fovea is not a mean with what the periphery showed.
//
// While the view stands still nothing can have moved (scenes do not), and history is kept as it is: the
// picture converges to the mean of all jittered frames. In a moving view history is moved along the depth
// image: the G-buffer's, or that of marched_depth.h.
#pragma once

#include <array>
#include <vector>

#include "renderer/scene_camera.h"
#include "renderer/spacing_grid.h"

namespace parafovea {

class TemporalFilter {
  public:
    TemporalFilter(Gpu& gpu, VkFormat target_format);

    // Forgets: the next frame is shown as it is.
    void cut();

    // How many frames were recorded since the last cut.
    int frames() const { return frames_; }

    struct Input {
        const GpuImage* frame = nullptr;  // of the target's size, in kUseSampled; may hold anything
        // Reversed, infinite, in kUseSampled; may be coarser than the frame. nullptr: all is as far away as
        // the sky.
        const GpuImage* depth = nullptr;
        CameraView view;  // its jitter is ignored
        const SpacingGrid* spacing = nullptr;
        double least_weight = 0.1;         // of a frame
        const GpuImage* target = nullptr;  // in kUseColorTarget before and after
    };
    // Records one step, outside rendering. No frame may be running. Another size is a cut.
    void record(VkCommandBuffer commands, const Input& input);

  private:
    void make_history(VkExtent2D extent);

    Gpu& gpu_;
    OwnedSampler linear_;
    OwnedSampler nearest_;
    DescriptorSet set_;
    OwnedPipelineLayout layout_;
    std::array<OwnedPipeline, 2> pipelines_;  // without and with a depth image
    GpuBuffer block_;
    GpuBuffer spacing_;
    std::array<GpuImage, 2> history_;
    std::size_t newest_ = 0;
    bool history_is_new_ = true;  // the images have never been written
    int frames_ = 0;
    CameraView last_view_;
    SpacingGrid last_spacing_;
};

}  // namespace parafovea
