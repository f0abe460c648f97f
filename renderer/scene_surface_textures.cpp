// Lays textures into array layers: smaller ones are repeated texel by texel, so that their own levels stand
// at the right place of the common chain, and are never read below their own size.
#include "renderer/scene_surface_textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <map>

#include "renderer/shared/scene_layout.h"

namespace parafovea {
namespace {

constexpr VkDeviceSize kMostBytes = VkDeviceSize{256} << 20;
constexpr std::size_t kMostMaterials = 256;

std::array<const TextureSlot*, 5> slots_of(const Material& m) {
    return {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.occlusion_texture,
            &m.emissive_texture};
}

bool is_late(const Material& m) {
    return m.alpha_mode != AlphaMode::blend && m.transmission <= 0;
}

struct Size {
    int width = 0, height = 0;
};

Size largest_of(const Scene& scene) {
    Size largest;
    for (const Material& material : scene.materials) {
        if (!is_late(material)) continue;
        for (const TextureSlot* slot : slots_of(material)) {
            if (!*slot) continue;
            const SceneImage& image = scene.images[static_cast<std::size_t>(
                scene.textures[static_cast<std::size_t>(slot->texture)].image)];
            largest = {std::max(largest.width, image.width), std::max(largest.height, image.height)};
        }
    }
    return largest;
}

// How often the largest size is halved to give this one; -1 if it is not.
int halvings(Size largest, int width, int height) {
    for (int n = 0; n < 16; ++n) {
        if (width << n == largest.width && height << n == largest.height) return n;
    }
    return -1;
}

// Layers of one array in the making: each pair of image and encoding once.
class Layers {
  public:
    Layers(const Scene& scene, Size size) : scene_(scene), size_(size) {}

    // (layer, least level) of a slot's texture; the white layer 0 for none.
    std::pair<float, float> place(const TextureSlot& slot) {
        if (!slot) return {0.0f, 0.0f};
        const int image = scene_.textures[static_cast<std::size_t>(slot.texture)].image;
        const auto [found, is_new] = layer_of_image_.try_emplace(image, images_.size() + 1);
        if (is_new) images_.push_back(image);
        const SceneImage& pixels = scene_.images[static_cast<std::size_t>(image)];
        return {static_cast<float>(found->second),
                static_cast<float>(halvings(size_, pixels.width, pixels.height))};
    }

    GpuImage make(Gpu& gpu, VkFormat format) const {
        const auto width = static_cast<std::uint32_t>(size_.width),
                   height = static_cast<std::uint32_t>(size_.height);
        GpuImage array(gpu,
                       {.format = format,
                        .width = width,
                        .height = height,
                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        .mip_levels = static_cast<std::uint32_t>(std::bit_width(std::max(width, height))),
                        .layers = static_cast<std::uint32_t>(images_.size()) + 1,
                        .view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
        std::vector<std::uint32_t> texels(std::size_t{width} * height, 0xffffffffu);
        upload(gpu, array, std::as_bytes(std::span(texels)), 0, 1);
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const SceneImage& image = scene_.images[static_cast<std::size_t>(images_[i])];
            const auto shift = static_cast<unsigned>(halvings(size_, image.width, image.height));
            const auto stride = static_cast<std::size_t>(image.width);
            for (std::size_t y = 0; y < height; ++y) {
                for (std::size_t x = 0; x < width; ++x) {
                    const std::uint8_t* from = &image.rgba[4 * ((y >> shift) * stride + (x >> shift))];
                    texels[y * width + x] =
                        from[0] | from[1] << 8 | from[2] << 16 | static_cast<std::uint32_t>(from[3]) << 24;
                }
            }
            upload(gpu, array, std::as_bytes(std::span(texels)), static_cast<std::uint32_t>(i) + 1, 1);
        }
        return array;
    }

    std::size_t count() const { return images_.size() + 1; }

  private:
    const Scene& scene_;
    Size size_;
    std::vector<int> images_;
    std::map<int, std::size_t> layer_of_image_;
};

bool has_plain_texture(const Scene& scene, const TextureSlot& slot, bool srgb, Size largest) {
    const SceneTexture& texture = scene.textures[static_cast<std::size_t>(slot.texture)];
    const SceneImage& image = scene.images[static_cast<std::size_t>(texture.image)];
    return slot.offset == glm::vec2(0) && slot.scale == glm::vec2(1) && slot.rotation_rad == 0 &&
           texture.wrap_u == TextureWrap::repeat && texture.wrap_v == TextureWrap::repeat &&
           !texture.nearest && texture.srgb == srgb && halvings(largest, image.width, image.height) >= 0;
}

}  // namespace

bool can_read_textures_late(const Scene& scene) {
    const Size largest = largest_of(scene);
    if (largest.width == 0 || scene.materials.size() > kMostMaterials || features_of(scene).vertex_colors)
        return false;
    Layers color(scene, largest), data(scene, largest);
    for (const Material& material : scene.materials) {
        if (!is_late(material)) continue;
        const auto slots = slots_of(material);
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const bool srgb = i == shared::kBindBaseColor - 1 || i == shared::kBindEmissive - 1;
            if (!*slots[i]) continue;
            if (!has_plain_texture(scene, *slots[i], srgb, largest)) return false;
            (srgb ? color : data).place(*slots[i]);
        }
    }
    const VkDeviceSize layer_bytes = VkDeviceSize{4} * static_cast<VkDeviceSize>(largest.width) *
                                     static_cast<VkDeviceSize>(largest.height) * 4 / 3;
    return (color.count() + data.count()) * layer_bytes <= kMostBytes;
}

SurfaceTextures make_surface_textures(Gpu& gpu, const Scene& scene) {
    assert(can_read_textures_late(scene));
    const Size largest = largest_of(scene);
    const auto size_level =
        static_cast<float>(std::bit_width(static_cast<unsigned>(std::max(largest.width, largest.height)))) -
        1;
    Layers color(scene, largest), data(scene, largest);
    SurfaceTextures made;
    std::vector<shared::SurfaceMaterial> materials;
    for (const Material& m : scene.materials) {
        shared::SurfaceMaterial s{};
        s.base_color = {m.base_color.x, m.base_color.y, m.base_color.z, size_level};
        s.emissive = {m.emissive.x, m.emissive.y, m.emissive.z, m.normal_texture ? m.normal_scale : 0};
        s.factors = {m.metallic, m.roughness, m.occlusion_texture ? m.occlusion_strength : 0, 0};
        if (is_late(m)) {
            const auto [base, base_level] = color.place(m.base_color_texture);
            const auto [rough, rough_level] = data.place(m.metallic_roughness_texture);
            const auto [normal, normal_level] = data.place(m.normal_texture);
            const auto [occluded, occluded_level] = data.place(m.occlusion_texture);
            const auto [emissive, emissive_level] = color.place(m.emissive_texture);
            s.layers = {base, rough, normal, emissive};
            s.least_levels = {base_level, rough_level, normal_level, emissive_level};
            s.occlusion = {occluded, occluded_level, 0, 0};
            const auto slots = slots_of(m);
            for (std::size_t i = 0; i < slots.size(); ++i)
                if (*slots[i]) made.uses |= 1u << i;
        }
        materials.push_back(s);
    }
    made.color = color.make(gpu, VK_FORMAT_R8G8B8A8_SRGB);
    made.data = data.make(gpu, VK_FORMAT_R8G8B8A8_UNORM);
    made.materials = GpuBuffer(gpu, materials.size() * sizeof(shared::SurfaceMaterial),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload);
    made.materials.write(std::span<const shared::SurfaceMaterial>(materials));
    return made;
}

}  // namespace parafovea
