// Fits an orthographic view along the sun's rays around the scene and draws depth from it.
#include "renderer/scene_shadow.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace parafovea {
namespace {

// Texels of at most about a centimetre, on maps of at most this edge.
constexpr std::uint32_t kSmallMap = 2048;
constexpr std::uint32_t kLargeMap = 4096;
constexpr float kSmallMapReach_m = 24;
// A lamp's own glass and cage lie nearer than this.
constexpr float kLampNear_m = 0.3f;
constexpr std::uint32_t kLampMap = 1024;
constexpr float kWidestHalfAngle_rad =
    1.31f;  // beyond 75 degrees a flat map has no texels left for the middle

// Depth of every opaque instance that a light may see.
void draw_casters(VkCommandBuffer commands, Gpu& gpu, SceneResources& resources, VkImageView target_view,
                  VkExtent2D extent, const glm::mat4& clip_from_world) {
    const DepthTarget target{target_view, true, 1.0f, false};
    begin_rendering(commands, extent, {}, &target);
    resources.bind_geometry(commands);
    VkPipeline bound = VK_NULL_HANDLE;
    for (const DrawInstance& instance : resources.instances()) {
        const DrawMaterial& material = resources.material_of(instance);
        if (material.blend) continue;  // light passes through glass
        if (instance.bounds.empty() || !may_be_seen(instance.bounds, clip_from_world)) continue;
        const VkPipeline pipeline = resources.shadow_pipeline(gpu, material.mask);
        if (pipeline != bound) vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound = pipeline;
        if (material.mask) {
            const VkDescriptorSet set = material.set.get();
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, resources.layout(), 0, 1, &set,
                                    0, nullptr);
        }
        const glm::mat4 clip_from_mesh = clip_from_world * instance.world_from_mesh;
        vkCmdPushConstants(commands, resources.layout(), kPushConstantStages, 0, sizeof clip_from_mesh,
                           &clip_from_mesh);
        const DrawMesh& mesh = resources.meshes()[instance.mesh];
        vkCmdDrawIndexed(commands, mesh.index_count, 1, mesh.first_index, mesh.first_vertex, 0);
    }
    vkCmdEndRendering(commands);
}

}  // namespace

bool may_be_seen(const Bounds& box, const glm::mat4& clip_from_world) {
    int left = 0, right = 0, above = 0, below = 0, behind = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 p = clip_from_world * glm::vec4(corner & 1 ? box.high.x : box.low.x,
                                                        corner & 2 ? box.high.y : box.low.y,
                                                        corner & 4 ? box.high.z : box.low.z, 1);
        left += p.x < -p.w;
        right += p.x > p.w;
        above += p.y < -p.w;
        below += p.y > p.w;
        behind += p.w <= 0;
    }
    return left < 8 && right < 8 && above < 8 && below < 8 && behind < 8;
}

SunShadow::SunShadow(Gpu& gpu, const SceneResources& resources, glm::vec3 to_sun) {
    const glm::vec3 up = std::abs(to_sun.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::mat4 sun_from_world = glm::lookAt(glm::vec3(0), -to_sun, up);
    Bounds seen;
    for (const DrawInstance& instance : resources.instances()) {
        const Bounds b = transformed(instance.bounds, sun_from_world);
        if (b.empty()) continue;
        seen.add(b.low);
        seen.add(b.high);
    }
    const glm::vec3 size = glm::max(seen.high - seen.low, glm::vec3(1e-3f)) * 1.01f;
    const glm::vec3 centre = seen.centre();
    const float reach = std::max(size.x, size.y);
    const std::uint32_t edge = reach > kSmallMapReach_m ? kLargeMap : kSmallMap;
    texel_m_ = reach / static_cast<float>(edge);

    // x and y to [-1, 1], the nearest point to the sun to depth 0, the farthest to 1.
    glm::mat4 clip_from_sun{1};
    clip_from_sun[0][0] = 2 / reach;
    clip_from_sun[1][1] = 2 / reach;
    clip_from_sun[2][2] = -1 / size.z;
    clip_from_sun[3] = glm::vec4(-2 * centre.x / reach, -2 * centre.y / reach, 0.5f + centre.z / size.z, 1);
    clip_from_world_ = clip_from_sun * sun_from_world;
    glm::mat4 map_from_clip{1};
    map_from_clip[0][0] = map_from_clip[1][1] = 0.5f;
    map_from_clip[3] = glm::vec4(0.5f, 0.5f, 0, 1);
    map_from_world_ = map_from_clip * clip_from_world_;
    map_ = GpuImage(gpu, {.format = kShadowFormat,
                          .width = edge,
                          .height = edge,
                          .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

void SunShadow::record(VkCommandBuffer commands, Gpu& gpu, SceneResources& resources) const {
    image_barrier(commands, map_, kUseNone, kUseDepthTarget);
    draw_casters(commands, gpu, resources, map_.view(), map_.extent(), clip_from_world_);
    image_barrier(commands, map_, kUseDepthTarget, kUseSampled);
}

LampShadows::LampShadows(Gpu& gpu, const std::vector<PunctualLight>& lights) {
    for (const PunctualLight& light : lights) {
        const bool casts = light.casts_shadow && light.kind == LightKind::spot &&
                           light.range_m > kLampNear_m && clip_from_world_.size() < shared::kMaxLampShadows;
        layers_.push_back(casts ? static_cast<int>(clip_from_world_.size()) : -1);
        if (!casts) continue;
        const glm::vec3 up = std::abs(light.direction.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
        const glm::mat4 lamp_from_world = glm::lookAt(light.position, light.position + light.direction, up);
        const float half_angle = std::min(light.outer_cone_rad, kWidestHalfAngle_rad);
        clip_from_world_.push_back(glm::perspectiveRH_ZO(2 * half_angle, 1.0f, kLampNear_m, light.range_m) *
                                   lamp_from_world);
    }
    if (clip_from_world_.empty()) return;
    maps_ = GpuImage(gpu, {.format = kShadowFormat,
                           .width = kLampMap,
                           .height = kLampMap,
                           .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                           .layers = static_cast<std::uint32_t>(clip_from_world_.size()),
                           .view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
    for (std::uint32_t layer = 0; layer < maps_.layers(); ++layer)
        views_.push_back(maps_.make_view(gpu, layer));
}

void LampShadows::record(VkCommandBuffer commands, Gpu& gpu, SceneResources& resources) const {
    image_barrier(commands, maps_, kUseNone, kUseDepthTarget);
    for (std::size_t layer = 0; layer < views_.size(); ++layer)
        draw_casters(commands, gpu, resources, views_[layer].get(), maps_.extent(), clip_from_world_[layer]);
    image_barrier(commands, maps_, kUseDepthTarget, kUseSampled);
}

}  // namespace parafovea
