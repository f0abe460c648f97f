// The foveation methods there are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/methods/foveation_method.h"

namespace parafovea {

struct MethodName {
    std::string name;
    std::string summary;
};
const std::vector<MethodName>& method_names();

// A method of method_names() that draws to sRGB targets. Throws std::runtime_error with the names there are.
std::unique_ptr<FoveationMethod> make_method(Gpu& gpu, const std::string& name, const ShadingSource& source);

// Throws std::runtime_error with one line if there is no such method or a parameter is unknown or out of
// range; the parameters of frame_stages.h and eye_dominance.h are every method's. Needs no device.
void check(const RenderMethod& method);

}  // namespace parafovea
