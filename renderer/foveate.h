// The kernel log-polar map applied to a picture: reduced and stretched again, as kernel foveated rendering
// does it.
#pragma once

#include "renderer/gpu.h"
#include "renderer/image.h"
#include "renderer/kernel_setting.h"

namespace parafovea {

struct FoveateOptions {
    bool internal_filter = true;  // 3x3 Gaussian over the peripheral half of the buffer
    bool post_filter = false;     // Eq. 14
};

// The stored 8-bit values are interpolated as they are (no decoding), in floats, and rounded to nearest at
// the end. The result is opaque. `gaze` in pixels, anywhere; see make_kernel_map. Throws std::runtime_error
// if the setting is out of range or the picture larger than the device allows.
Image foveate(Gpu& gpu, const Image& picture, const KernelSetting& setting, PointPx gaze,
              const FoveateOptions& options = {});

}  // namespace parafovea
