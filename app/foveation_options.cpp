// The foveation options of the command line.
#include "app/commands.h"
#include "app/options.h"
#include "renderer/methods/foveation_method.h"

namespace parafovea {

void FoveationOptions::add_to(CLI::App& command) {
    command.add_option("--sigma", sigma, "Screen size over buffer size, along each side (1.8)");
    command.add_option("--alpha", alpha, "Exponent of the power kernel (4)");
    command.add_option("--kernel", kernel,
                       "power (the default), polynomial, sine, exponential or linear_mar");
    command.add_option("--beta", betas, "Coefficients of the polynomial kernel, adding up to 1")
        ->delimiter(',');
    command.add_option("--gaze", gaze, "X,Y in pixels from the top left corner; the centre when absent");
    command.add_flag("--as-printed", as_printed,
                     "The direction of Eq. 10 instead of the one the paper's figures show");
}

KernelSetting FoveationOptions::kernel_setting() const {
    KernelSetting setting;
    if (kernel) setting.kind = kernel_kind_from_name(*kernel);
    setting.sigma = sigma.value_or(setting.sigma);
    setting.alpha = alpha.value_or(setting.alpha);
    setting.betas = betas;
    setting.as_printed = as_printed;
    check(setting);
    return setting;
}

void FoveationOptions::add_to(RenderMethod& method) const {
    if (sigma) method.numbers["sigma"] = *sigma;
    if (alpha) method.numbers["alpha"] = *alpha;
    if (kernel) method.words["kernel"] = *kernel;
    for (std::size_t i = 0; i < betas.size(); ++i) method.numbers["beta_" + std::to_string(i + 1)] = betas[i];
    if (as_printed) method.numbers["as_printed"] = 1;
}

PointPx FoveationOptions::gaze_on(SizePx size) const {
    return gaze.empty() ? centre_of(size) : parse_point(gaze);
}

}  // namespace parafovea
