// Draws a scene's geometry for one view into the targets that shade_sample() reads (shaders/shading.glsl):
// the shadow map, depth, the G-buffer. A ray-marched scene has none of these passes. Whatever a scene does
// not need is not built.
//
//   ScenePasses passes(gpu, scene);
//   passes.set_view(size, view);
//   passes.record(commands, &timer);          // outside rendering; then draw with shading_set() as set 0
//
// Several views may be drawn in one command buffer: set_view, record, shade; set_view, record, shade.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/gpu_pipeline.h"
#include "renderer/scene.h"
#include "renderer/scene_camera.h"

namespace parafovea {

// A feature, and why it was built or left out.
struct FeatureNote {
    std::string name;
    std::string reason;
};

struct ScenePassOptions {
    bool force_everything =
        false;  // build what the scene does not need, too; to measure what leaving out saves
    bool filter_over_spacing =
        true;  // textures and highlights are filtered over spacing_px, not over one pixel
    // Textures are read for each sample where the scene allows it (see scene_surface_textures.h), not for
    // each pixel. When absent: on software devices, which pay for every lookup and have no anisotropic ones
    // to lose.
    std::optional<bool> late_textures;
    // Methods that can shade their samples in compute shaders, not in fragments. When absent: on all devices
    // but software ones, which run fragments faster.
    std::optional<bool> shade_in_compute;
    // While the view stays as it is, geometry is not drawn again.
    bool keep_geometry = true;
    // Each piece of a mesh is drawn in the coarsest level of detail no vertex of which appears farther than
    // this from where full detail shows it. 0, or force_everything: full detail. Half a pixel's diagonal
    // changes `street` by 36 dB; a camera a quarter of a pixel aside, by 31 dB.
    double most_detail_error_px = 0.7;
    std::uint32_t samples_per_sample = 1;  // ray-marched: rays for each shade_sample()
};

class ScenePasses {
  public:
    // Uploads the scene; it is not needed afterwards. Throws std::runtime_error if memory runs out.
    ScenePasses(Gpu& gpu, const Scene& scene, const ScenePassOptions& options = {});
    ~ScenePasses();
    ScenePasses(const ScenePasses&) = delete;
    ScenePasses& operator=(const ScenePasses&) = delete;

    bool ray_marched() const;

    // The next record() draws this view. Targets are made anew when the size changes, and shading_set() with
    // them; nothing that uses the old ones may still be running.
    void set_view(SizePx size, const CameraView& view);

    // Records every pass the scene needs, each between timer->start(name) and timer->stop(): "shadow" (only
    // when something changed), "depth", "defer" (not if the targets hold this view already). Leaves
    // everything ready to be sampled by fragment and compute shaders.
    void record(VkCommandBuffer commands, PassTimer* timer);

    // For pipelines that include shading.glsl: compile it with SCENE_PRIMITIVES if ray_marched(), else
    // SCENE_MESHES.
    VkDescriptorSetLayout shading_set_layout() const;
    VkDescriptorSet shading_set() const;
    std::vector<ShaderConstant> shading_constants() const;

    // The view as shaders see it, and the depth image (reversed, infinite; in kUseSampled after record());
    // nullptr if ray-marched.
    const shared::Camera& camera() const;
    const GpuImage* depth() const;

    const std::vector<FeatureNote>& built() const;
    const std::vector<FeatureNote>& left_out() const;  // the last record()'s, too

    // Of the last set_view(): triangles that are drawn, and as many as there would be in full detail.
    std::uint64_t triangles_in_view() const;
    std::uint64_t full_triangles_in_view() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace parafovea
