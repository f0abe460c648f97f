// The one list of settings for comparisons.
#include "renderer/methods/method_settings.h"

namespace parafovea {
namespace {

const char* const kPaper = "Meng et al. 2018, Section 5";
const char* const kOurs = "this project";

NamedSetting kfr(const char* label, std::map<std::string, double> numbers, const char* source,
                 std::map<std::string, std::string> words = {}) {
    return {label, {"kfr", std::move(numbers), std::move(words)}, source};
}

NamedSetting setting(const char* label, const char* method, std::map<std::string, double> numbers,
                     const char* source) {
    return {label, {method, std::move(numbers), {}}, source};
}

}  // namespace

const std::vector<NamedSetting>& tradeoff_settings() {
    static const std::vector<NamedSetting> settings{
        kfr("KFR as published", {{"sigma", 1.8}, {"alpha", 4}, {"culling", 0}}, kPaper),
        kfr("KFR 1.2", {{"sigma", 1.2}, {"alpha", 4}}, "Meng et al. 2018, Figure 9, with culling"),
        kfr("KFR 1.8", {{"sigma", 1.8}, {"alpha", 4}}, "Meng et al. 2018, Section 5, with culling"),
        kfr("KFR 2.4", {{"sigma", 2.4}, {"alpha", 4}}, "Meng et al. 2018, Figure 9, with culling"),
        kfr("KFR as printed", {{"sigma", 1.8}, {"alpha", 4}, {"as_printed", 1}}, "Meng et al. 2018, Eq. 10"),
        kfr("KFR as printed 0.8", {{"sigma", 0.8}, {"alpha", 4}, {"as_printed", 1}},
            "Meng et al. 2018, Eq. 10"),
        kfr("KFR and inset", {{"sigma", 1.8}, {"alpha", 4}, {"inset", 0.13}}, kOurs),
        kfr("KFR reshaped and inset",
            {{"sigma", 1.8}, {"alpha", 4}, {"inset", 0.09}, {"width_scale", 0.28}, {"height_scale", 1.25}},
            kOurs),
        kfr("KFR reshaped and inset fine",
            {{"sigma", 1.8}, {"alpha", 4}, {"inset", 0.09}, {"width_scale", 0.4}, {"height_scale", 1.9}},
            kOurs),
        kfr("linear MAR",
            {{"sigma", 1.8},
             {"inset", 0.09},
             {"width_scale", 0.27},
             {"height_scale", 1.375},
             {"internal_filter", 0}},
            kOurs, {{"kernel", "linear_mar"}}),
        kfr("linear MAR fine",
            {{"sigma", 1.8},
             {"inset", 0.16},
             {"width_scale", 0.36},
             {"height_scale", 1.5},
             {"mar_slope", 4.5},
             {"mar_start", 0.14},
             {"internal_filter", 0}},
            kOurs, {{"kernel", "linear_mar"}}),
        setting("rings coarse", "rings", {{"mar_slope", 9}}, kOurs),
        setting("rings", "rings", {}, kOurs),
        setting("rings fine", "rings", {{"mar_slope", 4}, {"mar_start", 0.05}}, kOurs),
        setting("rings finest", "rings", {{"mar_slope", 3}, {"mar_start", 0.1}}, kOurs),
        setting("rings by detail coarse", "rings", {{"adaptive", 1}, {"mar_slope", 6.5}, {"mar_start", 0.03}},
                kOurs),
        setting("rings by detail", "rings", {{"adaptive", 1}, {"mar_slope", 5}, {"mar_start", 0.05}}, kOurs),
        setting("rings by detail fine", "rings",
                {{"adaptive", 1}, {"mar_slope", 3.5}, {"mar_start", 0.05}, {"detail", 0.02}}, kOurs),
        setting("log-polar 2.4", "log_polar", {{"sigma", 2.4}},
                "Antonelli et al. 2015, at the paper's sizes"),
        setting("log-polar 1.8", "log_polar", {}, "Antonelli et al. 2015, at the paper's sizes"),
        setting("log-polar 1.2", "log_polar", {{"sigma", 1.2}},
                "Antonelli et al. 2015, at the paper's sizes"),
        setting("RMFR 4", "rmfr", {{"sigma", 4}}, "Ye et al. 2022, with the fovea native"),
        setting("RMFR 2.6", "rmfr", {}, "Ye et al. 2022, with the fovea native"),
        setting("RMFR 1.8", "rmfr", {{"sigma", 1.8}}, "Ye et al. 2022, with the fovea native"),
        setting("log-rectilinear 2.4", "log_rectilinear", {{"sigma", 2.4}}, "Li et al. 2021"),
        setting("log-rectilinear 1.8", "log_rectilinear", {}, "Li et al. 2021: 1072 x 608 for 1920 x 1080"),
        setting("F3D 1.65", "f3d", {{"mar_slope", 0.0275}}, "Guenter et al. 2012: 1.65 arcmin a degree"),
        setting("F3D 1.32", "f3d", {}, "Guenter et al. 2012: 1.32 arcmin a degree"),
        setting("F3D 0.66", "f3d", {{"mar_slope", 0.011}}, "half of what Guenter et al. 2012 found"),
        setting("quad views small", "quad_views", {{"focus_width", 0.3}, {"focus_height", 0.3}},
                "OpenXR quad views as headset makers set them"),
        setting("quad views", "quad_views", {},
                "OpenXR quad views with an eye tracker: focus 0.35, density 0.4"),
        setting("quad views large", "quad_views",
                {{"focus_width", 0.5}, {"focus_height", 0.45}, {"density", 0.5}},
                "OpenXR quad views without an eye tracker"),
        setting("lower resolution 1/4", "swafford_resolution", {{"density", 0.25}},
                "after Swafford et al. 2016"),
        setting("lower resolution 1/2", "swafford_resolution", {}, "after Swafford et al. 2016"),
        setting("fewer occlusion samples", "swafford_occlusion", {}, "after Swafford et al. 2016"),
        setting("fewer steps", "swafford_steps", {}, "after Swafford et al. 2016"),
        setting("fewest steps", "swafford_steps", {{"mar_slope", 17}, {"least", 0.15}},
                "after Swafford et al. 2016"),
        setting("CPS coarse", "cps", {{"mar_slope", 14}},
                "after Vaidyanathan et al. 2014, a steeper falloff"),
        setting("CPS", "cps", {}, "after Vaidyanathan et al. 2014: 1x1, 2x2, 4x4; the falloff is ours"),
        setting("CPS fine", "cps", {{"mar_slope", 4.5}, {"mar_start", 0.09}},
                "after Vaidyanathan et al. 2014, a flatter falloff"),
        setting("CPS smooth", "cps", {{"interpolate", 1}}, kOurs),
        setting("MRS coarse", "mrs", {{"detail", 0.1}}, "after He et al. 2014"),
        setting("MRS", "mrs", {}, "after He et al. 2014"),
        setting("MRS fine", "mrs", {{"detail", 0.02}}, "after He et al. 2014"),
        setting("Patney", "patney", {{"taa", 8}, {"contrast", 0.2}}, "Patney et al. 2016: f_e = 0.2"),
        setting("Patney fine", "patney", {{"mar_slope", 6.8}, {"taa", 8}, {"contrast", 0.2}},
                "Patney et al. 2016"),
        setting("AIS coarse", "ais", {{"mar_slope", 9}},
                "after Stengel et al. 2016: 80 % fewer samples; the falloff is ours"),
        setting("AIS", "ais", {}, "after Stengel et al. 2016: 50 to 80 % fewer samples"),
        setting("AIS fine", "ais", {{"mar_slope", 2.25}}, "after Stengel et al. 2016: 50 % fewer samples"),
    };
    return settings;
}

}  // namespace parafovea
