// The classic log-polar map (Araujo and Dias 1996; Antonelli et al. 2015): kernel foveated rendering without
// its kernel and its filters.
#pragma once

#include "renderer/methods/kfr_method.h"

namespace parafovea {

// Parameters: sigma, culling.
KfrSetting log_polar_setting(const RenderMethod& method);

class LogPolarMethod : public KfrMethod {
  public:
    using KfrMethod::KfrMethod;
    void configure(const RenderMethod& method) override { KfrMethod::configure(log_polar_setting(method)); }
};

}  // namespace parafovea
