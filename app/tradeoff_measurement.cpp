// Draws every method of a group in turns, then judges their pictures.
#include "app/tradeoff_measurement.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>

#include "analysis/number_text.h"
#include "analysis/parallel.h"
#include "renderer/scene_catalog.h"
#include "renderer/temporal_view.h"

namespace parafovea {
namespace {

constexpr int kJudgementWork = 4;  // frames drawn in the time of one frame judged

double quantile(std::vector<double> values, double share) {
    assert(!values.empty());
    std::ranges::sort(values);
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    return std::lerp(values[below], values[std::min(below + 1, values.size() - 1)], at - std::floor(at));
}

// The i-th number of the van der Corput sequence in a base, from 0 to 1.
double radical_inverse(int i, int base) {
    double result = 0, digit = 1.0 / base;
    for (; i > 0; i /= base, digit /= base) result += digit * (i % base);
    return result;
}

const std::array<float, 256>& linear_from_srgb() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double v = static_cast<double>(i) / 255;
            values[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return table;
}

std::uint8_t srgb_from_linear(double v) {
    const double encoded = v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(std::clamp(encoded, 0.0, 1.0) * 255));
}

// What one method showed and cost in a group.
struct Taken {
    std::vector<double> frame_ms;
    std::vector<FrameStatistics> frames;
    std::vector<Image> pictures;
    double shaded_samples = 0;  // mean over the pictures kept
};

void write_cost(const Taken& taken, const Taken& full, TradeoffRow& row) {
    row.frame_ms = quantile(taken.frame_ms, 0.5);
    row.frame_ms_low = quantile(taken.frame_ms, 0.25);
    row.frame_ms_high = quantile(taken.frame_ms, 0.75);
    row.full_frame_ms = quantile(full.frame_ms, 0.5);
    row.shaded_samples = static_cast<std::uint64_t>(std::llround(taken.shaded_samples));
    for (const PassTimer::Pass& pass : taken.frames.back().passes) {
        std::vector<double> times;
        for (const FrameStatistics& frame : taken.frames) times.push_back(frame.pass_ms(pass.name));
        const double median = quantile(times, 0.5);
        row.passes_ms += (row.passes_ms.empty() ? "" : " ") + pass.name + "=" + fixed_text(median, 3);
        if (pass.name == "pass_1") row.shading_ms = median;
    }
}

std::string memory_key(const TradeoffMethod& method) {
    return method.method.name + " " + setting_text(method.method);
}

}  // namespace

// A scene on a display, ready to be drawn.
struct TradeoffMeasurement::Stage {
    Stage(Gpu& gpu, const std::string& name, const ViewGeometry& geometry)
        : scene_name(name), view(geometry), scene(load_scene(name)), renderer(gpu, scene) {}

    std::string scene_name;
    ViewGeometry view;
    Scene scene;
    FrameRenderer renderer;
    std::map<std::string, std::uint64_t> memory_bytes;  // by setting: what drawing with it first allocated
    std::uint64_t full_bytes = 0;                       // the scene and full resolution
    Image still_reference;  // super-sampled, from the first camera; empty until asked for
};

TradeoffMeasurement::TradeoffMeasurement(Gpu& gpu, const TradeoffPlan& plan) : gpu_(gpu), plan_(plan) {}

TradeoffMeasurement::~TradeoffMeasurement() = default;

int work_of(const TradeoffPlan& plan, const TradeoffGroup& group, std::size_t methods) {
    const int count = static_cast<int>(methods);
    if (!group.moves()) return count * (2 + plan.rounds + kJudgementWork) + plan.reference_samples;
    const int samples = group.motion == "path" ? std::max(plan.reference_samples / 4, 1) * plan.frames
                                               : plan.reference_samples;
    return count * (1 + plan.frames * (1 + kJudgementWork)) + samples;
}

TradeoffMeasurement::Stage& TradeoffMeasurement::stage_for(const TradeoffGroup& group) {
    const bool same = stage_ && stage_->scene_name == group.scene && stage_->view.size == group.view.size &&
                      stage_->view.horizontal_fov_deg == group.view.horizontal_fov_deg;
    if (!same) {
        stage_.reset();
        stage_ = std::make_unique<Stage>(gpu_, group.scene, group.view);
    }
    return *stage_;
}

// Jittered pictures averaged in linear light.
Image TradeoffMeasurement::super_sampled(Stage& stage, const TradeoffGroup& group, const CameraView& view,
                                         int samples, const TradeoffListener& listener) {
    const bool still = group.motion == "still";
    if (still && !stage.still_reference.rgba.empty()) return stage.still_reference;
    std::vector<float> sum;
    Image image;
    for (int s = 0; s < samples; ++s) {
        CameraView jittered = view;
        jittered.jitter_px = {radical_inverse(s + 1, 2) - 0.5, radical_inverse(s + 1, 3) - 0.5};
        image = stage.renderer.render(group.view.size, jittered, {}, centre_of(group.view.size)).image;
        sum.resize(image.rgba.size());
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += linear_from_srgb()[image.rgba[i]];
        if (!still) listener.worked(1, "reference");
    }
    for (std::size_t i = 0; i < sum.size(); ++i) image.rgba[i] = srgb_from_linear(sum[i] / samples);
    if (still) stage.still_reference = image;
    return image;
}

void TradeoffMeasurement::measure(const TradeoffGroup& group, const std::vector<TradeoffMethod>& methods,
                                  const TradeoffListener& listener) {
    using Clock = std::chrono::steady_clock;
    assert(!methods.empty() && methods.front().method.name == "full");
    Stage& stage = stage_for(group);
    const std::vector<TradeoffFrame> frames = frames_of(plan_, group, stage.scene);
    const SizePx size = group.view.size;
    std::vector<Taken> taken(methods.size());
    const auto saying = [&](std::size_t m) {
        return group.scene + " " + std::to_string(size.width) + "x" + std::to_string(size.height) + " " +
               group.gaze + " " + group.motion + " " + methods[m].family;
    };

    // Draw everything once: pipelines are built, buffers are made.
    std::vector<std::unique_ptr<MovingView>> running;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        const std::uint64_t before = gpu_.allocated_bytes();
        running.push_back(std::make_unique<MovingView>(stage.renderer));
        running[m]->render(size, frames.front().view, methods[m].method, frames.front().drawn_gaze, false);
        running[m]->cut();
        const std::uint64_t after = gpu_.allocated_bytes();
        if (m == 0 && stage.full_bytes == 0) stage.full_bytes = after;
        stage.memory_bytes.try_emplace(memory_key(methods[m]), m > 0 && after > before ? after - before : 0);
        listener.worked(1, saying(m));
    }

    // Draw, time and keep: a still picture in rounds, what moves frame by frame.
    const auto draw = [&](std::size_t m, const CameraView& view, PointPx gaze) {
        const Clock::time_point start = Clock::now();
        const RenderedFrame frame = running[m]->render(size, view, methods[m].method, gaze, false);
        taken[m].frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        taken[m].frames.push_back(frame.statistics);
        listener.worked(1, saying(m));
    };
    if (frames.size() == 1) {
        for (int round = 0; round < plan_.rounds; ++round)
            for (std::size_t m = 0; m < methods.size(); ++m) {
                PointPx gaze = frames.front().drawn_gaze;
                gaze.x += (round % 2 == 0 ? 1 : -1) * (1 + round / 2);
                draw(m, frames.front().view, gaze);
            }
        for (std::size_t m = 0; m < methods.size(); ++m) {
            const CameraView& view = frames.front().view;
            const PointPx gaze = frames.front().drawn_gaze;
            taken[m].pictures.push_back(stage.renderer.render(size, view, methods[m].method, gaze).image);
            taken[m].shaded_samples = static_cast<double>(
                running[m]->render(size, view, methods[m].method, gaze, false).statistics.shaded_samples);
            listener.worked(1, saying(m));
        }
    } else {
        for (const TradeoffFrame& frame : frames)
            for (std::size_t m = 0; m < methods.size(); ++m) {
                draw(m, frame.view, frame.drawn_gaze);
                taken[m].shaded_samples += static_cast<double>(taken[m].frames.back().shaded_samples) /
                                           static_cast<double>(frames.size());
                const std::vector<std::byte> bytes =
                    read_back(gpu_, stage.renderer.target(), kUseColorTarget);
                Image& picture = taken[m].pictures.emplace_back();
                picture.size = size;
                picture.rgba.resize(bytes.size());
                std::memcpy(picture.rgba.data(), bytes.data(), bytes.size());
            }
    }
    running.clear();

    TradeoffReference reference;
    reference.display = {size.width, size.height, group.view.horizontal_fov_deg, plan_.peak_cd_m2, 1000, 0};
    reference.refresh_hz = plan_.refresh_hz;
    const int samples =
        group.motion == "path" ? std::max(plan_.reference_samples / 4, 1) : plan_.reference_samples;
    for (const TradeoffFrame& frame : frames) {
        reference.gazes.push_back({frame.gaze.x, frame.gaze.y});
        reference.super_sampled.push_back(super_sampled(stage, group, frame.view, samples, listener));
    }
    if (group.motion == "still") listener.worked(samples, "reference");
    reference.full = taken.front().pictures;
    prepare(reference);

    std::mutex mutex;
    parallel_for(methods.size(), [&](std::size_t m) {
        TradeoffRow row = empty_row(plan_, group, methods[m]);
        for (const GazePx& gaze : reference.gazes) {
            row.gaze_x += gaze.x / static_cast<double>(frames.size());
            row.gaze_y += gaze.y / static_cast<double>(frames.size());
        }
        write_cost(taken[m], taken.front(), row);
        row.memory_bytes = stage.full_bytes + stage.memory_bytes.at(memory_key(methods[m]));
        judge(reference, taken[m].pictures, row);
        taken[m].pictures = {};
        const std::scoped_lock lock(mutex);
        listener.measured(row);
        listener.worked(kJudgementWork * static_cast<int>(frames.size()), "judging");
    });
}

}  // namespace parafovea
