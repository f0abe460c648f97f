// What a method on a sample grid keeps for one setting on one screen: the buffer of samples, its mask, the
// blocks that shaders read.
#pragma once

#include <memory>

#include "renderer/methods/foveation_method.h"
#include "renderer/methods/grid_plan.h"
#include "renderer/methods/pull_push.h"
#include "renderer/methods/sample_counter.h"

namespace parafovea {

inline constexpr VkFormat kGridMaskFormat = VK_FORMAT_D16_UNORM;
inline constexpr VkFormat kTileLayerFormat = VK_FORMAT_R8_UINT;

struct GridFormats {
    VkFormat target = VK_FORMAT_R8G8B8A8_SRGB;
    VkFormat samples = VK_FORMAT_R16G16B16A16_UNORM;  // display-linear values in [0, 1]
};

// The bindings of a grid's descriptor set; see shaders/sample_grid.glsl.
struct GridSets {
    explicit GridSets(Gpu& gpu);

    DescriptorSet placing;   // 0: grid, 1: samples of each row, 2: layer of each tile
    DescriptorSet reading;   // and 3: the samples
    DescriptorSet refining;  // of placing, and 3: the coarse samples of rings by detail
    DescriptorSet inset;     // 0: kernel map block (gaze and size of the inset)
};

class GridTargets {
  public:
    GridTargets(Gpu& gpu, const GridFormats& formats, const RenderMethod& method, SizePx screen,
                const GridPlan& plan);

    bool serves(const RenderMethod& wanted, SizePx wanted_screen) const {
        return wanted == method && wanted_screen == screen;
    }
    void set_plan(const GridPlan& wanted);  // writes the blocks if the gaze is another

    RenderMethod method;
    SizePx screen;
    GridPlan plan;
    bool mask_stale = true;
    Jitter mask_jitter;
    bool fresh = true;  // the images have never been written

    GridSets sets;
    GpuBuffer grid;
    GpuBuffer samples_of_row;
    GpuBuffer inset_map;
    GpuImage mask;           // depth 1 where a texel is needed, else 0
    GpuImage samples;        // what is shaded
    GpuImage layer_of_tile;  // tiles by detail
    GpuImage coarse;         // rings by detail: what the first round shades, and its mask
    GpuImage coarse_mask;
    SampleCounter counts;  // 0 and 1: texels needed in each round, 2: pixels of the inset
    OwnedSampler sampler;  // linear, clamped
    OwnedSampler nearest;
    std::unique_ptr<PullPush> fill;  // of a scattered grid

  private:
    bool has_plan_ = false;
};

}  // namespace parafovea
