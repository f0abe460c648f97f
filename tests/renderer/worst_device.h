// The maps as the least accurate device that Vulkan allows would compute them.
#pragma once

#include <cstddef>
#include <span>

namespace parafovea {

struct DevicePoint {
    double x = 0, y = 0;
};

// The bytes of a shared::KernelMap.
using MapBytes = std::span<const std::byte, 112>;

// renderer/shared/kernel_map.h, unchanged, on that device.
DevicePoint worst_buffer_from_screen(MapBytes map, DevicePoint position);
DevicePoint worst_screen_from_buffer(MapBytes map, DevicePoint position);

// The power kernel in the author orientation written with GLSL's own atan, log, pow, exp, cos and sin, on
// that device.
DevicePoint built_in_buffer_from_screen(MapBytes map, DevicePoint position);
DevicePoint built_in_screen_from_buffer(MapBytes map, DevicePoint position);

// renderer/shared/sample_grid.h: the rings' map, and one axis of the grids that have a map for each axis.
// `axis` holds the bytes of a shared::GridAxis.
double worst_ring_at(double slope, double start, double distance_px);
double worst_radius_of_ring(double slope, double start, double ring);
double worst_axis_to_buffer(unsigned kind, std::span<const std::byte, 32> axis, double position);
double worst_axis_to_screen(unsigned kind, std::span<const std::byte, 32> axis, double texel);

}  // namespace parafovea
