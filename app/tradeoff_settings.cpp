// The settings of every method that a sweep measures when it is not told which.
#include <utility>

#include "app/tradeoff_plan.h"

namespace parafovea {

std::vector<TradeoffMethod> standard_tradeoff_methods() {
    std::vector<TradeoffMethod> methods;
    const auto add = [&](const char* family, std::map<std::string, double> numbers,
                         std::map<std::string, std::string> words = {}) {
        methods.push_back({family, {"kfr", std::move(numbers), std::move(words)}});
    };
    for (const double sigma : {1.2, 1.8, 2.4})
        add("KFR as published", {{"sigma", sigma}, {"alpha", 4}, {"culling", 0}});
    add("KFR", {{"sigma", 1.8}, {"alpha", 4}});
    for (const double sigma : {1.8, 2.4})
        add("KFR and inset", {{"sigma", sigma}, {"alpha", 4}, {"inset", 0.075}});
    for (const auto& [width, height] : {std::pair(0.28, 1.25), std::pair(0.4, 1.785)})
        add("KFR reshaped and inset", {{"sigma", 1.8},
                                       {"alpha", 4},
                                       {"width_scale", width},
                                       {"height_scale", height},
                                       {"inset", 0.05}});
    for (const auto& [width, height] : {std::pair(0.267, 1.375), std::pair(0.38, 1.957)})
        add("linear MAR and inset",
            {{"sigma", 1.8},
             {"width_scale", width},
             {"height_scale", height},
             {"mar_slope", 14},
             {"mar_start", 0.039}},
            {{"kernel", "linear_mar"}});
    return methods;
}

}  // namespace parafovea
