// A scene on the graphics card: merged geometry, textures, one descriptor set for each material, and the
// pipelines that draw them. Only what the scene uses is made.
#pragma once

#include <map>
#include <vector>

#include "renderer/gpu_pipeline.h"
#include "renderer/scene.h"
#include "renderer/scene_detail.h"
#include "renderer/shared/scene_layout.h"

namespace parafovea {

// How a material is drawn: bits 0 to 8 are the kConst* flags of scene_layout.h, then these.
using PipelineKey = std::uint32_t;
inline constexpr PipelineKey kKeyCullBack = 1u << 16;
inline constexpr PipelineKey kKeyMirrored = 1u << 17;  // the instance's transform turns triangles over

inline constexpr std::uint32_t kInstanceBinding = 3;

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kShadowFormat = VK_FORMAT_D16_UNORM;
inline constexpr VkFormat kBlendedFormat = VK_FORMAT_R32G32B32A32_UINT;

struct DrawMesh {
    std::uint32_t first_index = 0;  // of the whole mesh in full detail
    std::uint32_t index_count = 0;
    std::int32_t first_vertex = 0;
    int material = 0;
    Bounds bounds;  // of the mesh, in its own space
    std::vector<MeshPiece> pieces;
};

struct DrawInstance {
    int mesh = 0;
    glm::mat4 world_from_mesh{1};
    glm::mat3 world_from_normal{1};
    bool mirrored = false;
    float stretch = 1;  // the most that the transform stretches a length
    Bounds bounds;      // in the world
    std::vector<Bounds> piece_bounds;
};

struct DrawMaterial {
    PipelineKey flags = 0;
    bool mask = false;
    bool blend = false;
    GpuBuffer block;
    DescriptorSet set;
};

class SceneResources {
  public:
    // `lean_gbuffer`: two words for each pixel instead of four. `late_textures`: the G-buffer says where
    // shading is to read them (see scene_surface_textures.h); it then has four words. `simplified`: meshes
    // have levels of detail.
    SceneResources(Gpu& gpu, const Scene& scene, bool lean_gbuffer, bool late_textures, bool simplified);

    const std::vector<DrawMesh>& meshes() const { return meshes_; }
    const std::vector<DrawInstance>& instances() const { return instances_; }
    const DrawMaterial& material_of(const DrawInstance& instance) const {
        return materials_[meshes_[instance.mesh].material];
    }
    VkFormat gbuffer_format() const { return gbuffer_format_; }

    // Made on first use and kept.
    VkPipeline gbuffer_pipeline(Gpu& gpu, PipelineKey key);
    VkPipeline shadow_pipeline(Gpu& gpu, bool masked);
    VkPipelineLayout layout() const { return layout_.get(); }

    // Vertices and indices; a G-buffer pipeline also reads shared::InstanceRecord[] at kInstanceBinding.
    void bind_geometry(VkCommandBuffer commands) const;

  private:
    void upload_geometry(Gpu& gpu, const Scene& scene, bool simplified);
    void upload_textures(Gpu& gpu, const Scene& scene);
    void make_materials(Gpu& gpu, const Scene& scene);

    std::vector<DrawMesh> meshes_;
    std::vector<DrawInstance> instances_;
    std::vector<DrawMaterial> materials_;
    std::vector<GpuImage> images_;
    std::vector<OwnedSampler> samplers_;
    std::vector<std::size_t> image_of_texture_;
    std::vector<std::size_t> sampler_of_texture_;
    GpuImage white_;
    OwnedSampler plain_sampler_;
    GpuBuffer positions_;
    GpuBuffer attributes_;
    GpuBuffer colors_;
    GpuBuffer indices_;
    VkFormat gbuffer_format_ = VK_FORMAT_UNDEFINED;
    bool vertex_colors_ = false;
    bool late_textures_ = false;
    OwnedPipelineLayout layout_;
    std::map<PipelineKey, OwnedPipeline> gbuffer_pipelines_;
    std::map<bool, OwnedPipeline> shadow_pipelines_;
};

}  // namespace parafovea
