// Plays the eye and moves the camera.
#include "app/tradeoff_views.h"

#include <algorithm>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <stdexcept>

#include "devices/gaze_recording.h"
#include "devices/simulated/simulated_eye.h"

namespace parafovea {
namespace {

constexpr double kLeastSaccadeDeg = 5;
constexpr Duration kStep = Duration::from_ms(1);
constexpr Duration kSaccadeSpan = Duration::from_ms(20);  // in which that much is covered
constexpr int kFramesBefore = 2;
constexpr float kTurnDegPerSecond = 20;

// Where an eye looks at a time, as far as it is known.
using EyeAt = std::function<std::optional<DirectionDeg>(HostTime)>;

// When the eye first moves far within a short while, looked for from the beginning to an end.
std::optional<HostTime> first_saccade(const EyeAt& eye, HostTime begin, HostTime end) {
    for (HostTime time = begin; time < end; time = time + kStep) {
        const auto before = eye(time), after = eye(time + kSaccadeSpan);
        if (before && after && angle_between_deg(*before, *after) >= kLeastSaccadeDeg) return time;
    }
    return std::nullopt;
}

struct GazePath {
    PointPx eye, drawn;
};

std::vector<GazePath> sampled(const EyeAt& eye, HostTime start, const TradeoffPlan& plan,
                              const ViewGeometry& view) {
    std::vector<GazePath> path;
    DirectionDeg last{}, last_drawn{};  // held through blinks and losses
    for (int f = 0; f < plan.frames; ++f) {
        const HostTime time = start + Duration::from_seconds(f / plan.refresh_hz);
        last = eye(time).value_or(last);
        last_drawn = eye(time - Duration::from_ms(plan.gaze_age_ms)).value_or(last_drawn);
        path.push_back({view.point_from_direction(last), view.point_from_direction(last_drawn)});
    }
    return path;
}

std::vector<GazePath> simulated_path(const TradeoffPlan& plan, const ViewGeometry& view) {
    constexpr Duration kFixation = Duration::from_ms(333);
    const Duration age = Duration::from_ms(plan.gaze_age_ms);
    const HostTime begin = HostTime{} + age + Duration::from_seconds(kFramesBefore / plan.refresh_hz);
    const HostTime end =
        begin + Duration::from_seconds(2) + Duration::from_seconds(plan.frames / plan.refresh_hz);

    // Let the eye live through the whole while first; what is asked for lies in its past.
    std::vector<DirectionDeg> lived;
    SimulatedEye eye(plan.seed, HostTime{});
    Random random(plan.seed + 1);
    HostTime next_target{};
    for (HostTime time{}; time < end + kSaccadeSpan + kStep; time = time + kStep) {
        if (time >= next_target) {
            const PointPx target{view.size.width * random.uniform(0.25, 0.75),
                                 view.size.height * random.uniform(0.25, 0.75)};
            eye.fixate(time, view.direction_from_point(target));
            next_target = time + kFixation;
        }
        lived.push_back(eye.direction(time));
    }
    const EyeAt at = [&](HostTime time) -> std::optional<DirectionDeg> {
        const auto step = static_cast<std::size_t>(std::max<std::int64_t>(time.ns / kStep.ns, 0));
        return lived[std::min(step, lived.size() - 1)];
    };
    const HostTime saccade = first_saccade(at, begin, end).value_or(begin);
    return sampled(at, saccade - Duration::from_seconds(kFramesBefore / plan.refresh_hz), plan, view);
}

std::vector<GazePath> recorded_path(const TradeoffPlan& plan, const ViewGeometry& view) {
    const GazeRecording recording = read_gaze_recording(plan.gaze_recording);
    std::vector<GazeSample> samples;
    std::ranges::copy_if(recording.samples, std::back_inserter(samples), [](const GazeSample& sample) {
        return sample.status == GazeStatus::tracked && sample.direction.has_value();
    });
    if (samples.empty()) throw std::runtime_error(plan.gaze_recording + ": no sample with a gaze");
    const EyeAt at = [&](HostTime time) -> std::optional<DirectionDeg> {
        const auto next = std::ranges::upper_bound(samples, time, {}, &GazeSample::host_time);
        return next == samples.begin() ? samples.front().direction : std::prev(next)->direction;
    };
    const auto saccade = first_saccade(at, samples.front().host_time, samples.back().host_time);
    if (!saccade)
        throw std::runtime_error(
            plan.gaze_recording +
            ": no saccade of 5 degrees; a gaze path needs one, choose another recording");
    return sampled(at, *saccade - Duration::from_seconds(kFramesBefore / plan.refresh_hz), plan, view);
}

PointPx fixed_gaze(const std::string& gaze, SizePx size) {
    if (gaze == "quarter") return {size.width * 0.25, size.height * 0.25};
    if (gaze == "corner") return {0, 0};
    return centre_of(size);
}

SceneCamera moving_camera(const Scene& scene, double time_s) {
    if (!scene.path.empty()) {
        const float begin = scene.path.front().time_s, span = scene.path.back().time_s - begin;
        return camera_on_path(scene, begin + 0.25f * span + static_cast<float>(time_s));
    }
    SceneCamera camera = scene.cameras.front();
    const glm::vec3 place(camera.world_from_camera[3]);
    const float angle = glm::radians(kTurnDegPerSecond) * static_cast<float>(time_s);
    const glm::mat4 turn = glm::translate(glm::mat4(1), place) *
                           glm::rotate(glm::mat4(1), angle, glm::vec3(0, 1, 0)) *
                           glm::translate(glm::mat4(1), -place);
    camera.world_from_camera = turn * camera.world_from_camera;
    return camera;
}

}  // namespace

std::vector<TradeoffFrame> frames_of(const TradeoffPlan& plan, const TradeoffGroup& group,
                                     const Scene& scene) {
    const int count = group.moves() ? plan.frames : 1;
    std::vector<GazePath> path;
    if (group.gaze == "path")
        path =
            plan.gaze_recording.empty() ? simulated_path(plan, group.view) : recorded_path(plan, group.view);
    std::vector<TradeoffFrame> frames;
    for (int f = 0; f < count; ++f) {
        TradeoffFrame frame;
        const SceneCamera camera =
            group.motion == "path" ? moving_camera(scene, f / plan.refresh_hz) : scene.cameras.front();
        frame.view = view_through(camera, group.view);
        if (path.empty())
            frame.gaze = frame.drawn_gaze = fixed_gaze(group.gaze, group.view.size);
        else
            frame.gaze = path[static_cast<std::size_t>(f)].eye,
            frame.drawn_gaze = path[static_cast<std::size_t>(f)].drawn;
        frames.push_back(frame);
    }
    return frames;
}

}  // namespace parafovea
