// The foveation options of the command line.
#include "app/commands.h"
#include "app/options.h"

namespace parafovea {

void FoveationOptions::add_to(CLI::App& command) {
    command.add_option("--sigma", sigma, "Screen size over buffer size, along each side")
        ->capture_default_str();
    command.add_option("--alpha", alpha, "Exponent of the power kernel")->capture_default_str();
    command.add_option("--kernel", kernel, "power, polynomial, sine or exponential")->capture_default_str();
    command.add_option("--beta", betas, "Coefficients of the polynomial kernel, adding up to 1")
        ->delimiter(',');
    command.add_option("--gaze", gaze, "X,Y in pixels from the top left corner; the centre when absent");
    command.add_flag("--as-printed", as_printed,
                     "The direction of Eq. 10 instead of the one the paper's figures show");
}

KernelSetting FoveationOptions::kernel_setting() const {
    KernelSetting setting;
    setting.kind = kernel_kind_from_name(kernel);
    setting.sigma = sigma;
    setting.alpha = alpha;
    setting.betas = betas;
    setting.as_printed = as_printed;
    check(setting);
    return setting;
}

PointPx FoveationOptions::gaze_on(SizePx size) const {
    return gaze.empty() ? centre_of(size) : parse_point(gaze);
}

}  // namespace parafovea
