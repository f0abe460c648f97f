// Keeps the recent past of a session for the operator.
#include "app/operator_board.h"

#include <algorithm>

namespace parafovea {

namespace {

constexpr Duration kGazeMemory{10'000'000'000}, kGazeShown{1'000'000'000}, kGazeSilence{500'000'000};
constexpr std::size_t kFramesShown = 240, kAnswersShown = 100;

}  // namespace

OperatorView OperatorBoard::view() const {
    const std::scoped_lock lock(mutex_);
    OperatorView view = now_;
    view.asked = request_;
    const HostTime now = clock_.now();
    if (first_trial_ && now_.done > done_at_first_)
        view.seconds_left =
            (now - *first_trial_).seconds() / (now_.done - done_at_first_) * (now_.total - now_.done);

    std::size_t lost = 0;
    for (const GazeSample& sample : recent_gaze_) {
        if (!sample.direction) ++lost;
        if (now - sample.arrival_time <= kGazeShown) view.gaze.push_back(sample);
    }
    view.gaze_rate_hz = static_cast<double>(view.gaze.size()) / kGazeShown.seconds();
    if (!recent_gaze_.empty())
        view.gaze_lost_share = static_cast<double>(lost) / static_cast<double>(recent_gaze_.size());
    view.gaze_silent = recent_gaze_.empty() || now - recent_gaze_.back().arrival_time > kGazeSilence;

    for (std::size_t i = 1; i < recent_frames_.size(); ++i)
        view.frame_ms.push_back((recent_frames_[i] - recent_frames_[i - 1]).ms());
    return view;
}

void OperatorBoard::ask(OperatorRequest request) {
    const std::scoped_lock lock(mutex_);
    request_ = request;
}

void OperatorBoard::write_note(std::string text) {
    const std::scoped_lock lock(mutex_);
    notes_.emplace_back(clock_.now(), std::move(text));
}

void OperatorBoard::set_progress(const SessionProgress& progress) {
    const std::scoped_lock lock(mutex_);
    now_.state = progress.state;
    now_.done = progress.done;
    now_.total = progress.total;
    now_.session = progress.session;
    now_.sessions = progress.sessions;
    now_.trial.reset();
    if (progress.next) now_.trial = *progress.next;
    if (progress.next && !first_trial_) {
        first_trial_ = clock_.now();
        done_at_first_ = progress.done;
    }
}

void OperatorBoard::add_trial(const TrialRecord& record) {
    AnsweredTrial line;
    line.number = record.planned.number;
    line.kind = record.planned.kind;
    line.condition =
        to_text(record.planned.reference_interval == 0 ? record.planned.second : record.planned.first);
    if (record.answer) {
        line.identical = record.answer->identical;
        line.reaction_s = record.answer->reaction.seconds();
    }
    for (const std::string& rule : record.invalid) line.invalid += (line.invalid.empty() ? "" : ", ") + rule;

    const std::scoped_lock lock(mutex_);
    if (record.answer) ++now_.answered;
    if (record.answer && record.answer->identical) ++now_.identical;
    if (record.planned.kind == TrialKind::validation && record.answer && !record.answer->identical)
        ++now_.failed_validations;
    if (!record.invalid.empty()) ++now_.invalid;
    for (const IntervalRecord& interval : record.intervals) now_.missed += interval.missed_vsyncs;
    for (const ControllerEvent& event : record.events) {
        if (event.kind == ControllerEventKind::connected) now_.controller_connected = true;
        if (event.kind == ControllerEventKind::disconnected) now_.controller_connected = false;
    }
    now_.answers.insert(now_.answers.begin(), std::move(line));
    if (now_.answers.size() > kAnswersShown) now_.answers.pop_back();
}

void OperatorBoard::add_frame(const Picture& picture, const ShownFrame& shown, double refresh_hz) {
    const std::scoped_lock lock(mutex_);
    now_.picture = picture;
    now_.refresh_hz = refresh_hz;
    recent_frames_.push_back(shown.display_time);
    if (recent_frames_.size() > kFramesShown) recent_frames_.pop_front();
}

void OperatorBoard::add_gaze(std::span<const GazeSample> samples) {
    if (samples.empty()) return;
    const std::scoped_lock lock(mutex_);
    recent_gaze_.insert(recent_gaze_.end(), samples.begin(), samples.end());
    while (recent_gaze_.back().arrival_time - recent_gaze_.front().arrival_time > kGazeMemory)
        recent_gaze_.pop_front();
}

void OperatorBoard::add_calibration(const CalibrationRecord& record) {
    const std::scoped_lock lock(mutex_);
    if (record.kind == "drift check") {
        now_.drift = record;
        return;
    }
    now_.calibration = record;
    now_.drift.reset();
}

OperatorRequest OperatorBoard::take_request() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(request_, OperatorRequest::none);
}

std::vector<std::pair<HostTime, std::string>> OperatorBoard::take_notes() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(notes_, {});
}

ShownFrame WatchedStage::show(const Picture& picture) {
    const ShownFrame shown = stage_.show(picture);
    board_.add_frame(picture, shown, stage_.refresh_hz());
    return shown;
}

void WatchedGaze::drain(std::vector<GazeSample>& samples) {
    const std::size_t known = samples.size();
    gaze_.drain(samples);
    board_.add_gaze(std::span(samples).subspan(known));
}

}  // namespace parafovea
