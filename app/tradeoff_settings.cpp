// The settings of every method that a sweep measures when it is not told which.
#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "app/tradeoff_plan.h"
#include "renderer/methods/method_settings.h"

namespace parafovea {
namespace {

// A label without the word that says which of a method's settings it is: "KFR 2.4", "rings coarse".
std::string family_of(const std::string& label) {
    constexpr std::array<std::string_view, 5> kDegrees = {"coarse", "fine", "finest", "small", "large"};
    const std::size_t space = label.rfind(' ');
    if (space == std::string::npos) return label;
    const std::string_view last = std::string_view(label).substr(space + 1);
    const bool degree = std::isdigit(static_cast<unsigned char>(last.front())) != 0 ||
                        std::ranges::find(kDegrees, last) != kDegrees.end();
    return degree ? label.substr(0, space) : label;
}

}  // namespace

std::vector<TradeoffMethod> standard_tradeoff_methods() {
    std::vector<TradeoffMethod> methods;
    for (const NamedSetting& setting : tradeoff_settings())
        methods.push_back({family_of(setting.label), setting.method});
    return methods;
}

}  // namespace parafovea
