// Reads the classic log-polar method's parameters.
#include "renderer/methods/log_polar_method.h"

#include "renderer/methods/method_parameters.h"

namespace parafovea {

KfrSetting log_polar_setting(const RenderMethod& method) {
    MethodParameters parameters(method);
    KfrSetting setting;
    setting.kernel.alpha = 1;
    setting.kernel.sigma = parameters.number("sigma", setting.kernel.sigma);
    check(setting.kernel);
    setting.culling = parameters.flag("culling", true);
    setting.internal_filter = false;
    parameters.check_all_taken();
    return setting;
}

}  // namespace parafovea
