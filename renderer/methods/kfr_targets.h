// What kernel foveated rendering keeps for one setting on one screen: the map, the reduced buffer and its
// mask.
#pragma once

#include <optional>

#include "renderer/kernel_setting.h"
#include "renderer/methods/foveation_method.h"
#include "renderer/methods/gaze_disc.h"
#include "renderer/methods/sample_counter.h"
#include "renderer/methods/texel_list.h"

namespace parafovea {

struct KfrSetting {
    KernelSetting kernel;
    bool culling = true;          // shade only texels that are read
    bool internal_filter = true;  // 3x3 Gaussian over the peripheral half of the buffer
    bool post_filter = false;     // Eq. 14 on the screen
    int post_filter_cap = 11;     // its largest width in pixels, odd
    double inset = 0;  // radius of the disc at full resolution, share of the screen's shorter side; 0: none

    bool operator==(const KfrSetting&) const = default;
};

// How the result is stored.
struct KfrFormats {
    VkFormat target = VK_FORMAT_R8G8B8A8_SRGB;
    VkFormat reduced =
        VK_FORMAT_R16G16B16A16_UNORM;  // display-linear values in [0, 1]; finer than halves near 1
    bool in_compute = false;  // Pass I runs in compute shaders, which can write `reduced` as a storage image
    bool exact_bilinear = false;  // Pass II interpolates with full float weights instead of the sampler's
};

inline constexpr VkFormat kKfrMaskFormat = VK_FORMAT_D16_UNORM;
inline constexpr VkFormat kKfrScreenFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

class KfrTargets {
  public:
    KfrTargets(Gpu& gpu, const KfrFormats& formats, const TexelList::Maker& list_maker, ShadedThing thing,
               const KfrSetting& setting, SizePx screen);

    // Whether texels that are finer than pixels have the light of the pixel that they lie in, as scenes at
    // full resolution have; meshes are cut into pixels anyway. Not below an inset.
    static bool takes_light_of_pixels(ShadedThing thing, const KfrSetting& setting) {
        return thing != ShadedThing::picture && setting.inset == 0;
    }

    bool serves(const KfrSetting& wanted, SizePx wanted_screen) const {
        return wanted == setting && wanted_screen == screen;
    }
    void set_gaze(PointPx wanted);  // writes the map if the gaze is another

    KfrSetting setting;
    SizePx screen;
    SizePx buffer;
    PointPx gaze;
    bool mask_stale = true;
    Jitter mask_jitter;  // of the samples that the mask is about
    bool fresh = true;   // the images have never been written

    shared::KernelMap block{};  // what `map` holds
    GpuBuffer map;
    GpuImage mask;         // depth 1 where a texel is needed, else 0; with culling or in compute shaders
    GpuImage fine_pixels;  // with culling: the pixels whose light fine texels take
    std::optional<TexelList> listed;  // in compute shaders: the needed texels
    GpuImage reduced;                 // what Pass I shades and Pass II reads
    GpuImage filtered_u;              // `reduced` after the first half of the internal filter
    GpuImage screen_linear;           // Pass II's result for the post filter
    SampleCounter counts;  // 0: texels needed beyond the fine columns, 1: pixels of the inset or for those
    OwnedSampler sampler;
    DescriptorSet map_set;         // 0: map
    DescriptorSet listed_set;      // 0 and 1: listed, 2: reduced
    DescriptorSet reduced_set;     // 0: reduced
    DescriptorSet filtered_u_set;  // 0: filtered_u
    DescriptorSet fine_set;        // 0: map, 1: fine_pixels
    DescriptorSet resample_set;    // 0: map, 1: reduced
    DescriptorSet post_set;        // 0: map, 1: screen_linear

    // The first columns, which are not shaded texel by texel.
    std::uint32_t culled_columns() const {
        return setting.culling ? static_cast<std::uint32_t>(block.fine_columns) : 0;
    }
    GazeDisc fine_disc() const;  // what is drawn of fine_pixels

  private:
    void set_fine_columns();

    float most_fine_area_ = 0;
    float fine_px_ = 0;       // the square around the gaze's own pixel has 2 fine_px_ + 1 on a side
    float most_fine_px_ = 0;  // of all gazes
    bool has_gaze_ = false;
};

// The layouts of the sets above, the same for all targets, for building pipelines.
struct KfrLayouts {
    KfrLayouts(Gpu& gpu, VkDescriptorSetLayout shading);

    DescriptorSet map_set;
    DescriptorSet listed_set;
    DescriptorSet reduced_set;
    DescriptorSet map_and_image_set;
    OwnedPipelineLayout mask;
    OwnedPipelineLayout shading;
    OwnedPipelineLayout listed_shading;
    OwnedPipelineLayout filter;
    OwnedPipelineLayout resample;  // and post
};

}  // namespace parafovea
