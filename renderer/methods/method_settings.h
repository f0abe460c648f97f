// Settings of every method from cheap to dear, for comparisons; among them what each method's source used.
#pragma once

#include <string>
#include <vector>

#include "renderer/methods/foveation_method.h"

namespace parafovea {

struct NamedSetting {
    std::string label;  // how tables call it; no two alike
    RenderMethod method;
    std::string source;  // where the setting is from, in one line
};

// Every method of method_names() but full resolution, each with its defaults and two or three more.
const std::vector<NamedSetting>& tradeoff_settings();

}  // namespace parafovea
