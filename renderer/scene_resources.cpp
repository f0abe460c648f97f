// Uploads a scene and builds its pipelines.
#include "renderer/scene_resources.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <tuple>

#include "shader_code/depth_masked_frag.h"
#include "shader_code/depth_masked_vert.h"
#include "shader_code/depth_vert.h"
#include "shader_code/gbuffer_frag.h"
#include "shader_code/gbuffer_frag_colors.h"
#include "shader_code/gbuffer_frag_tangents.h"
#include "shader_code/gbuffer_frag_tangents_colors.h"
#include "shader_code/gbuffer_late_frag.h"
#include "shader_code/gbuffer_late_frag_tangents.h"
#include "shader_code/gbuffer_vert.h"
#include "shader_code/gbuffer_vert_colors.h"
#include "shader_code/gbuffer_vert_tangents.h"
#include "shader_code/gbuffer_vert_tangents_colors.h"

namespace parafovea {
namespace {

// What the G-buffer's vertex shader reads beside the position. Nothing that it would have to decode.
struct PackedAttributes {
    std::int16_t normal[4];
    std::int16_t tangent[4];  // the last: handedness
    float uv[2];
};
static_assert(sizeof(PackedAttributes) == 24);

std::int16_t snorm16(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767));
}

PackedAttributes packed(const SceneVertex& v) {
    PackedAttributes a{};
    for (int i = 0; i < 3; ++i) {
        a.normal[i] = snorm16(v.normal[i]);
        a.tangent[i] = snorm16(v.tangent[i]);
    }
    a.tangent[3] = v.tangent.w < 0 ? -32767 : 32767;
    a.uv[0] = v.uv.x;
    a.uv[1] = v.uv.y;
    return a;
}

VkSamplerAddressMode address_mode(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::mirror:
            return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case TextureWrap::clamp:
            return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        case TextureWrap::repeat:
            break;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

std::uint32_t level_count(int width, int height) {
    std::uint32_t levels = 1;
    for (int size = std::max(width, height); size > 1; size /= 2) ++levels;
    return levels;
}

void set_transform(shared::MaterialBlock& block, int index, const TextureSlot& slot) {
    // KHR_texture_transform: scaled, then turned counter-clockwise as seen with v down, then moved.
    const float c = std::cos(slot.rotation_rad), s = std::sin(slot.rotation_rad);
    block.transforms[2 * index] = {c * slot.scale.x, s * slot.scale.y, slot.offset.x, 0};
    block.transforms[2 * index + 1] = {-s * slot.scale.x, c * slot.scale.y, slot.offset.y, 0};
}

// At least the largest singular value: the root of the largest row sum of the matrix's square.
float most_stretch(const glm::mat3& m) {
    const glm::mat3 square = glm::transpose(m) * m;
    float most = 0;
    for (int i = 0; i < 3; ++i)
        most = std::max(most, std::abs(square[i].x) + std::abs(square[i].y) + std::abs(square[i].z));
    return std::sqrt(most);
}

bool is_moved(const TextureSlot& slot) {
    return slot && (slot.offset != glm::vec2(0) || slot.scale != glm::vec2(1) || slot.rotation_rad != 0);
}

}  // namespace

SceneResources::SceneResources(Gpu& gpu, const Scene& scene, bool lean_gbuffer, bool late_textures,
                               bool simplified)
    : gbuffer_format_(lean_gbuffer && !late_textures ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT),
      vertex_colors_(features_of(scene).vertex_colors),
      late_textures_(late_textures) {
    upload_geometry(gpu, scene, simplified);
    upload_textures(gpu, scene);
    make_materials(gpu, scene);
}

void SceneResources::upload_geometry(Gpu& gpu, const Scene& scene, bool simplified) {
    std::vector<glm::vec3> positions;
    std::vector<PackedAttributes> attributes;
    positions.reserve(scene.vertices.size());
    attributes.reserve(scene.vertices.size());
    for (const SceneVertex& v : scene.vertices) {
        positions.push_back(v.position);
        attributes.push_back(packed(v));
    }
    const auto make = [&](auto values, VkBufferUsageFlags usage) {
        GpuBuffer buffer(gpu, values.size_bytes(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                         BufferPlace::device);
        upload(gpu, buffer, values);
        return buffer;
    };
    positions_ = make(std::span<const glm::vec3>(positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    attributes_ = make(std::span<const PackedAttributes>(attributes), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    if (vertex_colors_) {
        std::vector<glm::u8vec4> colors;
        for (const SceneVertex& v : scene.vertices) colors.push_back(v.color);
        colors_ = make(std::span<const glm::u8vec4>(colors), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    }
    SceneDetail detail = make_detail(scene, simplified);
    indices_ = make(std::span<const std::uint32_t>(detail.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const SceneMesh& mesh = scene.meshes[i];
        meshes_.push_back({detail.first_index[i], mesh.index_count / 3 * 3,
                           static_cast<std::int32_t>(mesh.first_vertex), mesh.material, mesh.bounds,
                           std::move(detail.pieces[i])});
    }
    for (const SceneInstance& instance : scene.instances) {
        DrawInstance draw;
        draw.mesh = instance.mesh;
        draw.world_from_mesh = instance.world_from_mesh;
        const glm::mat3 linear{instance.world_from_mesh};
        const float determinant = glm::determinant(linear);
        draw.mirrored = determinant < 0;
        draw.world_from_normal =
            std::abs(determinant) > 1e-30f ? glm::transpose(glm::inverse(linear)) : glm::mat3(1);
        draw.stretch = most_stretch(linear);
        draw.bounds = transformed(scene.meshes[instance.mesh].bounds, instance.world_from_mesh);
        for (const MeshPiece& piece : meshes_[instance.mesh].pieces)
            draw.piece_bounds.push_back(transformed(piece.bounds, instance.world_from_mesh));
        instances_.push_back(draw);
    }
}

void SceneResources::upload_textures(Gpu& gpu, const Scene& scene) {
    // One image for each pairing of pixels and encoding, one sampler for each way of reading.
    std::vector<std::pair<int, bool>> known_images;
    std::vector<std::tuple<TextureWrap, TextureWrap, bool>> known_samplers;
    for (const SceneTexture& texture : scene.textures) {
        const std::pair<int, bool> image_key{texture.image, texture.srgb};
        const auto image_at = std::find(known_images.begin(), known_images.end(), image_key);
        image_of_texture_.push_back(static_cast<std::size_t>(image_at - known_images.begin()));
        if (image_at == known_images.end()) {
            known_images.push_back(image_key);
            const SceneImage& pixels = scene.images[texture.image];
            GpuImage image(gpu, {.format = texture.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                                 .width = static_cast<std::uint32_t>(pixels.width),
                                 .height = static_cast<std::uint32_t>(pixels.height),
                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                 .mip_levels = level_count(pixels.width, pixels.height)});
            upload(gpu, image, std::as_bytes(std::span(pixels.rgba)));
            images_.push_back(std::move(image));
        }
        const std::tuple sampler_key{texture.wrap_u, texture.wrap_v, texture.nearest};
        const auto sampler_at = std::find(known_samplers.begin(), known_samplers.end(), sampler_key);
        sampler_of_texture_.push_back(static_cast<std::size_t>(sampler_at - known_samplers.begin()));
        if (sampler_at == known_samplers.end()) {
            known_samplers.push_back(sampler_key);
            samplers_.push_back(
                make_sampler(gpu, {.filter = texture.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                                   .address_u = address_mode(texture.wrap_u),
                                   .address_v = address_mode(texture.wrap_v),
                                   // Anisotropic lookups cost a software device more than they show.
                                   .max_anisotropy = gpu.runs_on_the_cpu() ? 1.0f : 8.0f}));
        }
    }
    white_ = GpuImage(gpu, {.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    const std::uint32_t white = 0xffffffff;
    upload(gpu, white_, std::as_bytes(std::span(&white, 1)));
    plain_sampler_ = make_sampler(gpu, {});
}

void SceneResources::make_materials(Gpu& gpu, const Scene& scene) {
    for (const Material& m : scene.materials) {
        DrawMaterial draw;
        const TextureSlot* slots[] = {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                      &m.occlusion_texture, &m.emissive_texture};
        shared::MaterialBlock block{};
        block.base_color = {m.base_color.x, m.base_color.y, m.base_color.z, m.base_color.w};
        block.emissive = {m.emissive.x, m.emissive.y, m.emissive.z, m.normal_scale};
        block.factors = {m.metallic, m.roughness, m.occlusion_strength, m.alpha_cutoff};
        block.glass = {m.transmission, m.ior, static_cast<float>(materials_.size()), 0};
        for (int i = 0; i < 5; ++i) {
            set_transform(block, i, *slots[i]);
            if (*slots[i]) draw.flags |= 1u << i;
            if (is_moved(*slots[i])) draw.flags |= 1u << shared::kConstTextureTransforms;
        }
        draw.mask = m.alpha_mode == AlphaMode::mask;
        draw.blend = m.alpha_mode == AlphaMode::blend || m.transmission > 0;
        if (draw.mask) draw.flags |= 1u << shared::kConstMask;
        if (vertex_colors_) draw.flags |= 1u << shared::kConstVertexColors;
        if (draw.blend) draw.flags |= 1u << shared::kConstBlendedLayer;
        if (!m.double_sided && !draw.blend) draw.flags |= kKeyCullBack;
        draw.block = GpuBuffer(gpu, sizeof block, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload);
        draw.block.write(block);
        std::vector<Binding> bindings{{shared::kBindMaterial}};
        for (std::uint32_t i = 1; i <= shared::kMaterialTextures; ++i)
            bindings.push_back({i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
        draw.set = DescriptorSet(gpu, bindings);
        draw.set.set_buffer(shared::kBindMaterial, draw.block);
        for (std::uint32_t i = 0; i < shared::kMaterialTextures; ++i) {
            if (*slots[i]) {
                const auto texture = static_cast<std::size_t>(slots[i]->texture);
                draw.set.set_sampled_image(i + 1, images_[image_of_texture_[texture]].view(),
                                           samplers_[sampler_of_texture_[texture]].get());
            } else {
                draw.set.set_sampled_image(i + 1, white_.view(), plain_sampler_.get());
            }
        }
        materials_.push_back(std::move(draw));
    }
    layout_ = make_pipeline_layout(gpu, {materials_.front().set.layout()}, sizeof(glm::mat4));
}

VkPipeline SceneResources::gbuffer_pipeline(Gpu& gpu, PipelineKey key) {
    OwnedPipeline& pipeline = gbuffer_pipelines_[key];
    if (pipeline) return pipeline.get();
    GraphicsPipelineDescription d;
    const bool blended = key & (1u << shared::kConstBlendedLayer);
    const bool tangents = key & (1u << shared::kConstNormalTexture);
    const bool colors = key & (1u << shared::kConstVertexColors);
    const bool late = late_textures_ && !blended;
    assert(!(late && colors));
    // Only what the material needs is fetched and handed on.
    d.vertex = tangents ? std::span<const std::uint32_t>(shader_code::gbuffer_vert_tangents)
                        : std::span<const std::uint32_t>(shader_code::gbuffer_vert);
    d.fragment = tangents ? std::span<const std::uint32_t>(shader_code::gbuffer_frag_tangents)
                          : std::span<const std::uint32_t>(shader_code::gbuffer_frag);
    if (colors && tangents) d.vertex = shader_code::gbuffer_vert_tangents_colors;
    if (colors && tangents) d.fragment = shader_code::gbuffer_frag_tangents_colors;
    if (colors && !tangents) d.vertex = shader_code::gbuffer_vert_colors;
    if (colors && !tangents) d.fragment = shader_code::gbuffer_frag_colors;
    if (late && tangents) d.fragment = shader_code::gbuffer_late_frag_tangents;
    if (late && !tangents) d.fragment = shader_code::gbuffer_late_frag;
    d.layout = layout_.get();
    d.vertex_bindings = {{0, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX},
                         {1, sizeof(PackedAttributes), VK_VERTEX_INPUT_RATE_VERTEX},
                         {kInstanceBinding, sizeof(shared::InstanceRecord), VK_VERTEX_INPUT_RATE_INSTANCE}};
    d.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                           {1, 1, VK_FORMAT_R16G16B16A16_SNORM, offsetof(PackedAttributes, normal)},
                           {2, 1, VK_FORMAT_R32G32_SFLOAT, offsetof(PackedAttributes, uv)}};
    for (std::uint32_t i = 0; i < sizeof(shared::InstanceRecord) / sizeof(shared::vec4); ++i) {
        d.vertex_attributes.push_back({shared::kInstanceLocation + i, kInstanceBinding,
                                       VK_FORMAT_R32G32B32A32_SFLOAT,
                                       static_cast<std::uint32_t>(i * sizeof(shared::vec4))});
    }
    if (tangents) {
        d.vertex_attributes.push_back(
            {3, 1, VK_FORMAT_R16G16B16A16_SNORM, offsetof(PackedAttributes, tangent)});
    }
    if (colors) {
        d.vertex_bindings.push_back({2, sizeof(glm::u8vec4), VK_VERTEX_INPUT_RATE_VERTEX});
        d.vertex_attributes.push_back({4, 2, VK_FORMAT_R8G8B8A8_UNORM, 0});
    }
    d.color_formats = {blended ? kBlendedFormat : gbuffer_format_};
    d.depth_format = kDepthFormat;
    d.cull = key & kKeyCullBack ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    d.front_face = key & kKeyMirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
    d.depth_test = true;
    d.depth_write = true;
    d.depth_compare = VK_COMPARE_OP_GREATER;
    for (std::uint32_t i = 0; i < shared::kGeometryConstants; ++i)
        d.constants.push_back({i, (key >> i) & 1u});
    pipeline = make_graphics_pipeline(gpu, d);
    return pipeline.get();
}

VkPipeline SceneResources::shadow_pipeline(Gpu& gpu, bool masked) {
    OwnedPipeline& pipeline = shadow_pipelines_[masked];
    if (pipeline) return pipeline.get();
    GraphicsPipelineDescription d;
    d.layout = layout_.get();
    d.vertex_bindings = {{0, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX}};
    d.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
    d.vertex = shader_code::depth_vert;
    if (masked) {
        d.vertex = shader_code::depth_masked_vert;
        d.fragment = shader_code::depth_masked_frag;
        d.vertex_bindings.push_back({1, sizeof(PackedAttributes), VK_VERTEX_INPUT_RATE_VERTEX});
        d.vertex_attributes.push_back({2, 1, VK_FORMAT_R32G32_SFLOAT, offsetof(PackedAttributes, uv)});
    }
    d.depth_format = kShadowFormat;
    d.depth_test = true;
    d.depth_write = true;
    // The shadow map runs from 0 at the sun; the picture's depth is reversed.
    d.depth_compare = VK_COMPARE_OP_LESS;
    d.depth_bias_slope = 1.5f;
    d.depth_bias_constant = 2;
    pipeline = make_graphics_pipeline(gpu, d);
    return pipeline.get();
}

void SceneResources::bind_geometry(VkCommandBuffer commands) const {
    const VkBuffer buffers[] = {positions_.get(), attributes_.get(), colors_.get()};
    const VkDeviceSize offsets[] = {0, 0, 0};
    vkCmdBindVertexBuffers(commands, 0, vertex_colors_ ? 3 : 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, indices_.get(), 0, VK_INDEX_TYPE_UINT32);
}

}  // namespace parafovea
