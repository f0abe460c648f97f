// The one list of methods: a new method on a sample grid is a line, any other one in each function.
#include "renderer/methods/method_list.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "renderer/eye_dominance.h"
#include "renderer/frame_stages.h"
#include "renderer/methods/effort_method.h"
#include "renderer/methods/full_method.h"
#include "renderer/methods/grid_method.h"
#include "renderer/methods/kfr_method.h"
#include "renderer/methods/log_polar_method.h"
#include "renderer/methods/method_parameters.h"

namespace parafovea {
namespace {

constexpr VkFormat kTargetFormat = VK_FORMAT_R8G8B8A8_SRGB;

struct GridMethodName {
    const char* name;
    const char* summary;
    GridPlanner planner;
};

constexpr std::array kGridMethods{
    GridMethodName{"rings", "rings around the gaze, their samples spaced as acuity falls; a native disc",
                   plan_rings},
    GridMethodName{"rmfr", "rectangular mapping (Ye et al. 2022): one smooth map for each axis", plan_rmfr},
    GridMethodName{"log_rectilinear",
                   "log-rectilinear mapping (Li et al. 2021): one map for each axis, exact at the gaze",
                   plan_log_rectilinear},
    GridMethodName{"f3d", "three nested layers (Guenter et al. 2012)", plan_f3d},
    GridMethodName{"quad_views", "a native rectangle at the gaze, the rest reduced", plan_quad_views},
    GridMethodName{"swafford_resolution", "lower peripheral resolution (Swafford et al. 2016, first method)",
                   plan_swafford_resolution},
    GridMethodName{"cps", "coarse pixel shading 1x1, 2x2, 4x4 (Vaidyanathan et al. 2014)", plan_cps},
    GridMethodName{"mrs", "multi-rate shading by eccentricity and detail (after He et al. 2014)", plan_mrs},
    GridMethodName{"patney", "coarse shading of pre-filtered samples (Patney et al. 2016)", plan_patney},
    GridMethodName{"ais", "adaptive image-space sampling with pull-push (Stengel et al. 2016)", plan_ais},
};

const GridMethodName* grid_method_called(const std::string& name) {
    const auto* found =
        std::ranges::find_if(kGridMethods, [&](const GridMethodName& m) { return name == m.name; });
    return found == kGridMethods.end() ? nullptr : found;
}

std::optional<SavedEffort> saved_effort(const std::string& name) {
    if (name == "swafford_occlusion") return SavedEffort::occlusion;
    if (name == "swafford_steps") return SavedEffort::steps;
    return std::nullopt;
}

[[noreturn]] void refuse(const std::string& name) {
    std::string names;
    for (const MethodName& method : method_names()) names += (names.empty() ? "" : ", ") + method.name;
    throw std::runtime_error("unknown method \"" + name + "\"; there are: " + names);
}

}  // namespace

const std::vector<MethodName>& method_names() {
    static const std::vector<MethodName> names = [] {
        std::vector<MethodName> all{
            {"full", "full resolution, one sample per pixel"},
            {"kfr", "kernel foveated rendering (Meng et al. 2018): a reduced log-polar buffer"},
            {"log_polar", "the classic log-polar map (Antonelli et al. 2015)"},
            {"swafford_occlusion", "fewer occlusion samples (Swafford et al. 2016, second method)"},
            {"swafford_steps", "fewer steps along rays (Swafford et al. 2016, fourth method)"},
        };
        for (const GridMethodName& method : kGridMethods) all.push_back({method.name, method.summary});
        return all;
    }();
    return names;
}

std::unique_ptr<FoveationMethod> make_method(Gpu& gpu, const std::string& name, const ShadingSource& source) {
    const VkFormat reduced = display_linear_format(gpu);
    const KfrFormats formats{.target = kTargetFormat,
                             .reduced = reduced,
                             .in_compute = source.in_compute && shaders_can_write(gpu, reduced)};
    if (name == "full") return std::make_unique<FullMethod>(gpu, source, kTargetFormat);
    if (name == "kfr") return std::make_unique<KfrMethod>(gpu, source, formats);
    if (name == "log_polar") return std::make_unique<LogPolarMethod>(gpu, source, formats);
    if (const std::optional<SavedEffort> saved = saved_effort(name))
        return std::make_unique<EffortMethod>(gpu, source, kTargetFormat, *saved);
    if (const GridMethodName* method = grid_method_called(name)) {
        return std::make_unique<GridMethod>(
            gpu, source, GridFormats{.target = kTargetFormat, .samples = reduced}, method->planner);
    }
    refuse(name);
}

void check(const RenderMethod& wanted) {
    RenderMethod method = method_for_dominant_eye(wanted);
    take_frame_stages(method);
    if (method.name == "full") return MethodParameters(method).check_all_taken();
    if (method.name == "kfr") return static_cast<void>(kfr_setting(method));
    if (method.name == "log_polar") return static_cast<void>(log_polar_setting(method));
    if (saved_effort(method.name)) return static_cast<void>(effort_falloff(method));
    const GridMethodName* on_grid = grid_method_called(method.name);
    if (on_grid == nullptr) refuse(method.name);
    MethodParameters parameters(method);
    on_grid->planner(parameters, {64, 64}, {32, 32});
    parameters.check_all_taken();
}

}  // namespace parafovea
