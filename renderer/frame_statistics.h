// What a frame cost and what was built for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/gpu_pipeline.h"
#include "renderer/scene_passes.h"

namespace parafovea {

struct FrameStatistics {
    SizePx size;
    SizePx buffer;  // the reduced buffer; the screen itself for full resolution
    std::uint64_t screen_pixels = 0;
    std::uint64_t shaded_samples = 0;
    // Device time by pass, in order: shadow, depth, defer, pass_1, pass_2, post (what was not built is
    // absent), total. Empty if the device has no clock.
    std::vector<PassTimer::Pass> passes;
    std::uint64_t triangles = 0;  // in view
    std::string device;
    std::string driver;
    std::uint64_t device_memory_bytes = 0;       // allocated now
    std::uint64_t peak_device_memory_bytes = 0;  // the most there ever was
    std::vector<FeatureNote> built;
    std::vector<FeatureNote> left_out;

    // Milliseconds of a pass; 0 if it was not built.
    double pass_ms(const std::string& name) const;
};

// The most memory that this process has had resident, bytes.
std::uint64_t peak_host_memory_bytes();

}  // namespace parafovea
