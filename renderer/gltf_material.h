// Materials, textures and images of a glTF file.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "renderer/scene.h"

namespace tinygltf {
class Model;
}

namespace parafovea {

// An image file's bytes (PNG or JPEG) as they stand in the glTF file, before decoding.
struct EncodedImage {
    std::string name;
    std::vector<unsigned char> bytes;
};

// Fills scene.materials (the last one is glTF's default material), scene.textures and scene.images. Images
// that no material uses are not decoded. What is not modelled is added to `unsupported`. Returns, for each
// material, which set of texture coordinates it reads.
std::vector<int> read_materials(const tinygltf::Model& model, const std::vector<EncodedImage>& images,
                                Scene& scene, std::set<std::string>& unsupported);

}  // namespace parafovea
