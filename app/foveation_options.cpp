// The foveation options of the command line.
#include "app/commands.h"

namespace parafovea {

void FoveationOptions::add_to(CLI::App& command) {
    command.add_option("--sigma", sigma, "Screen size over buffer size, along each side")->capture_default_str();
    command.add_option("--alpha", alpha, "Exponent of the power kernel")->capture_default_str();
    command.add_option("--kernel", kernel, "power, polynomial, sine or exponential")->capture_default_str();
    command.add_option("--beta", betas, "Coefficients of the polynomial kernel, adding up to 1")->delimiter(',');
    command.add_option("--gaze", gaze, "X,Y in pixels from the top left corner; the centre when absent");
    command.add_flag("--as-printed", as_printed, "The direction of Eq. 10 instead of the one the paper's figures show");
}

}  // namespace parafovea
