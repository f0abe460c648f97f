// The extremes of the foveation maps, measured against long double.
#include "tests/renderer/numerics_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "devices/random.h"
#include "renderer/kernel_setting.h"
#include "renderer/methods/grid_plan.h"
#include "tests/renderer/kernel_map_oracle.h"
#include "tests/renderer/worst_device.h"

namespace parafovea {
namespace {

using shared::KernelMap;
using shared::vec2;

std::string text(const char* format, double value) {
    char buffer[48];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

MapBytes bytes_of(const KernelMap& map) {
    static_assert(sizeof(KernelMap) == MapBytes::extent);
    return MapBytes(reinterpret_cast<const std::byte*>(&map), sizeof map);
}

// Both ways through a map, on this processor or on the worst device.
struct Device {
    DevicePoint (*to_buffer)(MapBytes, DevicePoint);
    DevicePoint (*to_screen)(MapBytes, DevicePoint);
};

DevicePoint here_to_buffer(MapBytes bytes, DevicePoint p) {
    KernelMap map{};
    std::memcpy(&map, bytes.data(), bytes.size());
    const vec2 q = buffer_from_screen(map, {static_cast<float>(p.x), static_cast<float>(p.y)});
    return {q.x, q.y};
}
DevicePoint here_to_screen(MapBytes bytes, DevicePoint p) {
    KernelMap map{};
    std::memcpy(&map, bytes.data(), bytes.size());
    const vec2 q = screen_from_buffer(map, {static_cast<float>(p.x), static_cast<float>(p.y)});
    return {q.x, q.y};
}

constexpr Device kHere{here_to_buffer, here_to_screen};
constexpr Device kWorst{worst_buffer_from_screen, worst_screen_from_buffer};
constexpr Device kBuiltIn{built_in_buffer_from_screen, built_in_screen_from_buffer};

struct Case {
    std::string name;
    KernelSetting setting;
};

Case power(double alpha, double sigma = 1.8) {
    return {"x^" + text("%g", alpha), {.sigma = sigma, .alpha = alpha, .betas = {}}};
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const double alpha : {0.0625, 0.25, 1.0, 2.0, 4.0, 6.0, 16.0}) all.push_back(power(alpha));
    for (const double alpha : {0.0625, 4.0, 16.0}) {
        Case printed = power(alpha);
        printed.name += ", as printed";
        printed.setting.as_printed = true;
        all.push_back(printed);
    }
    const auto polynomial = [&](const char* name, std::vector<double> betas) {
        all.push_back({name, {.kind = KernelKind::polynomial, .betas = std::move(betas)}});
    };
    polynomial("0.2 x + 0.3 x^2 + 0.5 x^4", {0.2, 0.3, 0, 0.5});
    polynomial("x^8, level at 0", {0, 0, 0, 0, 0, 0, 0, 1});
    polynomial("3 x - 3 x^2 + x^3, level at 1", {3, -3, 1});
    polynomial("3 x - 6 x^2 + 4 x^3, level at 1/2", {3, -6, 4});
    all.push_back({"sin(x pi / 2)", {.kind = KernelKind::sine, .betas = {}}});
    all.push_back({"(e^x - 1) / (e - 1)", {.kind = KernelKind::exponential, .betas = {}}});
    all.push_back({"linear MAR", {.kind = KernelKind::linear_mar, .betas = {}}});
    all.push_back({"linear MAR, steep, from the gaze",
                   {.kind = KernelKind::linear_mar, .betas = {}, .mar_slope = 200, .mar_start = 0}});
    return all;
}

struct Screen {
    const char* name;
    SizePx size;
    PointPx gaze;
};

const std::array kScreens{Screen{"2560 x 1440, centre", {2560, 1440}, {1280, 720}},
                          Screen{"16384 x 16384, pixel centre", {16384, 16384}, {8192.5, 8192.5}},
                          Screen{"16384 x 16384, corner", {16384, 16384}, {0, 0}}};

// The bound of a round trip: 0.02 px on screens up to 4K, 0.05 px up to 16384 px from the gaze, beyond in
// proportion.
double bound_px(const Screen& screen) {
    if (std::max(screen.size.width, screen.size.height) <= 4096) return 0.02;
    const double farthest = std::hypot(std::max(screen.gaze.x, screen.size.width - screen.gaze.x),
                                       std::max(screen.gaze.y, screen.size.height - screen.gaze.y));
    return 0.05 * std::max(1.0, farthest / 16384);
}

// Places on the screen: random ones, around the gaze at every order of magnitude, on the axes and diagonals,
// corners.
std::vector<DevicePoint> places(const Screen& screen, int count, std::uint64_t seed) {
    const double w = screen.size.width, h = screen.size.height;
    std::vector<DevicePoint> all{{0.5, 0.5}, {w - 0.5, 0.5}, {0.5, h - 0.5}, {w - 0.5, h - 0.5}};
    Random random(seed);
    const auto keep = [&](double x, double y) {
        const DevicePoint p{static_cast<double>(static_cast<float>(x)),
                            static_cast<double>(static_cast<float>(y))};
        if (p.x >= 0 && p.y >= 0 && p.x <= w && p.y <= h) all.push_back(p);
    };
    for (int i = 0; i < count; ++i) {
        keep(std::floor(random.uniform() * w) + 0.5, std::floor(random.uniform() * h) + 0.5);
        const double r = std::exp(random.uniform() * std::log(w)),
                     turn = 2 * std::numbers::pi * random.uniform();
        keep(screen.gaze.x + r * std::cos(turn), screen.gaze.y + r * std::sin(turn));
        if (i % 8 == 0) {
            for (const auto& [x, y] :
                 {std::pair{r, 0.0}, {-r, 0.0}, {0.0, r}, {0.0, -r}, {r, r}, {-r, r}, {r, -r}, {-r, -r}})
                keep(screen.gaze.x + x, screen.gaze.y + y);
        }
    }
    return all;
}

struct Errors {
    double px = 0;      // worst distance on the screen
    double texels = 0;  // worst distance in the buffer, by the oracle
    double ratio = 0;   // worst of the smaller of px / bound and texels / kTexelBound
};
constexpr double kTexelBound = 0.02;

// Screen to buffer to screen. Where the map is level, or a texel is hundreds of pixels, pixels say nothing;
// the distance in the buffer does. A point is good if one of the two is.
Errors round_trip(const Screen& screen, const KernelSetting& setting, const Device& device, int points) {
    const KernelMap map = make_kernel_map(screen.size, screen.gaze, setting);
    const oracle::Map truth{screen.size, screen.gaze, setting};
    Errors errors;
    for (const DevicePoint& p : places(screen, points, 5)) {
        if (std::hypot(p.x - screen.gaze.x, p.y - screen.gaze.y) < 1.5 + static_cast<double>(map.mar_start))
            continue;
        const DevicePoint back = device.to_screen(bytes_of(map), device.to_buffer(bytes_of(map), p));
        const double px = std::hypot(back.x - p.x, back.y - p.y);
        double texels = 0;
        if (px > 1e-4) {
            const oracle::Position a = truth.to_buffer({p.x, p.y}), b = truth.to_buffer({back.x, back.y});
            texels = std::hypot(static_cast<double>(b.x - a.x),
                                static_cast<double>(oracle::wrapped_difference(a.y, b.y, truth.h())));
        }
        errors.px = std::fmax(errors.px, px);
        errors.texels = std::fmax(errors.texels, texels);
        errors.ratio = std::fmax(errors.ratio, std::fmin(px / bound_px(screen), texels / kTexelBound));
        if (!std::isfinite(px))
            errors.px = errors.texels = errors.ratio = std::numeric_limits<double>::infinity();
    }
    return errors;
}

NumericsTable round_trips(std::string title, std::string how, const Device& device, int points) {
    NumericsTable table{std::move(title),
                        std::move(how),
                        {"kernel", "screen, gaze", "worst px", "worst texels", "bound"},
                        {}};
    for (const Screen& screen : kScreens)
        for (const Case& c : cases()) {
            const Errors errors = round_trip(screen, c.setting, device, points);
            table.rows.push_back({c.name,
                                  {screen.name, text("%.2g", errors.px), text("%.2g", errors.texels),
                                   text("%.2g px", bound_px(screen)) + text(" or %g texel", kTexelBound)},
                                  errors.ratio,
                                  1});
        }
    return table;
}

// To half precision and back.
float through_half(float value) {
    if (value == 0 || !std::isfinite(value)) return value;
    int exponent = 0;
    std::frexp(value, &exponent);
    const float unit = std::ldexp(1.0f, std::max(exponent - 11, -24));
    return std::nearbyint(value / unit) * unit;
}

}  // namespace

NumericsTable round_trip_table(int points) {
    return round_trips(
        "Round trip, single precision",
        "A screen position goes to the buffer and back, computed by this processor in single precision.",
        kHere, points);
}

NumericsTable worst_device_table(int points) {
    NumericsTable table = round_trips("Round trip on the worst legal device",
                                      "The same header, every division, square root and built-in function "
                                      "off by all that Vulkan allows, up or down at "
                                      "random (divisions 2.5 units in the last place, square roots 4.5).",
                                      kWorst, points);
    for (const Screen& screen : kScreens) {
        const Errors errors = round_trip(screen, power(4).setting, kBuiltIn, points);
        table.rows.push_back(
            {"x^4, written with the built-in atan, log, pow, exp, cos and sin",
             {screen.name, text("%.2g", errors.px), text("%.2g", errors.texels), "none: for comparison"},
             errors.ratio,
             -1});
    }
    return table;
}

NumericsTable texel_table(int points) {
    NumericsTable table{
        "Position in the buffer",
        "Screen to buffer against long double. An error in ln r of a few units in the last place grows with "
        "alpha and with the buffer's width; the bound is 2e-6 (1 + alpha) of the larger side.",
        {"kernel", "sigma", "screen, gaze", "worst texels here", "worst device", "bound"},
        {}};
    for (const Screen& screen : kScreens)
        for (const double sigma : {1.0, 1.8, 32.0})
            for (const double alpha : {0.0625, 1.0, 4.0, 16.0}) {
                const KernelSetting setting = power(alpha, sigma).setting;
                const KernelMap map = make_kernel_map(screen.size, screen.gaze, setting);
                const oracle::Map truth{screen.size, screen.gaze, setting};
                double worst[2] = {0, 0};
                for (const DevicePoint& p : places(screen, points, 6)) {
                    // Below two pixels small alpha is so steep that the gaze's own rounding decides.
                    if (std::hypot(p.x - screen.gaze.x, p.y - screen.gaze.y) < 2) continue;
                    const oracle::Position wanted = truth.to_buffer({p.x, p.y});
                    for (const auto& [i, device] : {std::pair{0, &kHere}, {1, &kWorst}}) {
                        const DevicePoint found = device->to_buffer(bytes_of(map), p);
                        const double off = std::hypot(
                            found.x - static_cast<double>(wanted.x),
                            static_cast<double>(oracle::wrapped_difference(found.y, wanted.y, truth.h())));
                        worst[i] = std::isfinite(off) ? std::fmax(worst[i], off) : off;
                    }
                }
                const double side = static_cast<double>(std::fmax(truth.w(), truth.h()));
                const double bound = 2e-6 * (1 + alpha) * side;
                table.rows.push_back({"x^" + text("%g", alpha),
                                      {text("%g", sigma), screen.name, text("%.2g", worst[0]),
                                       text("%.2g", worst[1]), text("%.2g", bound)},
                                      std::fmax(worst[0], worst[1]),
                                      bound});
            }
    return table;
}

NumericsTable special_places_table() {
    NumericsTable table{
        "Special places",
        "Worst over every kernel above and both directions, on this processor and on the worst device.",
        {"claim", "worst", "bound"},
        {}};
    double at_gaze = 0, axes = 0, beyond = 0, seam = 0, tiny = 0, far = 0;
    for (const Device* device : {&kHere, &kWorst})
        for (const Case& c : cases()) {
            const Screen screen{"", {1280, 720}, {640.5, 360.5}};
            const KernelMap map = make_kernel_map(screen.size, screen.gaze, c.setting);
            const double w = map.buffer_size.x, h = map.buffer_size.y;
            if (!(c.setting.kind == KernelKind::linear_mar && c.setting.mar_start == 0))
                for (const double r : {0.0, 1e-30, 1e-6, 0.5, 0.999})
                    at_gaze = std::fmax(
                        at_gaze, std::abs(device->to_buffer(bytes_of(map), {640.5 - r, 360.5 + 1e-3 * r}).x));
            for (const double r : {2.0, 100.0, 359.0}) {
                const double quarter[4] = {device->to_buffer(bytes_of(map), {640.5 + r, 360.5}).y,
                                           device->to_buffer(bytes_of(map), {640.5, 360.5 + r}).y,
                                           device->to_buffer(bytes_of(map), {640.5 - r, 360.5}).y,
                                           device->to_buffer(bytes_of(map), {640.5, 360.5 - r}).y};
                for (int i = 0; i < 4; ++i) axes = std::fmax(axes, std::abs(quarter[i] - i * h / 4));
                // A hair above the axis is the buffer's last row, on the axis its first: v lies in [0, h).
                const DevicePoint above = device->to_buffer(bytes_of(map), {640.5 + r, 360.5 - 1e-4});
                seam = std::fmax(seam, above.y >= h || above.y < h * 0.99 ? 1 : 0);
            }
            Random random(9);
            for (int i = 0; i < 200; ++i) {
                const DevicePoint p{random.uniform() * 1280, random.uniform() * 720};
                const DevicePoint b = device->to_buffer(bytes_of(map), p);
                beyond = std::fmax(beyond, std::fmax(std::fmax(-b.x, b.x - w), std::fmax(-b.y, b.y - h)));
                if (!std::isfinite(b.x + b.y)) beyond = std::numeric_limits<double>::infinity();
            }
            // A screen and a buffer of one pixel.
            KernelSetting coarse = c.setting;
            coarse.sigma = 32;
            const KernelMap one = make_kernel_map({1, 1}, {0.5, 0.5}, coarse);
            const DevicePoint back =
                device->to_screen(bytes_of(one), device->to_buffer(bytes_of(one), {0.5, 0.5}));
            tiny = std::fmax(tiny, std::isfinite(back.x + back.y) ? std::hypot(back.x - 0.5, back.y - 0.5)
                                                                  : std::numeric_limits<double>::infinity());
            // A gaze a million pixels away: 1 / 16 px is the last place of its coordinates.
            const KernelMap away = make_kernel_map(screen.size, {1e6, -4e5}, c.setting);
            if (c.setting.kind != KernelKind::sine && c.name.find("level at 1") == std::string::npos) {
                const DevicePoint there =
                    device->to_screen(bytes_of(away), device->to_buffer(bytes_of(away), {100.5, 600.5}));
                const oracle::Map truth{screen.size, {1e6, -4e5}, c.setting};
                far = std::fmax(far, std::hypot(there.x - 100.5, there.y - 600.5));
            }
        }
    const auto add = [&](const char* claim, double worst, double bound, const char* unit) {
        table.rows.push_back({claim, {text("%.2g ", worst) + unit, text("%g ", bound) + unit}, worst, bound});
    };
    add("r < 1 counts as r = 1: column 0 at and around the gaze", at_gaze, 1e-4, "texels");
    add("theta on the four half axes is 0, 1/4, 1/2, 3/4 of the buffer", axes, 1e-3, "texels");
    add("the seam: just above the axis is the last row, never row h itself", seam, 0, "misses");
    add("nothing lies outside the buffer", beyond, 1e-3, "texels");
    add("a screen of one pixel, a buffer of one texel, sigma 32: distance after the round trip", tiny, 2,
        "px");
    add("gaze 1,077,000 px away: distance after the round trip", far, 64, "px");
    return table;
}

NumericsTable half_precision_table() {
    NumericsTable table{"Half precision",
                        "What the position of a pixel in the buffer, u / w and v / h, is worth when it is "
                        "stored as half or as "
                        "16-bit fixed point instead of computed in single precision: for comparison, no "
                        "program path does so.",
                        {"stored as", "kernel", "screen", "worst texels", "worst px"},
                        {}};
    for (const Screen& screen : {kScreens[0], kScreens[1]})
        for (const double alpha : {1.0, 4.0}) {
            const KernelSetting setting = power(alpha).setting;
            const KernelMap map = make_kernel_map(screen.size, screen.gaze, setting);
            const double w = map.buffer_size.x, h = map.buffer_size.y;
            for (const bool half : {true, false}) {
                double texels = 0, px = 0;
                for (const DevicePoint& p : places(screen, 500, 7)) {
                    if (std::hypot(p.x - screen.gaze.x, p.y - screen.gaze.y) < 1.5) continue;
                    const DevicePoint b = kHere.to_buffer(bytes_of(map), p);
                    const auto stored = [&](double share) {
                        const auto value = static_cast<float>(share);
                        return static_cast<double>(half ? through_half(value)
                                                        : std::nearbyint(value * 65535.0f) / 65535.0f);
                    };
                    const DevicePoint kept{stored(b.x / w) * w, stored(b.y / h) * h};
                    texels = std::fmax(texels, std::hypot(kept.x - b.x, kept.y - b.y));
                    const DevicePoint back = kHere.to_screen(bytes_of(map), kept);
                    px = std::fmax(px, std::hypot(back.x - p.x, back.y - p.y));
                }
                table.rows.push_back(
                    {half ? "half" : "16-bit fixed point",
                     {"x^" + text("%g", alpha), screen.name, text("%.2g", texels), text("%.2g", px)},
                     texels,
                     -1});
            }
        }
    return table;
}

NumericsTable axis_maps_table(int points) {
    NumericsTable table{"Rings, rectangular and log-rectilinear maps",
                        "Screen to buffer and back along one axis, and from the gaze to a ring and back; "
                        "the bound is 0.02 px up to 4K, 0.08 px beyond.",
                        {"map", "screen, gaze", "worst px here", "worst device", "bound"},
                        {}};
    for (const Screen& screen : kScreens) {
        const double bound = screen.size.width <= 4096 ? 0.02 : 0.08;
        for (const auto& [name, planner] : std::initializer_list<std::pair<const char*, GridPlanner>>{
                 {"rings", plan_rings}, {"rmfr", plan_rmfr}, {"log_rectilinear", plan_log_rectilinear}}) {
            RenderMethod method{name, {}, {}};
            MethodParameters parameters(method);
            const GridPlan plan = planner(parameters, screen.size, screen.gaze);
            const shared::SampleGrid& grid = plan.grid;
            const std::span<const std::byte, 32> axis(reinterpret_cast<const std::byte*>(&grid.axis_x), 32);
            double worst[2] = {0, 0};
            Random random(11);
            const double reach = std::hypot(screen.size.width, screen.size.height);
            for (int i = 0; i < points; ++i) {
                if (plan.kind == shared::kGridRings) {
                    const auto r = static_cast<float>(grid.start + random.uniform() * (reach - grid.start));
                    const float back = shared::radius_of_ring(grid.slope, grid.start,
                                                              shared::ring_at(grid.slope, grid.start, r));
                    worst[0] = std::fmax(worst[0], std::abs(back - r));
                    worst[1] = std::fmax(
                        worst[1], std::abs(worst_radius_of_ring(grid.slope, grid.start,
                                                                worst_ring_at(grid.slope, grid.start, r)) -
                                           static_cast<double>(r)));
                } else {
                    const auto x = static_cast<float>(random.uniform() * screen.size.width);
                    const float back = shared::axis_to_screen(
                        plan.kind, grid.axis_x, shared::axis_to_buffer(plan.kind, grid.axis_x, x));
                    worst[0] = std::fmax(worst[0], std::abs(back - x));
                    worst[1] = std::fmax(
                        worst[1], std::abs(worst_axis_to_screen(plan.kind, axis,
                                                                worst_axis_to_buffer(plan.kind, axis, x)) -
                                           static_cast<double>(x)));
                }
            }
            table.rows.push_back(
                {name,
                 {screen.name, text("%.2g", worst[0]), text("%.2g", worst[1]), text("%.2g px", bound)},
                 std::fmax(worst[0], worst[1]),
                 bound});
        }
    }
    return table;
}

RandomMapCount random_maps(int configurations, int points) {
    RandomMapCount count;
    count.configurations = configurations;
    Random random(2024);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    for (int i = 0; i < configurations; ++i) {
        KernelSetting setting;
        setting.kind = all_kernel_kinds()[random.below(all_kernel_kinds().size())];
        setting.sigma = std::exp2(random.uniform(0, 5));
        setting.alpha = std::exp2(random.uniform(-4, 4));
        setting.as_printed = setting.kind != KernelKind::linear_mar && random.chance(0.5);
        setting.width_scale = std::exp2(random.uniform(-2, 2));
        setting.height_scale = std::exp2(random.uniform(-2, 2));
        setting.mar_slope = std::exp2(random.uniform(0, 7));
        setting.mar_start = random.uniform(0, 0.4);
        if (setting.kind == KernelKind::polynomial) {
            // Positive coefficients rise; they add up to 1.
            double sum = 0;
            setting.betas.resize(1 + random.below(8));
            for (double& beta : setting.betas) sum += beta = random.chance(0.4) ? 0 : random.uniform();
            if (sum == 0) setting.betas.back() = sum = 1;
            for (double& beta : setting.betas) beta /= sum;
        }
        check(setting);
        const SizePx screen{static_cast<int>(std::exp2(random.uniform(0, 14))),
                            static_cast<int>(std::exp2(random.uniform(0, 14)))};
        PointPx gaze{random.uniform(-0.5, 1.5) * screen.width, random.uniform(-0.5, 1.5) * screen.height};
        switch (random.below(8)) {
            case 0:
                gaze = {std::floor(gaze.x) + 0.5, std::floor(gaze.y) + 0.5};
                break;
            case 1:
                gaze = {random.chance(0.5) ? 0.0 : screen.width, random.chance(0.5) ? 0.0 : screen.height};
                break;
            case 2:
                gaze = {random.uniform(-1e6, 1e6), random.uniform(-1e6, 1e6)};
                break;
            case 3:
                gaze = {random.chance(0.5) ? nan : infinity, random.chance(0.5) ? -infinity : gaze.y};
                break;
            default:
                break;
        }
        const KernelMap map = make_kernel_map(screen, gaze, setting);
        for (int j = 0; j < points; ++j) {
            DevicePoint p{random.uniform() * screen.width, random.uniform() * screen.height};
            if (j == 0) p = {map.gaze.x, map.gaze.y};
            if (j == 1) p = {0.5, 0.5};
            for (const auto& [device, bad] :
                 {std::pair{&kHere, &count.bad_here}, std::pair{&kWorst, &count.bad_on_worst}}) {
                const DevicePoint b = device->to_buffer(bytes_of(map), p);
                const DevicePoint back = device->to_screen(bytes_of(map), b);
                const double slack = 1e-3 + 1e-5 * static_cast<double>(map.buffer_size.x + map.buffer_size.y);
                if (std::isfinite(b.x + b.y + back.x + back.y) && b.x >= 0 && b.y >= 0 &&
                    b.x <= map.buffer_size.x + slack && b.y <= map.buffer_size.y + slack)
                    continue;
                if (count.bad_here + count.bad_on_worst == 0)
                    count.first_bad = std::string(name_of(setting.kind)) + text(" alpha %g", setting.alpha) +
                                      text(" sigma %g", setting.sigma) +
                                      (setting.as_printed ? " as printed" : "") +
                                      text(", screen %g", screen.width) + text(" x %g", screen.height) +
                                      text(", gaze %g", gaze.x) + text(", %g", gaze.y) +
                                      text(", at %g", p.x) + text(", %g", p.y) + text(": %g", b.x) +
                                      text(", %g", b.y) + text(" -> %g", back.x) + text(", %g", back.y);
                ++*bad;
            }
        }
    }
    return count;
}

}  // namespace parafovea
