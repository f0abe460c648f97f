// Records the geometry passes of a scene and keeps descriptor set 0 filled.
#include "renderer/scene_passes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <numbers>
#include <optional>

#include "renderer/scene_irradiance.h"
#include "renderer/scene_lighting.h"
#include "renderer/scene_resources.h"
#include "renderer/scene_shadow.h"
#include "renderer/scene_surface_textures.h"
#include "renderer/scene_visible.h"

namespace parafovea {
namespace {

const ResourceUse kUseUniform{VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};

const ResourceUse kUseInstances{VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                                VK_IMAGE_LAYOUT_UNDEFINED};

// What one vkCmdUpdateBuffer() may write.
constexpr VkDeviceSize kMostUpdate = 65536;

constexpr const char* kKept = "drawing geometry again";
constexpr const char* kLevels = "levels of detail";

// The exposure that shows a grey surface near the eye as grey, as a camera left to itself would choose.
float exposure_at(const IrradianceVolume& volume, glm::vec3 eye, const std::vector<PunctualLight>& lamps) {
    constexpr float kReach_m = 3, kKey = 0.4f;
    const glm::vec3 luminance{0.2126f, 0.7152f, 0.0722f};
    const glm::vec3 cell = (volume.box.high - volume.box.low) / glm::vec3(volume.size);
    float sum = 0, weights = 0;
    for (int z = 0; z < volume.size.z; ++z) {
        for (int y = 0; y < volume.size.y; ++y) {
            for (int x = 0; x < volume.size.x; ++x) {
                const glm::vec3 offset = volume.box.low + (glm::vec3(x, y, z) + 0.5f) * cell - eye;
                const float weight = 1 / (1 + glm::dot(offset, offset) / (kReach_m * kReach_m));
                float light = glm::dot(luminance, glm::vec3(volume.at(0, x, y, z).x, volume.at(1, x, y, z).x,
                                                            volume.at(2, x, y, z).x));
                // The volume holds what surfaces pass on; the lamps' own light falls on about half of all
                // directions.
                for (const PunctualLight& lamp : lamps) {
                    const glm::vec3 away = eye + offset - lamp.position;
                    light += glm::dot(luminance, lamp.intensity) /
                             (2 * std::numbers::pi_v<float> * std::max(glm::dot(away, away), 0.25f));
                }
                // The logarithm keeps a window from counting for the whole room.
                sum += weight * std::log(std::max(light, 1e-4f));
                weights += weight;
            }
        }
    }
    return std::clamp(kKey / std::exp(sum / weights), 0.05f, 60.0f);
}

bool is_same(const shared::Camera& a, const shared::Camera& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

shared::vec4 packed(glm::vec3 v, float w) {
    return {v.x, v.y, v.z, w};
}

shared::InstanceRecord record_of(const DrawInstance& instance, const glm::mat4& clip_from_world) {
    shared::InstanceRecord record{};
    const glm::mat4 clip_from_mesh = clip_from_world * instance.world_from_mesh;
    std::memcpy(record.clip_from_mesh.columns, &clip_from_mesh, sizeof clip_from_mesh);
    record.normal_x = packed(instance.world_from_normal[0], instance.mirrored ? -1.0f : 1.0f);
    record.normal_y = packed(instance.world_from_normal[1], 0);
    record.normal_z = packed(instance.world_from_normal[2], 0);
    return record;
}

}  // namespace

struct ScenePasses::Parts {
    Gpu& gpu;
    ScenePassOptions options;
    bool ray_marched = false;
    SceneFeatures features;
    bool build_blended = false;
    bool build_sun = false;
    bool build_shadow = false;
    bool build_emission = false;
    bool build_irradiance = false;
    bool build_late = false;
    std::uint32_t light_count = 0;
    std::optional<SceneResources> resources;
    SurfaceTextures surface_textures;
    std::optional<SunShadow> shadow;
    std::optional<LampShadows> lamp_shadows;
    bool shadow_drawn = false;
    std::optional<shared::Camera> drawn;  // the view that the targets hold
    std::optional<shared::Camera> found;  // the view that in_view is of
    SizePx size;
    glm::mat4 clip_from_world{1};
    shared::Camera camera{};
    shared::Lighting lighting{};
    GpuBuffer camera_buffer;
    GpuBuffer lighting_buffer;
    GpuImage gbuffer, depth, blended, blended_depth;
    GpuImage unused_words, unused_depth, unused_layers;  // stand at the bindings of what was left out
    GpuImage irradiance, light_grid;
    OwnedSampler nearest, shadow_sampler, linear, trilinear;
    DescriptorSet set;
    VisiblePieces in_view;
    GpuBuffer instance_records;  // of each of in_view's pieces
    std::vector<FeatureNote> built;
    std::vector<FeatureNote> left_out;

    void note(bool is_built, const char* name, const std::string& why_built, const std::string& why_not) {
        if (is_built)
            built.push_back({name, why_built});
        else
            left_out.push_back({name, why_not});
    }
    void build_meshes(const Scene& scene);
    void build_irradiance_volume(const Scene& scene);
    void build_light_grid(const Scene& scene);
    void build_surface_textures(const Scene& scene);
    void describe(const Scene& scene);
    void make_targets();
    double most_detail_error_px() const {
        return options.force_everything ? 0 : options.most_detail_error_px;
    }
    void find_visible(const CameraView& view);
    void record_instances(VkCommandBuffer commands);
    void record_layer(VkCommandBuffer commands, bool blended_layer);
    void record_layers(VkCommandBuffer commands);
};

void ScenePasses::Parts::build_meshes(const Scene& scene) {
    const bool all = options.force_everything;
    build_sun = features.sun || all;
    build_shadow = features.sun_shadow || (all && features.sun);
    build_blended = features.alpha_blend || features.transmission || all;
    build_emission = features.emission || features.occlusion_maps || all;
    light_count = all ? shared::kMaxLights : static_cast<std::uint32_t>(scene.lights.size());
    build_late = options.late_textures.value_or(gpu.runs_on_the_cpu()) && can_read_textures_late(scene);
    resources.emplace(gpu, scene, !build_emission, build_late, most_detail_error_px() > 0);
    std::size_t most_pieces = 1;
    for (const DrawInstance& instance : resources->instances())
        most_pieces += resources->meshes()[instance.mesh].pieces.size();
    instance_records =
        GpuBuffer(gpu, most_pieces * sizeof(shared::InstanceRecord),
                  VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::device);
    if (build_shadow) {
        shadow.emplace(gpu, *resources, glm::normalize(scene.sun->direction));
        std::memcpy(lighting.shadow_from_world.columns, &shadow->map_from_world(), sizeof(glm::mat4));
        lighting.sun_irradiance.w = shadow->texel_m();
    }
    lamp_shadows.emplace(gpu, scene.lights);
    if (lamp_shadows->clip_from_world().empty()) lamp_shadows.reset();
    if (lamp_shadows) {
        for (std::size_t i = 0; i < scene.lights.size(); ++i)
            lighting.lights[i].cone.y = static_cast<float>(lamp_shadows->layers()[i]);
        std::memcpy(lighting.lamp_from_world, lamp_shadows->clip_from_world().data(),
                    lamp_shadows->clip_from_world().size() * sizeof(glm::mat4));
    }
    nearest = make_sampler(gpu, {.filter = VK_FILTER_NEAREST,
                                 .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE});
    shadow_sampler = make_sampler(gpu, {.address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .compare = true});
    linear = make_sampler(gpu, {.mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE});
    trilinear = make_sampler(gpu, {});
    build_irradiance_volume(scene);
    build_light_grid(scene);
    build_surface_textures(scene);
    // One texel each, in the state in which they are bound.
    unused_words = GpuImage(gpu, {.format = VK_FORMAT_R32G32B32A32_UINT,
                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
    unused_depth =
        GpuImage(gpu, {.format = VK_FORMAT_D16_UNORM,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
    unused_layers =
        GpuImage(gpu, {.format = VK_FORMAT_D16_UNORM,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                       .view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        image_barrier(commands, unused_layers, kUseNone, kUseSampled);
        image_barrier(commands, unused_words, kUseNone, kUseSampled);
        image_barrier(commands, unused_depth, kUseNone, kUseSampled);
    });

    const auto texture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    set = DescriptorSet(gpu, {{shared::kBindCamera},
                              {shared::kBindLighting},
                              {shared::kBindGBuffer, texture},
                              {shared::kBindDepth, texture},
                              {shared::kBindShadow, texture},
                              {shared::kBindBlended, texture},
                              {shared::kBindBlendedDepth, texture},
                              {shared::kBindIrradiance, texture},
                              {shared::kBindLightGrid, texture},
                              {shared::kBindLampShadow, texture},
                              {shared::kBindSurfaces, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                              {shared::kBindColors, texture},
                              {shared::kBindData, texture}});
    set.set_buffer(shared::kBindSurfaces, surface_textures.materials);
    set.set_sampled_image(shared::kBindColors, surface_textures.color.view(), trilinear.get());
    set.set_sampled_image(shared::kBindData, surface_textures.data.view(), trilinear.get());
    set.set_sampled_image(shared::kBindLampShadow,
                          lamp_shadows ? lamp_shadows->maps().view() : unused_layers.view(),
                          shadow_sampler.get());
    set.set_sampled_image(shared::kBindLightGrid, light_grid.view(), nearest.get());
    set.set_sampled_image(shared::kBindIrradiance, irradiance.view(), linear.get());
    set.set_sampled_image(shared::kBindShadow, shadow ? shadow->map().view() : unused_depth.view(),
                          shadow_sampler.get());
}

void ScenePasses::Parts::build_irradiance_volume(const Scene& scene) {
    // Inside a scene, light differs from place to place; an object seen from outside stands under the open
    // sky.
    const Bounds box = world_bounds(scene);
    const glm::vec3 eye{scene.cameras.front().world_from_camera[3]};
    const bool inside = glm::all(glm::lessThan(box.low, eye)) && glm::all(glm::lessThan(eye, box.high));
    build_irradiance = inside;
    IrradianceVolume volume;
    if (build_irradiance) {
        volume = bake_irradiance(scene);
        const glm::vec3 scale = 1.0f / (volume.box.high - volume.box.low);
        const glm::vec3 cell = 1.0f / (scale * glm::vec3(volume.size));
        lighting.volume_origin = {volume.box.low.x, volume.box.low.y, volume.box.low.z,
                                  0.35f * std::min(cell.x, std::min(cell.y, cell.z))};
        lighting.volume_scale = {scale.x, scale.y, scale.z, static_cast<float>(volume.size.z)};
    } else {
        volume.size = glm::ivec3(1);
        volume.texels.assign(3, glm::vec4(0));
    }
    if (!(scene.exposure > 0))
        lighting.sun_direction.w = build_irradiance ? exposure_at(volume, eye, scene.lights) : 1;
    std::vector<std::uint64_t> halves;
    halves.reserve(volume.texels.size());
    for (const glm::vec4& texel : volume.texels) halves.push_back(glm::packHalf4x16(texel));
    const auto layers = static_cast<std::uint32_t>(3 * volume.size.z);
    irradiance = GpuImage(gpu, {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .width = static_cast<std::uint32_t>(volume.size.x),
                                .height = static_cast<std::uint32_t>(volume.size.y),
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .layers = layers,
                                .view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
    upload(gpu, irradiance, std::as_bytes(std::span(halves)), 0, layers);
}

void ScenePasses::Parts::build_light_grid(const Scene& scene) {
    const LightGrid grid = make_light_grid(scene);
    lighting.light_grid = {grid.low.x, grid.low.y, 1 / grid.cell_m.x, 1 / grid.cell_m.y};
    light_grid = GpuImage(gpu, {.format = VK_FORMAT_R32G32_UINT,
                                .width = static_cast<std::uint32_t>(grid.size.x),
                                .height = static_cast<std::uint32_t>(grid.size.y),
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    upload(gpu, light_grid, std::as_bytes(std::span(grid.lights)));
}

void ScenePasses::Parts::build_surface_textures(const Scene& scene) {
    if (build_late) {
        surface_textures = make_surface_textures(gpu, scene);
        if (options.force_everything) surface_textures.uses = (1u << shared::kMaterialTextures) - 1;
        return;
    }
    surface_textures.materials = GpuBuffer(gpu, sizeof(shared::SurfaceMaterial),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload);
    const std::uint32_t white = 0xffffffff;
    for (GpuImage* image : {&surface_textures.color, &surface_textures.data}) {
        *image = GpuImage(gpu, {.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
        upload(gpu, *image, std::as_bytes(std::span(&white, 1)));
    }
}

void ScenePasses::Parts::describe(const Scene& scene) {
    const std::string forced = "forced on";
    if (ray_marched) {
        left_out = {{"depth", "the scene is ray-marched"},
                    {"shadow", "shadows are traced"},
                    {"defer", "the scene is ray-marched"}};
    } else {
        note(build_shadow, "shadow map", features.sun_shadow ? "the sun casts shadows; drawn once" : forced,
             features.sun ? "the sun casts no shadow" : "no sun");
        note(false, "depth", "", "instances are drawn front to back and depth comes with the G-buffer");
        note(true, "G-buffer", build_emission || build_late ? "4 words a pixel" : "2 words a pixel", "");
        note(build_late, "textures read for each sample",
             "all of them fit into two arrays; the G-buffer says where to read them",
             "the G-buffer reads them for each pixel");
        note(build_emission, "emission and occlusion",
             features.emission || features.occlusion_maps ? "materials emit or carry occlusion maps" : forced,
             "no material emits or carries an occlusion map");
        note(build_blended, "blended layer",
             features.alpha_blend || features.transmission ? "materials blend or transmit" : forced,
             "every surface is opaque");
        note(features.normal_maps, "normal maps", "materials carry them", "no material carries one");
        note(features.alpha_mask, "alpha masks", "materials carry them", "no material carries one");
        note(features.vertex_colors, "vertex colours", "meshes carry them", "all are white");
        note(build_irradiance, "irradiance volume", "the camera is inside the scene",
             "the camera looks at the scene from outside: the open sky lights it");
        note(lamp_shadows.has_value(), "lamp shadow maps",
             lamp_shadows ? std::to_string(lamp_shadows->clip_from_world().size()) +
                                " spot lamps cast shadows; drawn once"
                          : "",
             "no lamp casts a shadow");
        note(build_sun, "sun", features.sun ? "the scene has one" : forced, "the scene has none");
        note(light_count > 0, "lamps",
             std::to_string(light_count) + ", of which a grid lists those that reach", "the scene has none");
    }
    note(false, "sky box", "",
         scene.ray_marched ? "rays that miss shade the sky" : "pixels without a surface shade the sky");
}

void ScenePasses::Parts::make_targets() {
    const auto width = static_cast<std::uint32_t>(size.width),
               height = static_cast<std::uint32_t>(size.height);
    const auto color = [&](VkFormat format) {
        return GpuImage(gpu, {.format = format,
                              .width = width,
                              .height = height,
                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    };
    const auto depth_target = [&] {
        return GpuImage(gpu,
                        {.format = kDepthFormat,
                         .width = width,
                         .height = height,
                         .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    };
    // Release the old ones first: both sizes together may not fit.
    for (GpuImage* image : {&gbuffer, &depth, &blended, &blended_depth}) *image = GpuImage();
    drawn.reset();
    gbuffer = color(resources->gbuffer_format());
    depth = depth_target();
    if (build_blended) {
        blended = color(kBlendedFormat);
        blended_depth = depth_target();
    }
    set.set_sampled_image(shared::kBindGBuffer, gbuffer.view(), nearest.get());
    set.set_sampled_image(shared::kBindDepth, depth.view(), nearest.get());
    set.set_sampled_image(shared::kBindBlended, build_blended ? blended.view() : unused_words.view(),
                          nearest.get());
    set.set_sampled_image(shared::kBindBlendedDepth,
                          build_blended ? blended_depth.view() : unused_depth.view(), nearest.get());
}

void ScenePasses::Parts::find_visible(const CameraView& view) {
    in_view = visible_pieces(*resources, view, size, most_detail_error_px());
    std::erase_if(built, [](const FeatureNote& n) { return n.name == kLevels; });
    std::erase_if(left_out, [](const FeatureNote& n) { return n.name == kLevels; });
    note(most_detail_error_px() > 0, kLevels,
         std::to_string(in_view.triangles) + " of " + std::to_string(in_view.full_triangles) +
             " triangles are drawn; no vertex appears farther than " +
             std::to_string(most_detail_error_px()).substr(0, 4) + " pixels from its place",
         "full detail was asked for");
}

void ScenePasses::Parts::record_instances(VkCommandBuffer commands) {
    std::vector<shared::InstanceRecord> records;
    records.reserve(in_view.pieces.size());
    for (const VisiblePiece& piece : in_view.pieces)
        records.push_back(record_of(resources->instances()[piece.instance], clip_from_world));
    const std::span<const std::byte> bytes = std::as_bytes(std::span(records));
    // An earlier view in this command buffer may still be reading them.
    memory_barrier(commands, kUseInstances, kUseTransferTarget);
    for (std::size_t at = 0; at < bytes.size(); at += kMostUpdate) {
        const auto part = bytes.subspan(at, std::min<std::size_t>(kMostUpdate, bytes.size() - at));
        vkCmdUpdateBuffer(commands, instance_records.get(), at, part.size(), part.data());
    }
    memory_barrier(commands, kUseTransferTarget, kUseInstances);
}

void ScenePasses::Parts::record_layer(VkCommandBuffer commands, bool blended_layer) {
    const GpuImage& words = blended_layer ? blended : gbuffer;
    const DepthTarget depth_target{(blended_layer ? blended_depth : depth).view(), true, 0.0f, false};
    // Words are read only where depth tells of them.
    const ColorTarget words_target{.view = words.view(), .discard = true};
    begin_rendering(commands, words.extent(), {words_target}, &depth_target);
    resources->bind_geometry(commands);
    const VkBuffer records = instance_records.get();
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands, kInstanceBinding, 1, &records, &start);
    VkPipeline bound_pipeline = VK_NULL_HANDLE;
    int bound_material = -1;
    for (const PieceDraw& draw : in_view.draws) {
        const VisiblePiece& piece = in_view.pieces[draw.first];
        const DrawInstance& instance = resources->instances()[piece.instance];
        const DrawMesh& mesh = resources->meshes()[instance.mesh];
        const DrawMaterial& material = resources->material_of(instance);
        if (material.blend != blended_layer) continue;
        const PipelineKey key = material.flags | (instance.mirrored ? kKeyMirrored : 0);
        const VkPipeline pipeline = resources->gbuffer_pipeline(gpu, key);
        if (pipeline != bound_pipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        bound_pipeline = pipeline;
        if (mesh.material != bound_material) {
            const VkDescriptorSet material_set = material.set.get();
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, resources->layout(), 0, 1,
                                    &material_set, 0, nullptr);
            bound_material = mesh.material;
        }
        vkCmdDrawIndexed(commands, piece.index_count, draw.count, piece.first_index, mesh.first_vertex,
                         draw.first);
    }
    vkCmdEndRendering(commands);
}

// The blended layer, which is the smaller, comes first and nothing waits between the two: software devices
// fill its tiles while the other's triangles are set up.
void ScenePasses::Parts::record_layers(VkCommandBuffer commands) {
    std::vector<const GpuImage*> words{&gbuffer}, distances{&depth};
    if (build_blended) {
        words.push_back(&blended);
        distances.push_back(&blended_depth);
    }
    for (const GpuImage* image : words) image_barrier(commands, *image, kUseNone, kUseColorTarget);
    for (const GpuImage* image : distances) image_barrier(commands, *image, kUseNone, kUseDepthTarget);
    record_instances(commands);
    if (build_blended) record_layer(commands, true);
    record_layer(commands, false);
    for (const GpuImage* image : words) image_barrier(commands, *image, kUseColorTarget, kUseSampled);
    for (const GpuImage* image : distances) image_barrier(commands, *image, kUseDepthTarget, kUseSampled);
}

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
    if (scene.ray_marched)
        p.set = DescriptorSet(gpu, {{shared::kBindCamera}, {shared::kBindLighting}});
    else
        p.build_meshes(scene);
    p.lighting_buffer.write(p.lighting);
    p.set.set_buffer(shared::kBindCamera, p.camera_buffer);
    p.set.set_buffer(shared::kBindLighting, p.lighting_buffer);
    p.describe(scene);
}

ScenePasses::~ScenePasses() = default;

bool ScenePasses::ray_marched() const {
    return parts_->ray_marched;
}

void ScenePasses::set_view(SizePx size, const CameraView& view) {
    assert(size.width > 0 && size.height > 0);
    Parts& p = *parts_;
    p.camera = camera_block(view, size);
    p.clip_from_world = clip_from_world(view, size);
    const bool resized = size != p.size;
    p.size = size;
    if (p.ray_marched) return;
    if (resized) p.make_targets();
    if (p.found && is_same(*p.found, p.camera)) return;
    p.find_visible(view);
    p.found = p.camera;
}

void ScenePasses::record(VkCommandBuffer commands, PassTimer* timer) {
    Parts& p = *parts_;
    assert(p.size.width > 0);
    // An earlier view in this command buffer may still be reading the block and the targets.
    memory_barrier(commands, kUseUniform, kUseTransferTarget);
    vkCmdUpdateBuffer(commands, p.camera_buffer.get(), 0, sizeof(shared::Camera), &p.camera);
    memory_barrier(commands, kUseTransferTarget, kUseUniform);
    if (p.ray_marched) return;
    memory_barrier(commands, kUseSampled, kUseDepthTarget);
    memory_barrier(commands, kUseSampled, kUseColorTarget);
    if ((p.shadow || p.lamp_shadows) && !p.shadow_drawn) {
        if (timer) timer->start(commands, "shadow");
        if (p.shadow) p.shadow->record(commands, p.gpu, *p.resources);
        if (p.lamp_shadows) p.lamp_shadows->record(commands, p.gpu, *p.resources);
        if (timer) timer->stop(commands);
        p.shadow_drawn = true;
    }
    std::erase_if(p.left_out, [](const FeatureNote& note) { return note.name == kKept; });
    if (p.options.keep_geometry && p.drawn && is_same(*p.drawn, p.camera)) {
        p.left_out.push_back({kKept, "the view is that of the last frame"});
        return;
    }
    if (timer) timer->start(commands, "defer");
    p.record_layers(commands);
    if (timer) timer->stop(commands);
    p.drawn = p.camera;
}

VkDescriptorSetLayout ScenePasses::shading_set_layout() const {
    return parts_->set.layout();
}
VkDescriptorSet ScenePasses::shading_set() const {
    return parts_->set.get();
}

std::vector<ShaderConstant> ScenePasses::shading_constants() const {
    const Parts& p = *parts_;
    std::vector<ShaderConstant> constants{{shared::kConstFootprint, p.options.filter_over_spacing ? 1u : 0u}};
    if (p.ray_marched) {
        constants.push_back({shared::kConstSamples, p.options.samples_per_sample});
    } else {
        constants.push_back({shared::kConstSun, p.build_sun ? 1u : 0u});
        constants.push_back({shared::kConstSunShadow, p.build_shadow ? 1u : 0u});
        constants.push_back({shared::kConstBlend, p.build_blended ? 1u : 0u});
        constants.push_back({shared::kConstEmission, p.build_emission ? 1u : 0u});
        constants.push_back({shared::kConstLights, p.light_count});
        constants.push_back({shared::kConstLampShadow, p.lamp_shadows ? 1u : 0u});
        constants.push_back({shared::kConstIrradiance, p.build_irradiance ? 1u : 0u});
        constants.push_back({shared::kConstLate, p.build_late ? 1u : 0u});
        constants.push_back({shared::kConstLateUses, p.surface_textures.uses});
    }
    return constants;
}

const shared::Camera& ScenePasses::camera() const {
    return parts_->camera;
}
const GpuImage* ScenePasses::depth() const {
    return parts_->ray_marched ? nullptr : &parts_->depth;
}
const std::vector<FeatureNote>& ScenePasses::built() const {
    return parts_->built;
}
const std::vector<FeatureNote>& ScenePasses::left_out() const {
    return parts_->left_out;
}
std::uint64_t ScenePasses::triangles_in_view() const {
    return parts_->in_view.triangles;
}
std::uint64_t ScenePasses::full_triangles_in_view() const {
    return parts_->in_view.full_triangles;
}

}  // namespace parafovea
