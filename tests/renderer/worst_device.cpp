// The maps as the least accurate device that Vulkan allows would compute them.
#include "tests/renderer/worst_device.h"

#include <cstring>

#include "tests/renderer/worst_device_bridge.h"
// Every float of the shared headers is one of that device.
#define float DeviceFloat
#include "renderer/shared/kernel_map.h"
#include "renderer/shared/sample_grid.h"
#undef float

namespace parafovea {
namespace {

using shared::DeviceFloat;
using shared::vec2;

shared::KernelMap map_of(MapBytes bytes) {
    static_assert(sizeof(shared::KernelMap) == MapBytes::extent);
    shared::KernelMap map{};
    std::memcpy(static_cast<void*>(&map), bytes.data(), bytes.size());
    return map;
}

shared::GridAxis axis_of(std::span<const std::byte, 32> bytes) {
    static_assert(sizeof(shared::GridAxis) == 32);
    shared::GridAxis axis{};
    std::memcpy(static_cast<void*>(&axis), bytes.data(), bytes.size());
    return axis;
}

DeviceFloat number(double value) {
    return {static_cast<float>(value)};
}
DevicePoint point(vec2 v) {
    return {v.x.value, v.y.value};
}

constexpr float kTwoPi = 6.28318531f;

}  // namespace

DevicePoint worst_buffer_from_screen(MapBytes map, DevicePoint position) {
    return point(buffer_from_screen(map_of(map), vec2(number(position.x), number(position.y))));
}

DevicePoint worst_screen_from_buffer(MapBytes map, DevicePoint position) {
    return point(screen_from_buffer(map_of(map), vec2(number(position.x), number(position.y))));
}

DevicePoint built_in_buffer_from_screen(MapBytes bytes, DevicePoint position) {
    const shared::KernelMap map = map_of(bytes);
    const float x = static_cast<float>(position.x) - map.gaze.x.value;
    const float y = static_cast<float>(position.y) - map.gaze.y.value;
    const DeviceFloat radius = shared::sqrt(number(x * x + y * y));
    const DeviceFloat u = shared::pow(shared::log(radius) / map.log_max_radius, map.alpha);
    float angle = shared::worst_atan2(y, x);
    if (angle < 0) angle += kTwoPi;
    return {(u * map.buffer_size.x).value, (number(angle) / number(kTwoPi) * map.buffer_size.y).value};
}

DevicePoint built_in_screen_from_buffer(MapBytes bytes, DevicePoint position) {
    const shared::KernelMap map = map_of(bytes);
    const DeviceFloat x =
        shared::pow(number(position.x) / map.buffer_size.x, number(1) / map.alpha) * map.log_max_radius;
    const float radius = shared::exp(x).value;
    float angle = (number(position.y) / map.buffer_size.y).value * kTwoPi;
    if (angle > kTwoPi / 2) angle -= kTwoPi;
    return {map.gaze.x.value + radius * shared::worst_cosine(angle),
            map.gaze.y.value + radius * shared::worst_sine(angle)};
}

double worst_ring_at(double slope, double start, double distance_px) {
    return shared::ring_at(number(slope), number(start), number(distance_px)).value;
}

double worst_radius_of_ring(double slope, double start, double ring) {
    return shared::radius_of_ring(number(slope), number(start), number(ring)).value;
}

double worst_axis_to_buffer(unsigned kind, std::span<const std::byte, 32> axis, double position) {
    return shared::axis_to_buffer(kind, axis_of(axis), number(position)).value;
}

double worst_axis_to_screen(unsigned kind, std::span<const std::byte, 32> axis, double texel) {
    return shared::axis_to_screen(kind, axis_of(axis), number(texel)).value;
}

}  // namespace parafovea
