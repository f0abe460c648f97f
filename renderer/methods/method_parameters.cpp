// Reads a method's parameters.
#include "renderer/methods/method_parameters.h"

#include <cstdio>
#include <stdexcept>

namespace parafovea {

double MethodParameters::number(const std::string& name, double otherwise) {
    left_.numbers.erase(name);
    const auto found = method_.numbers.find(name);
    return found == method_.numbers.end() ? otherwise : found->second;
}

double MethodParameters::number(const std::string& name, double otherwise, double low, double high) {
    const double value = number(name, otherwise);
    if (value >= low && value <= high) return value;
    char text[96];
    std::snprintf(text, sizeof text, " = %g is not in %g to %g", value, low, high);
    throw std::runtime_error("method " + method_.name + ": " + name + text);
}

bool MethodParameters::flag(const std::string& name, bool otherwise) {
    const double value = number(name, otherwise ? 1 : 0);
    if (value != 0 && value != 1) {
        throw std::runtime_error("method " + method_.name + ": " + name + " is a switch, 0 or 1");
    }
    return value == 1;
}

std::optional<std::string> MethodParameters::word(const std::string& name) {
    left_.words.erase(name);
    const auto found = method_.words.find(name);
    if (found == method_.words.end()) return std::nullopt;
    return found->second;
}

KernelSetting MethodParameters::kernel() {
    KernelSetting setting;
    if (const auto name = word("kernel")) setting.kind = kernel_kind_from_name(*name);
    setting.sigma = number("sigma", setting.sigma);
    setting.alpha = number("alpha", setting.alpha);
    setting.width_scale = number("width_scale", setting.width_scale);
    setting.height_scale = number("height_scale", setting.height_scale);
    setting.mar_slope = number("mar_slope", setting.mar_slope);
    setting.mar_start = number("mar_start", setting.mar_start);
    setting.as_printed = flag("as_printed", setting.as_printed);
    for (int i = 1; i <= 8; ++i) {
        const std::string name = "beta_" + std::to_string(i);
        if (!method_.numbers.contains(name)) continue;
        setting.betas.resize(static_cast<std::size_t>(i), 0.0);
        setting.betas.back() = number(name, 0);
    }
    check(setting);
    return setting;
}

void MethodParameters::check_all_taken() const {
    std::string unknown;
    if (!left_.numbers.empty()) unknown = left_.numbers.begin()->first;
    if (!left_.words.empty()) unknown = left_.words.begin()->first;
    if (!unknown.empty()) {
        throw std::runtime_error("method " + method_.name + " has no parameter \"" + unknown + "\"");
    }
}

}  // namespace parafovea
