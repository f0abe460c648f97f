// Looks up what a frame cost.
#include "renderer/frame_statistics.h"

#include <algorithm>

namespace parafovea {

double FrameStatistics::pass_ms(const std::string& name) const {
    const auto found = std::ranges::find(passes, name, &PassTimer::Pass::name);
    return found == passes.end() ? 0 : found->ms;
}

}  // namespace parafovea
