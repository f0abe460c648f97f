// Translates glTF materials and decodes the images they use.
#include "renderer/gltf_material.h"

#include <stb/stb_image.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "renderer/all_processors.h"

namespace parafovea {
namespace {

// One edge of the largest image that is accepted.
constexpr int kMostPixels = 16384;

float number(const tinygltf::Value& object, const char* key, float otherwise) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return otherwise;
    return static_cast<float>(object.Get(key).GetNumberAsDouble());
}

glm::vec2 pair(const tinygltf::Value& object, const char* key, glm::vec2 otherwise) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber())
        return otherwise;
    return {static_cast<float>(value.Get(0).GetNumberAsDouble()),
            static_cast<float>(value.Get(1).GetNumberAsDouble())};
}

TextureWrap wrap_of(int gl) {
    if (gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::clamp;
    if (gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return TextureWrap::mirror;
    return TextureWrap::repeat;
}

SceneImage decode(const EncodedImage& encoded) {
    SceneImage image;
    image.name = encoded.name;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(encoded.bytes.data(), static_cast<int>(encoded.bytes.size()), &image.width,
                              &image.height, &channels, 4),
        stbi_image_free);
    if (!pixels) {
        const char* why = stbi_failure_reason();
        throw std::runtime_error("image '" + encoded.name + "' cannot be decoded (" +
                                 (why ? why : "unknown") + "); PNG or JPEG expected");
    }
    if (image.width > kMostPixels || image.height > kMostPixels)
        throw std::runtime_error("image '" + encoded.name + "' is " + std::to_string(image.width) + "x" +
                                 std::to_string(image.height) +
                                 ", at most 16384 pixels on a side are supported");
    const auto bytes = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4;
    image.rgba.assign(pixels.get(), pixels.get() + bytes);
    return image;
}

// Images are most of a file's loading time.
void decode_all(const std::vector<EncodedImage>& encoded, const std::vector<int>& wanted, Scene& scene) {
    scene.images.resize(wanted.size());
    on_all_processors(static_cast<int>(wanted.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        scene.images[at] = decode(encoded[static_cast<std::size_t>(wanted[at])]);
    });
}

class MaterialReader {
  public:
    MaterialReader(const tinygltf::Model& model, std::size_t image_count, Scene& scene,
                   std::set<std::string>& unsupported)
        : model_(model), image_count_(image_count), scene_(scene), unsupported_(unsupported) {}

    int read(const tinygltf::Material& source) {
        uv_set_ = -1;
        Material m;
        m.name = source.name;
        const auto& pbr = source.pbrMetallicRoughness;
        for (int i = 0; i < 4 && i < static_cast<int>(pbr.baseColorFactor.size()); ++i)
            m.base_color[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
        m.metallic = std::clamp(static_cast<float>(pbr.metallicFactor), 0.0f, 1.0f);
        m.roughness = std::clamp(static_cast<float>(pbr.roughnessFactor), 0.0f, 1.0f);
        m.base_color_texture = slot(pbr.baseColorTexture, true);
        m.metallic_roughness_texture = slot(pbr.metallicRoughnessTexture, false);
        m.normal_texture = slot(source.normalTexture, false);
        m.normal_scale = static_cast<float>(source.normalTexture.scale);
        m.occlusion_texture = slot(source.occlusionTexture, false);
        m.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
        m.emissive_texture = slot(source.emissiveTexture, true);
        for (int i = 0; i < 3 && i < static_cast<int>(source.emissiveFactor.size()); ++i)
            m.emissive[i] = static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)]);
        m.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::mask
                       : source.alphaMode == "BLEND" ? AlphaMode::blend
                                                     : AlphaMode::opaque;
        m.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        m.double_sided = source.doubleSided;
        read_extensions(source, m);
        scene_.materials.push_back(std::move(m));
        return std::max(uv_set_, 0);
    }

    const std::vector<int>& used_images() const { return used_images_; }

  private:
    void read_extensions(const tinygltf::Material& source, Material& m) {
        for (const auto& [name, value] : source.extensions) {
            if (name == "KHR_materials_emissive_strength") {
                m.emissive *= number(value, "emissiveStrength", 1);
            } else if (name == "KHR_materials_ior") {
                m.ior = number(value, "ior", 1.5f);
            } else if (name == "KHR_materials_transmission") {
                m.transmission = std::clamp(number(value, "transmissionFactor", 0), 0.0f, 1.0f);
                if (value.Has("transmissionTexture")) unsupported_.insert("transmission textures");
            } else {
                unsupported_.insert(name);
            }
        }
    }

    template <typename Info>
    TextureSlot slot(const Info& info, bool srgb) {
        TextureSlot result;
        if (info.index < 0) return result;
        const auto index = static_cast<std::size_t>(info.index);
        if (index >= model_.textures.size())
            throw std::runtime_error("a material uses texture " + std::to_string(info.index) +
                                     ", there are " + std::to_string(model_.textures.size()));
        const tinygltf::Texture& texture = model_.textures[index];
        if (texture.source < 0) {
            unsupported_.insert("textures without a PNG or JPEG image");
            return result;
        }
        if (static_cast<std::size_t>(texture.source) >= image_count_)
            throw std::runtime_error("texture " + std::to_string(info.index) + " uses image " +
                                     std::to_string(texture.source) + ", there are " +
                                     std::to_string(image_count_));
        result.texture = texture_index(texture, srgb);
        int uv_set = info.texCoord;
        const auto transform = info.extensions.find("KHR_texture_transform");
        if (transform != info.extensions.end()) {
            result.offset = pair(transform->second, "offset", {0, 0});
            result.scale = pair(transform->second, "scale", {1, 1});
            result.rotation_rad = number(transform->second, "rotation", 0);
            uv_set = static_cast<int>(number(transform->second, "texCoord", static_cast<float>(uv_set)));
        }
        if (uv_set_ >= 0 && uv_set_ != uv_set)
            unsupported_.insert("materials that read two sets of texture coordinates");
        else
            uv_set_ = uv_set;
        return result;
    }

    int texture_index(const tinygltf::Texture& source, bool srgb) {
        SceneTexture texture;
        texture.srgb = srgb;
        if (source.sampler >= 0 && static_cast<std::size_t>(source.sampler) < model_.samplers.size()) {
            const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(source.sampler)];
            texture.wrap_u = wrap_of(sampler.wrapS);
            texture.wrap_v = wrap_of(sampler.wrapT);
            texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        const auto known = std::find(used_images_.begin(), used_images_.end(), source.source);
        texture.image = static_cast<int>(known - used_images_.begin());
        if (known == used_images_.end()) used_images_.push_back(source.source);
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            const SceneTexture& t = scene_.textures[i];
            if (t.image == texture.image && t.srgb == texture.srgb && t.wrap_u == texture.wrap_u &&
                t.wrap_v == texture.wrap_v && t.nearest == texture.nearest)
                return static_cast<int>(i);
        }
        scene_.textures.push_back(texture);
        return static_cast<int>(scene_.textures.size()) - 1;
    }

    const tinygltf::Model& model_;
    std::size_t image_count_;
    Scene& scene_;
    std::set<std::string>& unsupported_;
    std::vector<int> used_images_;  // glTF image of each scene image
    int uv_set_ = -1;
};

}  // namespace

std::vector<int> read_materials(const tinygltf::Model& model, const std::vector<EncodedImage>& images,
                                Scene& scene, std::set<std::string>& unsupported) {
    MaterialReader reader(model, images.size(), scene, unsupported);
    std::vector<int> uv_sets;
    for (const tinygltf::Material& material : model.materials) uv_sets.push_back(reader.read(material));
    uv_sets.push_back(reader.read(tinygltf::Material{}));
    decode_all(images, reader.used_images(), scene);
    return uv_sets;
}

}  // namespace parafovea
