// Walks a glTF file's default scene and gathers its meshes, lights and cameras.
#include "renderer/gltf_loader.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "renderer/gltf_accessor.h"
#include "renderer/gltf_defaults.h"
#include "renderer/gltf_material.h"
#include "renderer/gltf_types.h"
#include "renderer/scene_tangents.h"

namespace parafovea {
namespace {

const std::set<std::string> kSupportedExtensions{"KHR_lights_punctual",   "KHR_materials_emissive_strength",
                                                 "KHR_materials_ior",     "KHR_materials_transmission",
                                                 "KHR_mesh_quantization", "KHR_texture_transform"};

// tinygltf's messages may have several lines and end in one.
std::string one_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::string line;
    for (char c : text) line += c == '\n' ? std::string("; ") : std::string(1, c);
    return line;
}

// Keeps an image's bytes for later; they are decoded once it is known which are used.
bool keep_image(tinygltf::Image* image, int index, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void* user) {
    auto& images = *static_cast<std::vector<EncodedImage>*>(user);
    if (images.size() <= static_cast<std::size_t>(index)) images.resize(static_cast<std::size_t>(index) + 1);
    EncodedImage& kept = images[static_cast<std::size_t>(index)];
    kept.name = !image->name.empty()                             ? image->name
                : !image->uri.empty() && image->uri.size() < 200 ? image->uri
                                                                 : "image " + std::to_string(index);
    kept.bytes.assign(bytes, bytes + size);
    return true;
}

struct Parsed {
    tinygltf::Model model;
    std::vector<EncodedImage> images;
};

std::string whole_text(std::ifstream& file) {
    file.clear();
    file.seekg(0);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The JSON of a .glb file: after the header of 12 bytes, length and kind of the first chunk. Empty if it is
// cut short; the parser says so better.
std::string json_chunk(std::ifstream& file) {
    std::uint32_t header[2] = {};
    file.seekg(12);
    file.read(reinterpret_cast<char*>(header), sizeof header);
    file.seekg(0, std::ios::end);
    const auto size = static_cast<std::uint64_t>(file.tellg());
    if (!file || std::uint64_t{header[0]} + 20 > size) return "";
    std::string text(header[0], ' ');
    file.seekg(20);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
}

Parsed parse(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("there is no such file");
    char magic[4] = {};
    file.read(magic, 4);
    const bool binary = file.gcount() == 4 && std::string_view(magic, 4) == "glTF";
    check_gltf_types(binary ? json_chunk(file) : whole_text(file));

    Parsed parsed;
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, &parsed.images);
    std::string error, warning;
    bool good = false;
    try {
        good = binary ? reader.LoadBinaryFromFile(&parsed.model, &error, &warning, path)
                      : reader.LoadASCIIFromFile(&parsed.model, &error, &warning, path);
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!good || !error.empty())
        throw std::runtime_error(error.empty() ? "it is not a glTF 2.0 file" : one_line(error));
    parsed.images.resize(parsed.model.images.size());
    return parsed;
}

glm::mat4 local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        glm::mat4 m;
        for (int i = 0; i < 16; ++i)
            glm::value_ptr(m)[i] = static_cast<float>(node.matrix[static_cast<std::size_t>(i)]);
        return m;
    }
    glm::mat4 m{1};
    if (node.rotation.size() == 4) {
        const glm::quat q(static_cast<float>(node.rotation[3]), static_cast<float>(node.rotation[0]),
                          static_cast<float>(node.rotation[1]), static_cast<float>(node.rotation[2]));
        const float length = glm::length(q);
        if (length > 0) m = glm::mat4_cast(q / length);
    }
    if (node.scale.size() == 3)
        for (int i = 0; i < 3; ++i) m[i] *= static_cast<float>(node.scale[static_cast<std::size_t>(i)]);
    if (node.translation.size() == 3)
        m[3] = glm::vec4(node.translation[0], node.translation[1], node.translation[2], 1);
    return m;
}

// Turns strips and fans into single triangles.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> indices, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return indices;
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 2; i < indices.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.insert(triangles.end(), {indices[0], indices[i - 1], indices[i]});
        else if (i % 2 == 0)
            triangles.insert(triangles.end(), {indices[i - 2], indices[i - 1], indices[i]});
        else
            triangles.insert(triangles.end(), {indices[i - 1], indices[i - 2], indices[i]});
    }
    return triangles;
}

class SceneBuilder {
  public:
    SceneBuilder(Parsed& parsed, Scene& scene) : model_(parsed.model), scene_(scene) {
        for (const std::string& name : model_.extensionsRequired)
            if (!kSupportedExtensions.contains(name))
                throw std::runtime_error("it needs the extension " + name + ", which is not supported");
        for (const std::string& name : model_.extensionsUsed)
            if (!kSupportedExtensions.contains(name)) unsupported_.insert(name);
        if (!model_.animations.empty()) unsupported_.insert("animations");
        uv_sets_ = read_materials(model_, parsed.images, scene_, unsupported_);
        mesh_parts_.resize(model_.meshes.size());
        mesh_read_.resize(model_.meshes.size(), false);
        visiting_.resize(model_.nodes.size(), false);
    }

    void build() {
        std::vector<int> roots;
        if (!model_.scenes.empty()) {
            const int index = model_.defaultScene >= 0 ? model_.defaultScene : 0;
            if (static_cast<std::size_t>(index) >= model_.scenes.size())
                throw std::runtime_error("there is no scene " + std::to_string(index));
            roots = model_.scenes[static_cast<std::size_t>(index)].nodes;
        } else {
            // Without scenes every node that is nobody's child is shown.
            std::vector<bool> child(model_.nodes.size(), false);
            for (const tinygltf::Node& node : model_.nodes)
                for (int c : node.children)
                    if (c >= 0 && static_cast<std::size_t>(c) < child.size())
                        child[static_cast<std::size_t>(c)] = true;
            for (std::size_t i = 0; i < child.size(); ++i)
                if (!child[i]) roots.push_back(static_cast<int>(i));
        }
        for (int root : roots) visit(root, glm::mat4(1), 0);
        if (scene_.instances.empty()) throw std::runtime_error("its scene holds no triangles");
        if (!unsupported_.empty()) {
            std::string line = "not shown:";
            for (const std::string& name : unsupported_) line += (line.back() == ':' ? " " : ", ") + name;
            scene_.warnings.push_back(line);
        }
    }

    bool has_sun() const { return has_sun_; }

  private:
    void visit(int index, const glm::mat4& parent, int depth) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
            throw std::runtime_error("there is no node " + std::to_string(index));
        const auto i = static_cast<std::size_t>(index);
        if (visiting_[i]) throw std::runtime_error("node " + std::to_string(index) + " is its own ancestor");
        if (depth > 1000) throw std::runtime_error("its nodes are nested more than 1000 deep");
        visiting_[i] = true;
        const tinygltf::Node& node = model_.nodes[i];
        const glm::mat4 world = parent * local_transform(node);
        if (node.mesh >= 0) add_mesh(node.mesh, world);
        if (node.skin >= 0) unsupported_.insert("skins");
        if (node.camera >= 0) add_camera(node.camera, node.name, world);
        add_light(node, world);
        if (node.extensions.contains("EXT_mesh_gpu_instancing"))
            unsupported_.insert("EXT_mesh_gpu_instancing");
        for (int child : node.children) visit(child, world, depth + 1);
        visiting_[i] = false;
    }

    void add_mesh(int index, const glm::mat4& world) {
        if (static_cast<std::size_t>(index) >= model_.meshes.size())
            throw std::runtime_error("there is no mesh " + std::to_string(index));
        const auto i = static_cast<std::size_t>(index);
        if (!mesh_read_[i]) {
            for (const tinygltf::Primitive& primitive : model_.meshes[i].primitives) {
                const int part = read_primitive(model_.meshes[i], primitive);
                if (part >= 0) mesh_parts_[i].push_back(part);
            }
            mesh_read_[i] = true;
        }
        for (int part : mesh_parts_[i]) scene_.instances.push_back({part, world});
    }

    // Returns the scene's mesh, or -1 when there is nothing to draw.
    int read_primitive(const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            unsupported_.insert("points and lines");
            return -1;
        }
        if (!primitive.targets.empty()) unsupported_.insert("morph targets");
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return -1;
        const std::string what = "mesh '" + mesh.name + "'";

        Triangles triangles;
        const std::vector<float> positions = read_floats(model_, position->second, 3, what + " positions");
        triangles.vertices.resize(positions.size() / 3);
        for (std::size_t v = 0; v < triangles.vertices.size(); ++v) {
            const glm::vec3 p{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
            if (!std::isfinite(p.x + p.y + p.z))
                throw std::runtime_error(what + ": position " + std::to_string(v) + " is not finite");
            triangles.vertices[v].position = p;
        }
        read_indices(primitive, mode, what, triangles);
        if (triangles.indices.empty()) return -1;
        const int material = material_of(primitive.material, what);
        const bool good_normals = read_attributes(primitive, material, what, triangles);
        if (!good_normals) make_flat_normals(triangles);
        const bool has_tangents = good_normals && primitive.attributes.contains("TANGENT");
        if (scene_.materials[static_cast<std::size_t>(material)].normal_texture && !has_tangents)
            make_tangents(triangles);
        return append_mesh(scene_, triangles, material);
    }

    void read_indices(const tinygltf::Primitive& primitive, int mode, const std::string& what,
                      Triangles& triangles) {
        std::vector<std::uint32_t> indices;
        if (primitive.indices >= 0) {
            indices = read_integers(model_, primitive.indices, 1, what + " indices");
            for (std::uint32_t index : indices)
                if (index >= triangles.vertices.size())
                    throw std::runtime_error(what + ": index " + std::to_string(index) +
                                             " is out of range, there are " +
                                             std::to_string(triangles.vertices.size()) + " vertices");
        } else {
            indices.resize(triangles.vertices.size());
            for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
        }
        if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
            throw std::runtime_error(what + ": " + std::to_string(indices.size()) +
                                     " indices do not make whole triangles");
        triangles.indices = as_triangles(std::move(indices), mode);
    }

    int material_of(int index, const std::string& what) const {
        const int count = static_cast<int>(model_.materials.size());
        if (index >= count)
            throw std::runtime_error(what + " uses material " + std::to_string(index) + ", there are " +
                                     std::to_string(count));
        return index < 0 ? count : index;
    }

    // An attribute for each vertex, or empty when the primitive has none of that name.
    std::vector<float> attribute(const tinygltf::Primitive& primitive, const std::string& name,
                                 int components, std::size_t vertices, const std::string& what) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return {};
        std::vector<float> values = read_floats(model_, found->second, components, what + " " + name);
        if (values.size() != vertices * static_cast<std::size_t>(components))
            throw std::runtime_error(what + ": " + name + " has " +
                                     std::to_string(values.size() / static_cast<std::size_t>(components)) +
                                     " elements for " + std::to_string(vertices) + " vertices");
        return values;
    }

    // Normals, tangents, texture coordinates and colours. False when the normals are missing or unusable.
    bool read_attributes(const tinygltf::Primitive& primitive, int material, const std::string& what,
                         Triangles& triangles) {
        auto& vertices = triangles.vertices;
        const std::size_t count = vertices.size();
        const std::vector<float> normals = attribute(primitive, "NORMAL", 3, count, what);
        bool good_normals = !normals.empty();
        for (std::size_t v = 0; v < count && good_normals; ++v) {
            const glm::vec3 n{normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]};
            const float length = glm::length(n);
            good_normals = std::isfinite(length) && length > 1e-6f;
            if (good_normals) vertices[v].normal = n / length;
        }
        if (!normals.empty() && !good_normals) unsupported_.insert("normals of zero or infinite length");
        const std::vector<float> tangents = attribute(primitive, "TANGENT", 4, count, what);
        for (std::size_t v = 0; v < count && !tangents.empty(); ++v)
            vertices[v].tangent = {tangents[4 * v], tangents[4 * v + 1], tangents[4 * v + 2],
                                   tangents[4 * v + 3] < 0 ? -1.0f : 1.0f};
        const int uv_set = uv_sets_[static_cast<std::size_t>(material)];
        const std::vector<float> uvs =
            attribute(primitive, "TEXCOORD_" + std::to_string(uv_set), 2, count, what);
        for (std::size_t v = 0; v < count && !uvs.empty(); ++v) vertices[v].uv = {uvs[2 * v], uvs[2 * v + 1]};
        const auto color = primitive.attributes.find("COLOR_0");
        if (color != primitive.attributes.end()) {
            const int components = components_of(model_, color->second, what + " COLOR_0");
            if (components != 3 && components != 4)
                throw std::runtime_error(what + ": COLOR_0 has " + std::to_string(components) +
                                         " components, 3 or 4 expected");
            const std::vector<float> colors = attribute(primitive, "COLOR_0", components, count, what);
            for (std::size_t v = 0; v < count; ++v)
                for (int c = 0; c < components; ++c)
                    vertices[v].color[c] = static_cast<std::uint8_t>(std::lround(
                        255 *
                        std::clamp(
                            colors[v * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)],
                            0.0f, 1.0f)));
        }
        return good_normals;
    }

    void add_camera(int index, const std::string& node_name, const glm::mat4& world) {
        if (static_cast<std::size_t>(index) >= model_.cameras.size())
            throw std::runtime_error("there is no camera " + std::to_string(index));
        const tinygltf::Camera& source = model_.cameras[static_cast<std::size_t>(index)];
        if (source.type != "perspective") {
            unsupported_.insert("orthographic cameras");
            return;
        }
        SceneCamera camera;
        camera.name = !source.name.empty() ? source.name : node_name;
        const glm::vec3 back = glm::normalize(glm::vec3(world[2]));
        const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(world[1]), back));
        camera.world_from_camera = glm::mat4(glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0),
                                             glm::vec4(back, 0), world[3]);
        camera.vertical_fov_rad = std::clamp(static_cast<float>(source.perspective.yfov), 0.05f, 2.8f);
        camera.near_m = std::max(static_cast<float>(source.perspective.znear), 1e-3f);
        scene_.cameras.push_back(camera);
    }

    void add_light(const tinygltf::Node& node, const glm::mat4& world) {
        const auto extension = node.extensions.find("KHR_lights_punctual");
        if (extension == node.extensions.end() || !extension->second.Has("light")) return;
        const int index = extension->second.Get("light").GetNumberAsInt();
        if (index < 0 || static_cast<std::size_t>(index) >= model_.lights.size())
            throw std::runtime_error("there is no light " + std::to_string(index));
        const tinygltf::Light& source = model_.lights[static_cast<std::size_t>(index)];
        glm::vec3 color{1};
        for (int i = 0; i < 3 && i < static_cast<int>(source.color.size()); ++i)
            color[i] = static_cast<float>(source.color[static_cast<std::size_t>(i)]);
        color *= static_cast<float>(source.intensity);
        const glm::vec3 along = glm::normalize(-glm::vec3(world[2]));
        if (source.type == "directional") {
            if (has_sun_) unsupported_.insert("more than one directional light");
            if (!has_sun_) scene_.sun = Sun{-along, color, true};
            has_sun_ = true;
            return;
        }
        PunctualLight light;
        light.kind = source.type == "spot" ? LightKind::spot : LightKind::point;
        light.position = glm::vec3(world[3]);
        light.direction = along;
        light.intensity = color;
        light.range_m = static_cast<float>(source.range);
        light.inner_cone_rad = static_cast<float>(source.spot.innerConeAngle);
        light.outer_cone_rad = static_cast<float>(source.spot.outerConeAngle);
        scene_.lights.push_back(light);
    }

    const tinygltf::Model& model_;
    Scene& scene_;
    std::set<std::string> unsupported_;
    std::vector<int> uv_sets_;
    std::vector<std::vector<int>> mesh_parts_;
    std::vector<bool> mesh_read_;
    std::vector<bool> visiting_;
    bool has_sun_ = false;
};

}  // namespace

Scene load_gltf(const std::string& path) {
    try {
        Parsed parsed = parse(path);
        Scene scene;
        scene.name = std::filesystem::path(path).stem().string();
        SceneBuilder builder(parsed, scene);
        builder.build();
        if (scene.cameras.empty()) scene.cameras.push_back(default_camera(scene));
        light_by_default(scene, builder.has_sun());
        if (scene.lights.size() > 64) {
            scene.warnings.push_back("only the first 64 of " + std::to_string(scene.lights.size()) +
                                     " lamps are lit");
            scene.lights.resize(64);
        }
        return scene;
    } catch (const std::exception& e) {
        throw std::runtime_error(path + ": cannot be shown: " + one_line(e.what()));
    }
}

}  // namespace parafovea
