// Draws and times the frames of a benchmark.
#include "renderer/benchmark_run.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <utility>

#include "renderer/scene_catalog.h"

namespace parafovea {
namespace {

// The value below which a share of the (unsorted) values lies, interpolated.
double quantile(std::vector<double> values, double share) {
    assert(!values.empty());
    std::ranges::sort(values);
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], at - std::floor(at));
}

// A faster method is drawn up to so many times in its turn, until it took as long as full resolution: a few
// short frames meet whatever clock they meet, while a long one has the mean over its own time.
constexpr double kMostInOneTurn = 4;

struct Measured {
    std::vector<double> frame_ms;
    std::vector<double> round_ms;  // mean of the frames of each round
    std::vector<FrameStatistics> frames;
    int drawn = 0;
    int in_one_turn = 1;
};

// Near the centre; a different pixel each time if it moves.
PointPx gaze_of_frame(SizePx size, int frame, bool moving) {
    PointPx gaze = centre_of(size);
    if (moving) gaze.x += (frame % 2 == 0 ? 1 : -1) * (1 + frame / 2);
    return gaze;
}

struct TimedFrame {
    double ms = 0;  // from the call to the finished picture, not read back
    FrameStatistics statistics;
};

TimedFrame timed_frame(FrameRenderer& renderer, SizePx size, const CameraView& view,
                       const RenderMethod& method, PointPx gaze) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    FrameStatistics statistics = renderer.render(size, view, method, gaze, false).statistics;
    return {std::chrono::duration<double, std::milli>(Clock::now() - start).count(), std::move(statistics)};
}

BenchmarkRow row_of(const Measured& measured, const Measured& full) {
    BenchmarkRow row;
    std::vector<double> speedups;
    for (std::size_t round = 0; round < measured.round_ms.size(); ++round)
        speedups.push_back(full.round_ms[round] / measured.round_ms[round]);
    row.speedup = quantile(std::move(speedups), 0.5);
    row.frame_ms = quantile(measured.frame_ms, 0.5);
    row.frame_ms_low = quantile(measured.frame_ms, 0.25);
    row.frame_ms_high = quantile(measured.frame_ms, 0.75);
    const FrameStatistics& last = measured.frames.back();
    row.shaded_samples = last.shaded_samples;
    row.device_memory_bytes = last.device_memory_bytes;
    for (const PassTimer::Pass& pass : last.passes) {
        std::vector<double> times;
        for (const FrameStatistics& frame : measured.frames) times.push_back(frame.pass_ms(pass.name));
        row.passes.push_back({pass.name, quantile(times, 0.5)});
        if (pass.name == "pass_1") row.shading_ms = row.passes.back().ms;
    }
    return row;
}

}  // namespace

std::vector<BenchmarkMethod> standard_benchmark_methods() {
    return {
        {"KFR as published", {"kfr", {{"sigma", 1.8}, {"alpha", 4}, {"culling", 0}}, {}}},
        {"KFR", {"kfr", {{"sigma", 1.8}, {"alpha", 4}}, {}}},
        {"KFR and inset", {"kfr", {{"sigma", 1.8}, {"alpha", 4}, {"inset", 0.13}}, {}}},
        {"KFR reshaped and inset",
         {"kfr",
          {{"sigma", 1.8}, {"alpha", 4}, {"width_scale", 0.28}, {"height_scale", 1.25}, {"inset", 0.09}},
          {}}},
        {"linear MAR and inset",
         {"kfr",
          {{"sigma", 1.8},
           {"width_scale", 0.267},
           {"height_scale", 1.375},
           {"mar_slope", 8},
           {"mar_start", 0.07}},
          {{"kernel", "linear_mar"}}}},
        // No worse than KFR at 100 degrees: the first in PSNR and FovVideoVDP's JOD of the whole picture
        // (`primitives` 7.59 against 7.57, `street` 7.21 against 7.08), the second in those of every zone of
        // eccentricity, too.
        {"equal visibility",
         {"kfr",
          {{"sigma", 1.8},
           {"width_scale", 0.267},
           {"height_scale", 1.375},
           {"mar_slope", 8},
           {"mar_start", 0.07},
           {"internal_filter", 0}},
          {{"kernel", "linear_mar"}}}},
        {"equal in every zone",
         {"kfr",
          {{"sigma", 1.8},
           {"width_scale", 0.36},
           {"height_scale", 1.4},
           {"mar_slope", 4.5},
           {"mar_start", 0.14},
           {"internal_filter", 0}},
          {{"kernel", "linear_mar"}}}},
        {"rings", {"rings", {}, {}}},
    };
}

std::vector<BenchmarkRow> run_benchmark(Gpu& gpu, const BenchmarkPlan& plan,
                                        const std::function<void(double, const std::string&)>& progress) {
    assert(plan.warm_up_rounds >= 1 && plan.rounds >= 1);
    std::vector<BenchmarkMethod> methods{{"full resolution", {}}};
    methods.insert(methods.end(), plan.methods.begin(), plan.methods.end());
    const int rounds = plan.warm_up_rounds + plan.rounds;
    const double turns =
        static_cast<double>(plan.scenes.size() * plan.sizes.size() * methods.size()) * rounds;
    double taken = 0;

    std::vector<BenchmarkRow> rows;
    for (const std::string& scene_name : plan.scenes) {
        const Scene scene = load_scene(scene_name);
        FrameRenderer renderer(gpu, scene, plan.options);
        for (const SizePx size : plan.sizes) {
            const CameraView view = view_through(scene.cameras.front(), size);
            std::vector<Measured> measured(methods.size());
            for (int round = 0; round < rounds; ++round) {
                double full_ms = 0;
                for (std::size_t m = 0; m < methods.size(); ++m) {
                    if (progress) {
                        progress(taken / turns, scene_name + " " + std::to_string(size.width) + "x" +
                                                    std::to_string(size.height) + " " + methods[m].label);
                    }
                    Measured& method = measured[m];
                    double ms = 0, turn_ms = 0;
                    for (int i = 0; i < method.in_one_turn; ++i) {
                        const PointPx gaze = gaze_of_frame(size, method.drawn++, plan.moving_gaze);
                        TimedFrame frame = timed_frame(renderer, size, view, methods[m].method, gaze);
                        ms = frame.ms;
                        turn_ms += ms;
                        if (round < plan.warm_up_rounds) continue;
                        method.frame_ms.push_back(ms);
                        method.frames.push_back(std::move(frame.statistics));
                    }
                    if (round >= plan.warm_up_rounds) method.round_ms.push_back(turn_ms / method.in_one_turn);
                    if (m == 0) full_ms = ms;
                    method.in_one_turn =
                        static_cast<int>(std::clamp(std::round(full_ms / ms), 1.0, kMostInOneTurn));
                    taken += 1;
                }
            }
            for (std::size_t m = 0; m < methods.size(); ++m) {
                BenchmarkRow row = row_of(measured[m], measured.front());
                row.scene = scene_name;
                row.size = size;
                row.method = methods[m];
                rows.push_back(std::move(row));
            }
        }
    }
    if (progress) progress(1, "done");
    return rows;
}

std::vector<NeedsRow> measure_needs(Gpu& gpu, const BenchmarkPlan& plan,
                                    const std::function<void(double, const std::string&)>& progress) {
    assert(plan.warm_up_rounds >= 1 && plan.rounds >= 1 && !plan.sizes.empty());
    std::vector<NeedsRow> rows;
    for (const std::string& scene_name : plan.scenes) {
        const Scene scene = load_scene(scene_name);
        ScenePassOptions forced = plan.options, needed = plan.options, still = plan.options;
        forced.force_everything = true;
        forced.keep_geometry = needed.keep_geometry = false;
        still.keep_geometry = true;
        // One after the other, so that only one is resident; medians of as many frames each.
        NeedsRow row{scene_name, plan.sizes.front(), 0, 0, 0, {}};
        const CameraView view = view_through(scene.cameras.front(), row.size);
        const auto median_ms = [&](const ScenePassOptions& options, const char* what) {
            if (progress) {
                progress(static_cast<double>(rows.size()) / static_cast<double>(plan.scenes.size()),
                         scene_name + ", " + what);
            }
            FrameRenderer renderer(gpu, scene, options);
            std::vector<double> frame_ms;
            for (int round = 0; round < plan.warm_up_rounds + plan.rounds; ++round) {
                TimedFrame frame = timed_frame(renderer, row.size, view, RenderMethod{}, centre_of(row.size));
                if (round >= plan.warm_up_rounds) frame_ms.push_back(frame.ms);
                row.left_out = std::move(frame.statistics.left_out);
            }
            return quantile(frame_ms, 0.5);
        };
        row.forced_ms = median_ms(forced, "everything built");
        row.needed_ms = median_ms(needed, "what it needs");
        row.still_ms = median_ms(still, "what it needs, still");
        rows.push_back(row);
    }
    if (progress) progress(1, "done");
    return rows;
}

}  // namespace parafovea
