// Fits an orthographic view along the sun's rays around the scene and draws depth from it.
#include "renderer/scene_shadow.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

namespace parafovea {
namespace {

// Texels of at most about a centimetre, on maps of at most this edge.
constexpr std::uint32_t kSmallMap = 2048;
constexpr std::uint32_t kLargeMap = 4096;
constexpr float kSmallMapReach_m = 24;

shared::vec4 packed(glm::vec3 v, float w) {
    return {v.x, v.y, v.z, w};
}

}  // namespace

void push_instance(VkCommandBuffer commands, const SceneResources& resources, const DrawInstance& instance,
                   const glm::mat4& clip_from_world) {
    shared::InstancePush push{};
    const glm::mat4 matrix = clip_from_world * instance.world_from_mesh;
    std::memcpy(push.clip_from_mesh.columns, &matrix, sizeof matrix);
    push.normal_x = packed(instance.world_from_normal[0], instance.mirrored ? -1.0f : 1.0f);
    push.normal_y = packed(instance.world_from_normal[1], 0);
    push.normal_z = packed(instance.world_from_normal[2], 0);
    vkCmdPushConstants(commands, resources.layout(), kPushConstantStages, 0, sizeof push, &push);
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
    const DepthTarget target{map_.view(), true, 1.0f, false};
    begin_rendering(commands, map_.extent(), {}, &target);
    resources.bind_geometry(commands);
    VkPipeline bound = VK_NULL_HANDLE;
    for (const DrawInstance& instance : resources.instances()) {
        const DrawMaterial& material = resources.material_of(instance);
        if (material.blend) continue;  // light passes through glass
        const VkPipeline pipeline = resources.depth_pipeline(gpu, material.mask, kShadowFormat);
        if (pipeline != bound) vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound = pipeline;
        if (material.mask) {
            const VkDescriptorSet set = material.set.get();
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, resources.layout(), 0, 1, &set,
                                    0, nullptr);
        }
        push_instance(commands, resources, instance, clip_from_world_);
        const DrawMesh& mesh = resources.meshes()[instance.mesh];
        vkCmdDrawIndexed(commands, mesh.index_count, 1, mesh.first_index, mesh.first_vertex, 0);
    }
    vkCmdEndRendering(commands);
    image_barrier(commands, map_, kUseDepthTarget, kUseSampled);
}

}  // namespace parafovea
