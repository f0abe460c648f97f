// The one list of methods: a new method is a line in each function.
#include "renderer/methods/method_list.h"

#include <stdexcept>

#include "renderer/eye_dominance.h"
#include "renderer/frame_stages.h"
#include "renderer/methods/full_method.h"
#include "renderer/methods/kfr_method.h"
#include "renderer/methods/method_parameters.h"

namespace parafovea {
namespace {

constexpr VkFormat kTargetFormat = VK_FORMAT_R8G8B8A8_SRGB;

// Display-linear values with 16 bits each; halves where the device cannot draw to fixed-point ones.
VkFormat reduced_format(const Gpu& gpu) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu.physical_device(), VK_FORMAT_R16G16B16A16_UNORM, &properties);
    const VkFormatFeatureFlags needed =
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return (properties.optimalTilingFeatures & needed) == needed ? VK_FORMAT_R16G16B16A16_UNORM
                                                                 : VK_FORMAT_R16G16B16A16_SFLOAT;
}

[[noreturn]] void refuse(const std::string& name) {
    std::string names;
    for (const MethodName& known : method_names()) names += (names.empty() ? "" : ", ") + known.name;
    throw std::runtime_error("unknown method \"" + name + "\"; there are: " + names);
}

}  // namespace

const std::vector<MethodName>& method_names() {
    static const std::vector<MethodName> names{
        {"full", "full resolution, one sample per pixel"},
        {"kfr", "kernel foveated rendering (Meng et al. 2018): a reduced log-polar buffer"},
    };
    return names;
}

std::unique_ptr<FoveationMethod> make_method(Gpu& gpu, const std::string& name, const ShadingSource& source) {
    if (name == "full") return std::make_unique<FullMethod>(gpu, source, kTargetFormat);
    if (name == "kfr")
        return std::make_unique<KfrMethod>(
            gpu, source, KfrFormats{.target = kTargetFormat, .reduced = reduced_format(gpu)});
    refuse(name);
}

void check(const RenderMethod& wanted) {
    RenderMethod method = method_for_dominant_eye(wanted);
    take_frame_stages(method);
    if (method.name == "full") return MethodParameters(method).check_all_taken();
    if (method.name == "kfr") return static_cast<void>(kfr_setting(method));
    refuse(method.name);
}

}  // namespace parafovea
