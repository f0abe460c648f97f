// Feeds a recorded trial back into run_trial and compares what comes out.
#include "study/session_replay.h"

#include <algorithm>
#include <stop_token>

#include "devices/clock.h"
#include "study/adaptive.h"
#include "study/database.h"
#include "study/migrations.h"
#include "study/session_log_reader.h"
#include "study/trial_plan.h"
#include "study/trial_runner.h"

namespace parafovea {
namespace {

// The recorded frame that is being shown, shared by the three players below.
struct Position {
    const TrialRecord& recorded;
    std::size_t frame = 0;
    bool at_end() const { return frame >= recorded.frames.size(); }
};

class RecordedStage final : public Stage {
  public:
    RecordedStage(Position& position, double refresh_hz, const ViewGeometry& view,
                  const ReplayFrame& on_frame, ReplayReport& report, std::stop_source& stop)
        : position_(position),
          refresh_hz_(refresh_hz),
          view_(view),
          on_frame_(on_frame),
          report_(report),
          stop_(stop) {}

    ShownFrame show(const Picture& picture) override {
        // A trial that wants more frames than were recorded is stopped; the comparison tells.
        if (position_.at_end()) {
            stop_.request_stop();
            return {};
        }
        const ShownFrame& recorded = position_.recorded.frames[position_.frame].shown;
        ShownFrame shown = recorded;
        ++report_.frames;
        if (on_frame_) {
            const std::optional<std::uint64_t> hash = on_frame_(picture, recorded);
            if (hash && recorded.image_hash) {
                ++report_.images;
                shown.image_hash = hash;
                if (*hash != *recorded.image_hash) wrong_images.push_back(recorded.index);
            }
        }
        ++position_.frame;
        const bool interrupted_here = position_.recorded.interrupted && position_.at_end();
        if (interrupted_here) stop_.request_stop();
        return shown;
    }
    double refresh_hz() const override { return refresh_hz_; }
    ViewGeometry view() const override { return view_; }

    std::vector<std::int64_t> wrong_images;

  private:
    Position& position_;
    double refresh_hz_;
    ViewGeometry view_;
    const ReplayFrame& on_frame_;
    ReplayReport& report_;
    std::stop_source& stop_;
};

// Delivers what had arrived when the recorded frame was prepared.
class RecordedGazeOfTrial final : public GazeSource {
  public:
    explicit RecordedGazeOfTrial(const Position& position) : position_(position) {}
    void drain(std::vector<GazeSample>& samples) override {
        const std::vector<GazeSample>& all = position_.recorded.gaze;
        if (position_.at_end()) return;
        const std::size_t known = std::min(
            all.size(), static_cast<std::size_t>(position_.recorded.frames[position_.frame].gaze_known));
        for (; next_ < known; ++next_) samples.push_back(all[next_]);
    }
    std::string description() const override { return "recorded"; }

  private:
    const Position& position_;
    std::size_t next_ = 0;
};

// Delivers what had arrived when the recorded frame had been shown.
class RecordedControllerOfTrial final : public ControllerSource {
  public:
    explicit RecordedControllerOfTrial(const Position& position) : position_(position) {}
    void drain(std::vector<ControllerEvent>& events) override {
        const std::vector<ControllerEvent>& all = position_.recorded.events;
        if (position_.frame == 0) return;
        const std::size_t known =
            std::min(all.size(),
                     static_cast<std::size_t>(position_.recorded.frames[position_.frame - 1].events_known));
        for (; next_ < known; ++next_) events.push_back(all[next_]);
    }
    std::string description() const override { return "recorded"; }

  private:
    const Position& position_;
    std::size_t next_ = 0;
};

// The part of two records in which they differ, in words.
std::string difference(const TrialRecord& recorded, const TrialRecord& replayed) {
    if (recorded.frames.size() != replayed.frames.size())
        return std::to_string(recorded.frames.size()) + " frames were recorded, " +
               std::to_string(replayed.frames.size()) + " replayed";
    for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
        const FrameRecord &a = recorded.frames[i], &b = replayed.frames[i];
        const std::string frame = "frame " + std::to_string(a.shown.index);
        if (a.phase != b.phase) return frame + " belongs to another phase";
        if (a.fovea != b.fovea || a.gaze_sequence != b.gaze_sequence)
            return frame + " was foveated elsewhere";
        if (a.fallback != b.fallback || a.gaze_age != b.gaze_age) return frame + " has another gaze age";
    }
    if (recorded.answer.has_value() != replayed.answer.has_value() ||
        (recorded.answer && (recorded.answer->identical != replayed.answer->identical ||
                             recorded.answer->time != replayed.answer->time)))
        return "the answer differs";
    if (recorded.level != replayed.level) return "the procedure chooses another level";
    if (recorded.invalid != replayed.invalid) return "the broken validity rules differ";
    if (recorded.gaze.size() != replayed.gaze.size()) return "gaze samples are missing";
    return "an interval or an event differs";
}

class Replay {
  public:
    Replay(const std::filesystem::path& path, const ReplayFrame& on_frame)
        : path_(path), on_frame_(on_frame), rows_(read_session(path)) {}

    ReplayReport run(const std::function<void(int, int)>& on_progress) {
        compare_file();
        const Protocol protocol = parse_protocol(rows_.protocol_text, rows_.protocol_file);
        if (protocol_hash(protocol) != rows_.protocol_hash)
            report_.differences.push_back("the protocol's text has been changed");
        if (make_plan(protocol, rows_.plan.participant_index, rows_.plan.seed) != rows_.plan)
            report_.differences.push_back(
                "the plan is not the one that protocol, participant index and seed give");
        for (const TrialRow& row : rows_.trials) {
            if (on_progress) on_progress(report_.trials, static_cast<int>(rows_.trials.size()));
            replay_trial(row, protocol);
        }
        if (on_progress) on_progress(report_.trials, static_cast<int>(rows_.trials.size()));
        return std::move(report_);
    }

  private:
    void compare_file() {
        Database database(path_, Database::Mode::read);
        Statement integrity = database.prepare("PRAGMA integrity_check");
        while (integrity.step())
            if (integrity.text(0) != "ok")
                report_.differences.push_back("the file is damaged: " + integrity.text(0));
    }

    void differs(const TrialRow& row, const std::string& how) {
        report_.differences.push_back("trial " + std::to_string(row.planned.number) + " attempt " +
                                      std::to_string(row.attempt) + ": " + how);
    }

    // Whether a showing no longer counted when a later one was shown: a whole session is superseded after
    // both.
    bool was_superseded(const TrialRow& earlier, const TrialRow& row) const {
        if (!earlier.superseded || !row.superseded) return earlier.superseded;
        return std::any_of(rows_.trials.begin(), rows_.trials.end(), [&](const TrialRow& again) {
            return again.planned.number == earlier.planned.number && again.attempt > earlier.attempt &&
                   again.shown < row.shown;
        });
    }

    // What the procedure knew when the trial was shown.
    std::vector<ShownTrial> shown_before(const TrialRow& row) const {
        std::vector<ShownTrial> shown;
        for (const TrialRow& earlier : rows_.trials) {
            if (earlier.shown >= row.shown) break;
            ShownTrial trial;
            trial.number = earlier.planned.number;
            trial.answered = earlier.answer.has_value();
            trial.identical = earlier.answer && earlier.answer->identical;
            trial.valid = earlier.invalid.empty();
            trial.interrupted = earlier.interrupted;
            trial.superseded = was_superseded(earlier, row);
            trial.level = earlier.level;
            shown.push_back(trial);
        }
        return shown;
    }

    void replay_trial(const TrialRow& row, const Protocol& protocol) {
        ++report_.trials;
        const StoredTrial stored = read_trial(path_, row);
        if (!stored.content_hash)
            return differs(row, "it was written by a version that did not keep enough to replay it exactly");
        if (content_hash(stored.record) != *stored.content_hash)
            differs(row, "stored values have been changed since they were written");

        Position position{stored.record};
        std::stop_source stop;
        if (stored.record.interrupted && stored.record.frames.empty()) stop.request_stop();
        RecordedStage stage(position, rows_.facts.refresh_hz, rows_.facts.view, on_frame_, report_, stop);
        RecordedGazeOfTrial gaze(position);
        RecordedControllerOfTrial controller(position);
        SimulatedClock clock;
        clock.wait_until(stored.record.started);
        TrialControl control;
        control.stop = stop.get_token();
        const int lead_in =
            stored.record.intervals[static_cast<std::size_t>(Phase::lead_in)].presented_frames;
        control.stimulus_ready = [&] { return static_cast<int>(position.frame) >= lead_in; };
        TrialRecord replayed = run_trial(at_level(row.planned, protocol, row.level), protocol, stage, gaze,
                                         controller, clock, control);
        replayed.attempt = row.attempt;
        replayed.level = adaptive_level(protocol, rows_.plan, shown_before(row), row.planned);
        for (const std::int64_t frame : stage.wrong_images)
            differs(row, "frame " + std::to_string(frame) + " is another picture");
        // What was rendered differently is reported above, and only once.
        for (std::size_t i = 0; i < std::min(replayed.frames.size(), stored.record.frames.size()); ++i)
            replayed.frames[i].shown.image_hash = stored.record.frames[i].shown.image_hash;
        if (content_hash(replayed) != content_hash(stored.record))
            differs(row, difference(stored.record, replayed));
    }

    std::filesystem::path path_;
    const ReplayFrame& on_frame_;
    SessionRows rows_;
    ReplayReport report_;
};

}  // namespace

ReplayReport replay_session(const std::filesystem::path& path, const ReplayFrame& on_frame,
                            const std::function<void(int done, int total)>& on_progress) {
    return Replay(path, on_frame).run(on_progress);
}

}  // namespace parafovea
