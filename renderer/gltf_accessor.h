// Reads glTF accessors with every bound checked: strided, sparse, normalized, of any component type.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace parafovea {

// `components` floats for each element, one element after the other; integers are converted, normalized ones
// to [0, 1] or [-1, 1]. `what` names the data in errors. Throws std::runtime_error when the accessor does not
// exist, has another number of components or reaches outside its buffer.
std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components,
                               const std::string& what);

// The same for whole numbers.
std::vector<std::uint32_t> read_integers(const tinygltf::Model& model, int accessor, int components,
                                         const std::string& what);

// Components of an accessor's elements (1 to 16); throws when it does not exist.
int components_of(const tinygltf::Model& model, int accessor, const std::string& what);

}  // namespace parafovea
