// Looks up what a frame cost.
#include "renderer/frame_statistics.h"

#include <sys/resource.h>

#include <algorithm>

namespace parafovea {

double FrameStatistics::pass_ms(const std::string& name) const {
    const auto found = std::ranges::find(passes, name, &PassTimer::Pass::name);
    return found == passes.end() ? 0 : found->ms;
}

std::uint64_t peak_host_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in kibibytes
}

}  // namespace parafovea
