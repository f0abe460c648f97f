// The trial state machine: whole frames, one phase after the other.
#include "study/trial_runner.h"

#include <algorithm>
#include <cmath>

#include "study/foveation_point.h"
#include "study/trial_validity.h"

namespace parafovea {
namespace {

Duration frame_period(const Stage& stage) {
    return Duration::from_seconds(1 / stage.refresh_hz());
}

class RunningTrial {
  public:
    RunningTrial(const PlannedTrial& trial, const Protocol& protocol, Stage& stage, GazeSource& gaze,
                 ControllerSource& controller, const TrialControl& control)
        : protocol_(protocol),
          stage_(stage),
          gaze_(gaze),
          controller_(controller),
          control_(control),
          fovea_(protocol, stage.view()) {
        record_.planned = trial;
    }

    TrialRecord run(Clock& clock) {
        const Timing& timing = protocol_.timing;
        const int interval = frames_from_seconds(timing.interval_s, stage_.refresh_hz());
        record_.started = clock.now();

        Picture lead_in, first, gap, second;
        lead_in.kind = timing.lead_in == LeadIn::fixation ? PictureKind::fixation : PictureKind::black;
        first.kind = second.kind = PictureKind::stimulus;
        first.scene = second.scene = record_.planned.scene;
        first.method = record_.planned.first;
        second.method = record_.planned.second;

        show_lead_in(lead_in);
        show_phase(Phase::first_interval, first, interval);
        show_phase(Phase::gap, gap, frames_from_seconds(timing.gap_s, stage_.refresh_hz()));
        show_phase(Phase::second_interval, second, interval);
        ask();
        record_.interrupted = stopped();
        if (record_.interrupted) record_.answer.reset();
        if (!record_.interrupted) record_.invalid = broken_rules(record_, protocol_);
        return std::move(record_);
    }

  private:
    bool stopped() const { return control_.stop.stop_requested(); }
    IntervalRecord& interval(Phase phase) { return record_.intervals[static_cast<std::size_t>(phase)]; }

    void show_lead_in(const Picture& picture) {
        const int frames = frames_from_seconds(protocol_.timing.lead_in_s, stage_.refresh_hz());
        show_phase(Phase::lead_in, picture, frames);
        while (control_.stimulus_ready && !control_.stimulus_ready() && !stopped())
            show_frame(Phase::lead_in, picture);
        close(Phase::lead_in);
    }

    void show_phase(Phase phase, const Picture& picture, int frames) {
        IntervalRecord& now = interval(phase);
        now.phase = phase;
        now.intended_frames = frames;
        // A missed refresh costs a frame, so that the phase lasts as long as it should.
        while (now.presented_frames + now.missed_vsyncs < frames && !stopped()) show_frame(phase, picture);
        close(phase);
    }

    const FrameRecord& show_frame(Phase phase, Picture picture) {
        const std::size_t known = record_.gaze.size();
        gaze_.drain(record_.gaze);
        fovea_.take(std::span(record_.gaze).subspan(known));
        FoveationPoint::Choice choice = fovea_.choose();
        picture.fovea = choice.point;
        if (protocol_.display.photodiode_patch)
            picture.patch = phase == Phase::first_interval || phase == Phase::second_interval;

        FrameRecord frame;
        frame.phase = phase;
        frame.gaze_known = static_cast<int>(record_.gaze.size());
        frame.shown = stage_.show(picture);
        frame.fovea = choice.point;
        if (picture.kind == PictureKind::stimulus) {
            frame.gaze_sequence = choice.gaze_sequence;
            if (choice.seen) frame.gaze_age = frame.shown.display_time - *choice.seen;
            frame.fallback = fovea_.is_fallback(choice, frame.shown.display_time);
        }
        count(frame);
        controller_.drain(record_.events);
        frame.events_known = static_cast<int>(record_.events.size());
        record_.frames.push_back(frame);
        return record_.frames.back();
    }

    // A missed refresh is one on which the frame before stayed on: it counts for the phase of that frame.
    void count(const FrameRecord& frame) {
        if (!record_.frames.empty()) {
            const FrameRecord& before = record_.frames.back();
            IntervalRecord& kept_on = interval(before.phase);
            kept_on.missed_vsyncs += frame.shown.missed_vsyncs;
            kept_on.longest_frame =
                std::max(kept_on.longest_frame, frame.shown.display_time - before.shown.display_time);
        }
        IntervalRecord& now = interval(frame.phase);
        if (now.presented_frames++ == 0) now.first_display = frame.shown.display_time;
        now.last_display = frame.shown.display_time;
        now.time_source = frame.shown.time_source;
        // Known for certain once the next frame is shown, which then corrects it.
        now.end = frame.shown.display_time + frame_period(stage_);
        if (record_.frames.empty() || record_.frames.back().phase == frame.phase) return;
        interval(record_.frames.back().phase).end = frame.shown.display_time;
    }

    // A phase of one frame has no distance to a next one yet.
    void close(Phase phase) {
        IntervalRecord& closed = interval(phase);
        if (closed.presented_frames > 0)
            closed.longest_frame = std::max(closed.longest_frame, frame_period(stage_));
    }

    void ask() {
        Picture question;
        question.kind = PictureKind::question;
        question.text = protocol_.text().question;
        interval(Phase::question).phase = Phase::question;
        const std::optional<double> window_s = protocol_.timing.response_window_s;
        while (!stopped()) {
            const FrameRecord& frame = show_frame(Phase::question, question);
            const HostTime onset = interval(Phase::question).first_display;
            if (find_answer(onset)) break;
            if (window_s &&
                frame.shown.display_time + frame_period(stage_) - onset >= Duration::from_seconds(*window_s))
                break;
        }
        close(Phase::question);
    }

    bool find_answer(HostTime onset) {
        for (const ControllerEvent& event : record_.events) {
            const bool key = event.button == protocol_.keys.same || event.button == protocol_.keys.different;
            if (event.kind != ControllerEventKind::press || !key || event.time < onset) continue;
            const Duration reaction = event.time - onset;
            if (protocol_.timing.response_window_s &&
                reaction > Duration::from_seconds(*protocol_.timing.response_window_s))
                continue;
            record_.answer = Answer{event.button == protocol_.keys.same, event.button, event.time, reaction};
            return true;
        }
        return false;
    }

    const Protocol& protocol_;
    Stage& stage_;
    GazeSource& gaze_;
    ControllerSource& controller_;
    const TrialControl& control_;
    FoveationPoint fovea_;
    TrialRecord record_;
};

}  // namespace

int frames_from_seconds(double seconds, double refresh_hz) {
    // 0.7 s at 90 Hz must not be 62.999999: what lies within a millionth of a half counts as the half.
    return static_cast<int>(std::floor(seconds * refresh_hz + 0.5 + 1e-6));
}

TrialRecord run_trial(const PlannedTrial& trial, const Protocol& protocol, Stage& stage, GazeSource& gaze,
                      ControllerSource& controller, Clock& clock, const TrialControl& control) {
    return RunningTrial(trial, protocol, stage, gaze, controller, control).run(clock);
}

}  // namespace parafovea
