// How well gaze and timing were recorded, counted while sessions stream past.
#include "app/session_quality.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace parafovea {

namespace {

constexpr std::size_t kMostBins = 10'000;  // of frame intervals: whatever is longer counts in the last

bool shows_picture(Phase phase) {
    return phase == Phase::first_interval || phase == Phase::second_interval;
}

std::optional<double> median_precision(const CalibrationRecord& calibration) {
    std::vector<double> targets;
    for (const CalibrationPoint& point : calibration.points)
        if (point.precision_rms_deg) targets.push_back(*point.precision_rms_deg);
    if (targets.empty()) return std::nullopt;
    std::sort(targets.begin(), targets.end());
    const std::size_t n = targets.size();
    return 0.5 * (targets[(n - 1) / 2] + targets[n / 2]);
}

}  // namespace

RecordingCount::RecordingCount() {
    map_.columns = map_.rows = 60;
    map_.width_deg = map_.height_deg = 30;
    map_.counts.assign(static_cast<std::size_t>(map_.columns * map_.rows), 0);
}

void RecordingCount::begin(const SessionRows& session) {
    begun_ = {};
    begun_.participant = session.facts.participant;
    if (const CalibrationRecord* calibration = session.last_calibration()) {
        begun_.accuracy_deg = calibration->mean_accuracy_deg;
        begun_.precision_deg = median_precision(*calibration);
    }
    if (frames_.refresh_hz <= 0) frames_.refresh_hz = session.facts.refresh_hz;
}

std::optional<double> RecordingCount::add(const TrialRow& trial, SessionSurvey& survey) {
    if (open_.empty() || open_.back().quality.session != trial.planned.session) {
        open_.push_back({begun_, 0, 0, 0, {}});
        open_.back().quality.session = trial.planned.session;
    }
    Session& session = open_.back();

    const std::vector<GazeDirection> gaze = survey.gaze_directions(trial.shown);
    std::int64_t samples = 0, tracked = 0;
    for (const IntervalRecord& interval : trial.intervals) {
        if (!shows_picture(interval.phase)) continue;
        session.duration_s += (interval.end - interval.first_display).seconds();
        session.quality.frames += interval.presented_frames;
        session.quality.missed += interval.missed_vsyncs;
        for (const GazeDirection& sample : gaze) {
            if (sample.time < interval.first_display || sample.time >= interval.end) continue;
            ++samples;
            if (!sample.direction) continue;
            ++tracked;
            count(*sample.direction);
        }
    }
    session.samples += samples;
    session.tracked += tracked;

    const std::vector<FrameTime> frames = survey.frame_times(trial.shown);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!shows_picture(frames[i].phase)) continue;
        if (frames[i].gaze_age)
            session.gaze_ages_ms.push_back(static_cast<float>(frames[i].gaze_age->seconds() * 1000));
        if (i > 0) count(frames[i].display - frames[i - 1].display);
    }
    if (samples == 0) return std::nullopt;
    return 1 - static_cast<double>(tracked) / static_cast<double>(samples);
}

void RecordingCount::finish() {
    for (Session& session : open_) {
        SessionQuality& quality = session.quality;
        if (session.samples > 0) {
            any_gaze_ = true;
            quality.gaze_loss =
                1 - static_cast<double>(session.tracked) / static_cast<double>(session.samples);
            if (session.duration_s > 0)
                quality.gaze_hz = static_cast<double>(session.tracked) / session.duration_s;
        }
        if (auto& ages = session.gaze_ages_ms; !ages.empty()) {
            const auto nth = ages.begin() + std::lround(0.95 * static_cast<double>(ages.size() - 1));
            std::nth_element(ages.begin(), nth, ages.end());
            quality.gaze_age_ms = *nth;
        }
        finished_.push_back(std::move(quality));
    }
    open_.clear();
}

void RecordingCount::add(const RecordingCount& later) {
    assert(open_.empty() && later.open_.empty());
    for (std::size_t i = 0; i < map_.counts.size(); ++i) map_.counts[i] += later.map_.counts[i];
    if (frames_.refresh_hz <= 0) frames_.refresh_hz = later.frames_.refresh_hz;
    if (frames_.counts.size() < later.frames_.counts.size())
        frames_.counts.resize(later.frames_.counts.size(), 0);
    for (std::size_t i = 0; i < later.frames_.counts.size(); ++i)
        frames_.counts[i] += later.frames_.counts[i];
    finished_.insert(finished_.end(), later.finished_.begin(), later.finished_.end());
    any_gaze_ = any_gaze_ || later.any_gaze_;
    any_frame_ = any_frame_ || later.any_frame_;
}

StudyRecordings RecordingCount::recordings() const {
    StudyRecordings recordings;
    if (any_gaze_) recordings.gaze = map_;
    if (any_frame_) recordings.frames = frames_;
    recordings.sessions = finished_;
    return recordings;
}

void RecordingCount::count(DirectionDeg direction) {
    const double column = std::floor((direction.azimuth_deg / map_.width_deg + 0.5) * map_.columns);
    const double row = std::floor((0.5 - direction.elevation_deg / map_.height_deg) * map_.rows);
    if (!(column >= 0 && row >= 0 && column < map_.columns && row < map_.rows)) return;
    map_.counts[static_cast<std::size_t>(row * map_.columns + column)] += 1;
}

void RecordingCount::count(Duration frame_interval) {
    const double bin = std::floor(frame_interval.seconds() * 1000 / frames_.bin_ms);
    if (!(bin >= 0))
        return;  // a display time that went backwards is a fault of its own, named with its frame
    const std::size_t place = std::min(static_cast<std::size_t>(bin), kMostBins - 1);
    if (frames_.counts.size() <= place) frames_.counts.resize(place + 1, 0);
    ++frames_.counts[place];
    any_frame_ = true;
}

}  // namespace parafovea
