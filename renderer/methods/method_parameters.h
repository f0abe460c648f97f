// Reads a method's parameters: each is taken once, and what nobody took is an error.
#pragma once

#include <optional>
#include <string>

#include "renderer/kernel_setting.h"
#include "renderer/methods/foveation_method.h"

namespace parafovea {

class MethodParameters {
  public:
    explicit MethodParameters(const RenderMethod& method) : method_(method), left_(method) {}

    double number(const std::string& name, double otherwise);
    // In [low, high], or std::runtime_error.
    double number(const std::string& name, double otherwise, double low, double high);
    bool flag(const std::string& name, bool otherwise);  // 0 or 1
    std::optional<std::string> word(const std::string& name);

    // sigma, alpha, kernel, beta_1 to beta_8, as_printed; checked.
    KernelSetting kernel();

    // Throws std::runtime_error that names a parameter which no call above asked for.
    void check_all_taken() const;

  private:
    const RenderMethod& method_;
    RenderMethod left_;
};

}  // namespace parafovea
