// Checks that the properties of a glTF file are of the types its schema gives them, before anything relies on
// it.
#pragma once

#include <string>

namespace parafovea {

// Throws std::runtime_error naming the first property of a wrong type, as "meshes[0].primitives: a list
// expected". Text that is no JSON at all passes; the parser says so better. `extras` and unknown extensions
// may hold anything.
void check_gltf_types(const std::string& json_text);

}  // namespace parafovea
