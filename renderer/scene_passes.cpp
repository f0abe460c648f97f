// Records the geometry passes of a scene and keeps descriptor set 0 filled.
#include "renderer/scene_passes.h"

#include <cassert>

#include "renderer/scene_lighting.h"

namespace parafovea {

struct ScenePasses::Parts {
    Gpu& gpu;
    ScenePassOptions options;
    bool ray_marched = false;
    SceneFeatures features;
    SizePx size;
    CameraView view;
    shared::Camera camera{};
    shared::Lighting lighting{};
    GpuBuffer camera_buffer;
    GpuBuffer lighting_buffer;
    DescriptorSet set;
    std::vector<FeatureNote> built;
    std::vector<FeatureNote> left_out;
    std::uint64_t triangles_in_view = 0;
};

namespace {

const ResourceUse kUseUniform{VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};

}  // namespace

ScenePasses::ScenePasses(Gpu& gpu, const Scene& scene, const ScenePassOptions& options)
    : parts_(new Parts{.gpu = gpu, .options = options}) {
    Parts& p = *parts_;
    p.ray_marched = scene.ray_marched;
    p.features = features_of(scene);
    p.lighting = lighting_block(scene);
    p.camera_buffer =
        GpuBuffer(gpu, sizeof(shared::Camera),
                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::device);
    p.lighting_buffer =
        GpuBuffer(gpu, sizeof(shared::Lighting), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload);
    p.lighting_buffer.write(p.lighting);
    p.set = DescriptorSet(gpu, {{shared::kBindCamera}, {shared::kBindLighting}});
    p.set.set_buffer(shared::kBindCamera, p.camera_buffer);
    p.set.set_buffer(shared::kBindLighting, p.lighting_buffer);
}

ScenePasses::~ScenePasses() = default;

bool ScenePasses::ray_marched() const {
    return parts_->ray_marched;
}

void ScenePasses::set_view(SizePx size, const CameraView& view) {
    assert(size.width > 0 && size.height > 0);
    Parts& p = *parts_;
    p.size = size;
    p.view = view;
    p.camera = camera_block(view, size);
}

void ScenePasses::record(VkCommandBuffer commands, PassTimer*) {
    Parts& p = *parts_;
    memory_barrier(commands, kUseUniform, kUseTransferTarget);
    vkCmdUpdateBuffer(commands, p.camera_buffer.get(), 0, sizeof(shared::Camera), &p.camera);
    memory_barrier(commands, kUseTransferTarget, kUseUniform);
}

VkDescriptorSetLayout ScenePasses::shading_set_layout() const {
    return parts_->set.layout();
}
VkDescriptorSet ScenePasses::shading_set() const {
    return parts_->set.get();
}

std::vector<ShaderConstant> ScenePasses::shading_constants() const {
    const Parts& p = *parts_;
    return {{shared::kConstFootprint, p.options.filter_over_spacing ? 1u : 0u},
            {shared::kConstSamples, p.options.samples_per_sample}};
}

const shared::Camera& ScenePasses::camera() const {
    return parts_->camera;
}
const GpuImage* ScenePasses::depth() const {
    return nullptr;
}
const std::vector<FeatureNote>& ScenePasses::built() const {
    return parts_->built;
}
const std::vector<FeatureNote>& ScenePasses::left_out() const {
    return parts_->left_out;
}
std::uint64_t ScenePasses::triangles_in_view() const {
    return parts_->triangles_in_view;
}

}  // namespace parafovea
