// Walks a glTF file's JSON and compares each known property with its type (glTF 2.0, JSON schema).
#include "renderer/gltf_types.h"

#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace parafovea {
namespace {

using nlohmann::json;

enum class Kind { text, index, number, truth, object, list };

// Names that mean the same wherever they stand. "scale", "indices", "target" and "values" do not and are left
// to their readers.
const std::map<std::string, Kind, std::less<>> kKinds{
    {"name", Kind::text},
    {"uri", Kind::text},
    {"mimeType", Kind::text},
    {"alphaMode", Kind::text},
    {"type", Kind::text},
    {"version", Kind::text},
    {"scene", Kind::index},
    {"node", Kind::index},
    {"mesh", Kind::index},
    {"skin", Kind::index},
    {"camera", Kind::index},
    {"material", Kind::index},
    {"bufferView", Kind::index},
    {"buffer", Kind::index},
    {"byteOffset", Kind::index},
    {"byteLength", Kind::index},
    {"byteStride", Kind::index},
    {"count", Kind::index},
    {"componentType", Kind::index},
    {"source", Kind::index},
    {"sampler", Kind::index},
    {"texCoord", Kind::index},
    {"index", Kind::index},
    {"mode", Kind::index},
    {"wrapS", Kind::index},
    {"wrapT", Kind::index},
    {"magFilter", Kind::index},
    {"minFilter", Kind::index},
    {"metallicFactor", Kind::number},
    {"roughnessFactor", Kind::number},
    {"strength", Kind::number},
    {"alphaCutoff", Kind::number},
    {"yfov", Kind::number},
    {"znear", Kind::number},
    {"zfar", Kind::number},
    {"aspectRatio", Kind::number},
    {"doubleSided", Kind::truth},
    {"normalized", Kind::truth},
    {"asset", Kind::object},
    {"pbrMetallicRoughness", Kind::object},
    {"baseColorTexture", Kind::object},
    {"metallicRoughnessTexture", Kind::object},
    {"normalTexture", Kind::object},
    {"occlusionTexture", Kind::object},
    {"emissiveTexture", Kind::object},
    {"attributes", Kind::object},
    {"sparse", Kind::object},
    {"perspective", Kind::object},
    {"extensions", Kind::object},
    {"accessors", Kind::list},
    {"buffers", Kind::list},
    {"bufferViews", Kind::list},
    {"images", Kind::list},
    {"materials", Kind::list},
    {"meshes", Kind::list},
    {"nodes", Kind::list},
    {"scenes", Kind::list},
    {"textures", Kind::list},
    {"samplers", Kind::list},
    {"animations", Kind::list},
    {"skins", Kind::list},
    {"cameras", Kind::list},
    {"primitives", Kind::list},
    {"children", Kind::list},
    {"extensionsUsed", Kind::list},
    {"extensionsRequired", Kind::list},
    {"baseColorFactor", Kind::list},
    {"emissiveFactor", Kind::list},
    {"matrix", Kind::list},
    {"rotation", Kind::list},
    {"translation", Kind::list},
};

// Nullptr if the value is of the kind, else what was expected.
const char* mismatch(Kind kind, const json& value) {
    switch (kind) {
        case Kind::text:
            return value.is_string() ? nullptr : "text expected";
        case Kind::index:
            return value.is_number_unsigned() ? nullptr : "a whole number of at least 0 expected";
        case Kind::number:
            return value.is_number() ? nullptr : "a number expected";
        case Kind::truth:
            return value.is_boolean() ? nullptr : "true or false expected";
        case Kind::object:
            return value.is_object() ? nullptr : "an object expected";
        case Kind::list:
            return value.is_array() ? nullptr : "a list expected";
    }
    return nullptr;
}

void check(const json& value, const std::string& path, int depth) {
    if (depth > 64) throw std::runtime_error(path + ": nested too deep");
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i)
            if (value[i].is_structured()) check(value[i], path + "[" + std::to_string(i) + "]", depth + 1);
        return;
    }
    for (const auto& [key, member] : value.items()) {
        if (key == "extras") continue;
        const std::string here = path.empty() ? key : path + "." + key;
        if (const auto known = kKinds.find(key); known != kKinds.end())
            if (const char* expected = mismatch(known->second, member))
                throw std::runtime_error(here + ": " + expected);
        if (key == "extensions") {
            for (const auto& [extension, content] : member.items())
                if (!content.is_object())
                    throw std::runtime_error(here + "." + extension + ": an object expected");
        } else if (member.is_structured()) {
            check(member, here, depth + 1);
        }
    }
}

}  // namespace

void check_gltf_types(const std::string& json_text) {
    const json document = json::parse(json_text, nullptr, false);
    if (document.is_discarded()) return;
    if (!document.is_object()) throw std::runtime_error("it is not a glTF 2.0 file");
    check(document, "", 0);
}

}  // namespace parafovea
