// A stage, an eye tracker and a participant for tests: exact, and with faults on order.
#pragma once

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/gaze_source.h"
#include "study/protocol.h"
#include "study/stage.h"
#include "tests/temporary_folder.h"

namespace parafovea::test {

// Shows every picture for one refresh of a simulated clock; some frames can be ordered to stay on longer.
class FakeStage final : public Stage {
  public:
    FakeStage(SimulatedClock& clock, double refresh_hz, ViewGeometry view = {{1280, 1440}, 76.7})
        : clock_(clock), refresh_hz_(refresh_hz), view_(view) {}

    ShownFrame show(const Picture& picture) override {
        if (before_show) before_show(picture);
        ShownFrame frame;
        frame.index = shown_++;
        frame.missed_vsyncs = late.contains(frame.index) ? 1 : 0;
        refreshes_ += 1 + frame.missed_vsyncs;
        frame.display_time = {
            static_cast<std::int64_t>(std::llround(static_cast<double>(refreshes_) * 1e9 / refresh_hz_))};
        frame.time_source = TimeSource::simulated;
        if (picture.kind == PictureKind::stimulus)
            frame.image_hash = std::hash<std::string>()(picture.scene + to_text(picture.method));
        clock_.wait_until(frame.display_time);
        pictures.push_back(picture);
        if (keep_last > 0 && pictures.size() > keep_last) pictures.erase(pictures.begin());
        return frame;
    }

    double refresh_hz() const override { return refresh_hz_; }
    ViewGeometry view() const override { return view_; }

    std::vector<Picture> pictures;  // everything shown
    std::size_t keep_last = 0;
    std::set<std::int64_t> late;  // frames before which one refresh is missed
    std::function<void(const Picture&)> before_show;

  private:
    SimulatedClock& clock_;
    double refresh_hz_;
    ViewGeometry view_;
    std::int64_t refreshes_ = 0, shown_ = 0;
};

// Delivers samples handed to it once their arrival time has come.
class FakeGaze final : public GazeSource {
  public:
    explicit FakeGaze(SimulatedClock& clock) : clock_(clock) {}

    void drain(std::vector<GazeSample>& samples) override {
        while (next_ < to_come.size() && to_come[next_].arrival_time <= clock_.now())
            samples.push_back(to_come[next_++]);
    }
    std::string description() const override { return "fake"; }

    // A 100 Hz tracker looking in one direction from `from_s` to `to_s`; no direction is a blink. It sees
    // each sample 10 ms before it arrives.
    void look(double from_s, double to_s, std::optional<DirectionDeg> direction) {
        for (int i = 0; i * 0.01 < to_s - from_s - 1e-9; ++i) {
            GazeSample sample;
            sample.sequence = static_cast<std::int64_t>(to_come.size());
            sample.host_time = {Duration::from_seconds(from_s + i * 0.01).ns};
            sample.device_time = {sample.host_time.ns + 123'456'789};
            sample.host_time_error = Duration::from_ms(1);
            sample.arrival_time = sample.host_time + Duration::from_ms(10);
            sample.status = direction ? GazeStatus::tracked : GazeStatus::blink;
            sample.direction = direction;
            if (direction) sample.left = EyeSample{direction, 3.5};
            to_come.push_back(sample);
        }
    }

    std::vector<GazeSample> to_come;

  private:
    SimulatedClock& clock_;
    std::size_t next_ = 0;
};

// A participant who presses when the question or a page of text is on: the same if `answers_same` says so,
// which sees the question's picture's place in the session.
class FakeParticipant final : public ControllerSource {
  public:
    FakeParticipant(SimulatedClock& clock, FakeStage& stage, Keys keys = {}) : clock_(clock) {
        stage.before_show = [this, keys](const Picture& picture) {
            const bool asks = picture.kind == PictureKind::question || picture.kind == PictureKind::text;
            if (picture.kind == PictureKind::stimulus) seen_.insert(to_text(picture.method));
            // Once for each question: on its second frame.
            if (asks && asked_) {
                const bool same = answers_same(seen_);
                const bool page = picture.kind == PictureKind::text;
                if (page || answers) press(page ? keys.proceed : same ? keys.same : keys.different);
                if (!page) seen_.clear();
                asked_ = false;
                return;
            }
            asked_ = asks && !pending_;
        };
    }

    void press(Button button) {
        events_.push_back({ControllerEventKind::press, button, clock_.now(), Duration::from_ms(4)});
        events_.push_back({ControllerEventKind::release, button, clock_.now(), Duration::from_ms(4)});
        pending_ = true;
    }

    void drain(std::vector<ControllerEvent>& events) override {
        events.insert(events.end(), events_.begin(), events_.end());
        events_.clear();
        pending_ = false;
    }
    std::string description() const override { return "fake"; }

    bool answers = true;
    // Gets the two settings that were shown, or one where they were equal.
    std::function<bool(const std::set<std::string>&)> answers_same = [](const auto& seen) {
        return seen.size() == 1;
    };

  private:
    SimulatedClock& clock_;
    std::vector<ControllerEvent> events_;
    std::set<std::string> seen_;
    bool asked_ = false, pending_ = false;
};

// A small protocol: 4 conditions, 1 training trial, two sessions of 4 + 2 trials, short intervals.
inline std::string small_protocol_text() {
    return R"(name = "small"
language = "en"
scenes = ["one", "two"]
[display]
width_px = 640
height_px = 480
horizontal_fov_deg = 60
refresh_hz = 100
[timing]
lead_in_s = 0.05
interval_s = 0.2
gap_s = 0.1
[conditions]
method = "kfr"
[conditions.factors]
sigma = [1.5, 2]
alpha = [1, 4]
[design]
training_trials = 1
sessions = 2
validation_share = 0.3333333333
[texts.en]
introduction = "Hello"
session = "Session {session} of {sessions}"
question = "Same?"
rest = "Rest"
)";
}

inline Protocol small_protocol() {
    return parse_protocol(small_protocol_text(), "small.toml");
}

}  // namespace parafovea::test
