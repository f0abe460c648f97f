// Reads a session file back into plain rows.
#include "study/session_log_reader.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "study/database.h"
#include "study/migrations.h"
#include "study/session_rows.h"

namespace parafovea {
namespace {

std::optional<DirectionDeg> direction(const Statement& row, int column) {
    if (row.is_null(column)) return std::nullopt;
    return DirectionDeg{row.real(column), row.real(column + 1)};
}

std::vector<EventRow> read_events(Database& database, const char* sql) {
    std::vector<EventRow> events;
    Statement row = database.prepare(sql);
    while (row.step()) events.push_back({{row.integer(0)}, row.text(1), row.text(2)});
    return events;
}

std::vector<CalibrationRecord> read_calibrations(Database& database) {
    std::vector<CalibrationRecord> calibrations;
    Statement row = database.prepare(
        "SELECT calibration, method, started_host_ns, ended_host_ns, accepted, mean_accuracy_deg, "
        "worst_accuracy_deg, "
        "data_loss_share, kind FROM calibration ORDER BY calibration");
    while (row.step()) {
        CalibrationRecord record;
        record.method = row.text(1);
        record.started = {row.integer(2)};
        record.ended = {row.integer(3)};
        record.accepted = row.integer(4) != 0;
        record.mean_accuracy_deg = row.optional_real(5);
        record.worst_accuracy_deg = row.optional_real(6);
        record.data_loss_share = row.optional_real(7);
        record.kind = row.text(8);
        Statement point = database.prepare(
            "SELECT target_azimuth_deg, target_elevation_deg, measured_azimuth_deg, measured_elevation_deg, "
            "samples, "
            "valid_samples, accuracy_deg, precision_rms_deg, precision_sd_deg FROM validation_point WHERE "
            "calibration = ? "
            "ORDER BY point");
        point.bind(row.integer(0));
        while (point.step())
            record.points.push_back({{point.real(0), point.real(1)},
                                     direction(point, 2),
                                     static_cast<int>(point.integer(4)),
                                     static_cast<int>(point.integer(5)),
                                     point.optional_real(6),
                                     point.optional_real(7),
                                     point.optional_real(8)});
        calibrations.push_back(std::move(record));
    }
    return calibrations;
}

constexpr const char* kIntervalsOfTrial =
    "SELECT phase, intended_frames, presented_frames, first_display_host_ns, last_display_host_ns, "
    "end_host_ns, "
    "time_source, missed_vsyncs, longest_frame_ns FROM interval WHERE trial_id = ? ORDER BY phase";

std::vector<IntervalRecord> read_intervals(Statement& row, std::int64_t trial_id) {
    std::vector<IntervalRecord> intervals;
    row.reset().bind(trial_id);
    while (row.step()) {
        IntervalRecord interval;
        interval.phase = static_cast<Phase>(row.integer(0));
        interval.intended_frames = static_cast<int>(row.integer(1));
        interval.presented_frames = static_cast<int>(row.integer(2));
        interval.first_display = {row.integer(3)};
        interval.last_display = {row.integer(4)};
        interval.end = {row.integer(5)};
        interval.time_source = static_cast<TimeSource>(row.integer(6));
        interval.missed_vsyncs = static_cast<int>(row.integer(7));
        interval.longest_frame = {row.integer(8)};
        intervals.push_back(interval);
    }
    return intervals;
}

std::vector<TrialRow> read_trials(Database& database, const TrialPlan& plan) {
    std::vector<TrialRow> trials;
    Statement row = database.prepare(
        "SELECT trial_id, trial, attempt, started_host_ns, interrupted, superseded, identical, button, "
        "host_ns, reaction_ns, "
        "level FROM trial LEFT JOIN response USING (trial_id) ORDER BY trial_id");
    Statement rules =
        database.prepare("SELECT detail FROM flag WHERE kind = 'invalid' AND trial_id = ? ORDER BY flag");
    Statement intervals = database.prepare(kIntervalsOfTrial);
    while (row.step()) {
        TrialRow trial;
        const std::int64_t trial_id = row.integer(0);
        trial.planned = plan.trials.at(static_cast<std::size_t>(row.integer(1)));
        trial.level = row.optional_real(10);
        trial.attempt = static_cast<int>(row.integer(2));
        trial.shown = static_cast<int>(trials.size());
        trial.started = {row.integer(3)};
        trial.interrupted = row.integer(4) != 0;
        trial.superseded = row.integer(5) != 0;
        if (!row.is_null(6))
            trial.answer = Answer{row.integer(6) != 0,
                                  button_from_name(row.text(7)).value_or(Button::a),
                                  {row.integer(8)},
                                  {row.integer(9)}};
        rules.reset().bind(trial_id);
        while (rules.step()) trial.invalid.push_back(rules.text(0));
        trial.intervals = read_intervals(intervals, trial_id);
        trials.push_back(std::move(trial));
    }
    return trials;
}

constexpr const char* kSampleColumns =
    "sequence, device_ns, host_ns, host_error_ns, arrival_host_ns, status, eyes, azimuth_deg, elevation_deg, "
    "left_azimuth_deg, left_elevation_deg, left_pupil_mm, right_azimuth_deg, right_elevation_deg, "
    "right_pupil_mm";

// Of a row that begins with these columns.
GazeSample sample_of(const Statement& row) {
    GazeSample sample;
    sample.sequence = row.integer(0);
    sample.device_time = {row.integer(1)};
    sample.host_time = {row.integer(2)};
    sample.host_time_error = {row.integer(3)};
    sample.arrival_time = {row.integer(4)};
    sample.status = static_cast<GazeStatus>(row.integer(5));
    sample.direction = direction(row, 7);
    if (row.integer(6) & 1) sample.left = EyeSample{direction(row, 9), row.optional_real(11)};
    if (row.integer(6) & 2) sample.right = EyeSample{direction(row, 12), row.optional_real(14)};
    return sample;
}

Statement rows_of_trial(Database& database, std::string_view sql, int trial_number, int attempt) {
    Statement row = database.prepare(sql);
    row.bind_all(trial_number, attempt);
    return row;
}

}  // namespace

const CalibrationRecord* SessionRows::last_calibration() const {
    const auto last =
        std::find_if(calibrations.rbegin(), calibrations.rend(),
                     [](const CalibrationRecord& record) { return record.kind == "calibration"; });
    return last == calibrations.rend() ? nullptr : &*last;
}

SessionRows read_session(const std::filesystem::path& path) {
    const std::unique_ptr<Database> open = open_for_reading(path);
    Database& database = *open;
    SessionRows rows;
    Statement experiment =
        database.prepare("SELECT name, protocol_text, protocol_file, protocol_hash FROM experiment");
    if (!experiment.step())
        throw std::runtime_error(
            path.string() +
            ": expected a session with its protocol, found none; check that it is a session file");
    rows.protocol_name = experiment.text(0);
    rows.protocol_text = experiment.text(1);
    rows.protocol_file = experiment.text(2);
    rows.protocol_hash = experiment.text(3);
    rows.facts = read_facts(database);
    rows.plan = read_plan(database);
    Statement anchor = database.prepare("SELECT host_ns, wall_ns FROM clock_anchor ORDER BY anchor");
    while (anchor.step()) rows.anchors.push_back({{anchor.integer(0)}, anchor.integer(1)});
    Statement session = database.prepare("SELECT finished_host_ns FROM session");
    rows.finished = session.step() && !session.is_null(0);
    rows.trials = read_trials(database, rows.plan);
    rows.events = read_events(database, "SELECT host_ns, kind, detail FROM event ORDER BY event");
    rows.notes = read_events(database, "SELECT host_ns, 'note', text FROM note ORDER BY note");
    rows.calibrations = read_calibrations(database);
    Statement answer = database.prepare(
        "SELECT name, question, answer FROM questionnaire JOIN questionnaire_answer USING (questionnaire) "
        "ORDER BY questionnaire");
    while (answer.step()) rows.questionnaires[answer.text(0)][answer.text(1)] = answer.text(2);
    return rows;
}

StoredTrial read_trial(const std::filesystem::path& path, const TrialRow& row) {
    const int number = row.planned.number;
    StoredTrial stored;
    TrialRecord& record = stored.record;
    record.planned = row.planned;
    record.attempt = row.attempt;
    record.level = row.level;
    record.started = row.started;
    record.interrupted = row.interrupted;
    record.answer = row.answer;
    record.invalid = row.invalid;
    std::copy_n(row.intervals.begin(), std::min(row.intervals.size(), record.intervals.size()),
                record.intervals.begin());
    record.frames = read_frames(path, number, row.attempt);
    record.gaze = read_gaze(path, number, row.attempt);
    record.events = read_controller_events(path, number, row.attempt);
    const std::unique_ptr<Database> open = open_for_reading(path);
    Statement hash = rows_of_trial(*open, "SELECT content_hash FROM trial WHERE trial = ? AND attempt = ?",
                                   number, row.attempt);
    if (hash.step() && !hash.is_null(0)) stored.content_hash = std::bit_cast<std::uint64_t>(hash.integer(0));
    return stored;
}

std::vector<FrameRecord> read_frames(const std::filesystem::path& path, int trial_number, int attempt) {
    const std::unique_ptr<Database> open = open_for_reading(path);
    std::vector<FrameRecord> frames;
    Statement row = rows_of_trial(
        *open,
        "SELECT frame, phase, display_host_ns, time_source, missed_vsyncs, gpu_ns, "
        "image_hash, fovea_x_px, fovea_y_px, "
        "fallback, gaze_sequence, gaze_age_ns, gaze_known, events_known, fault FROM frame JOIN trial USING "
        "(trial_id) WHERE trial = ? AND attempt = ? ORDER BY frame",
        trial_number, attempt);
    while (row.step()) {
        FrameRecord frame;
        frame.shown.index = row.integer(0);
        frame.phase = static_cast<Phase>(row.integer(1));
        frame.shown.display_time = {row.integer(2)};
        frame.shown.time_source = static_cast<TimeSource>(row.integer(3));
        frame.shown.missed_vsyncs = static_cast<int>(row.integer(4));
        if (const auto gpu = row.optional_integer(5)) frame.shown.gpu_time = Duration{*gpu};
        if (const auto hash = row.optional_integer(6))
            frame.shown.image_hash = std::bit_cast<std::uint64_t>(*hash);
        frame.fovea = {row.real(7), row.real(8)};
        frame.fallback = row.integer(9) != 0;
        frame.gaze_sequence = row.optional_integer(10);
        if (const auto age = row.optional_integer(11)) frame.gaze_age = Duration{*age};
        frame.gaze_known = static_cast<int>(row.integer(12));
        frame.events_known = static_cast<int>(row.integer(13));
        frame.shown.fault = row.text(14);
        frames.push_back(frame);
    }
    return frames;
}

std::vector<GazeSample> read_gaze(const std::filesystem::path& path, int trial_number, int attempt) {
    const std::unique_ptr<Database> open = open_for_reading(path);
    std::vector<GazeSample> samples;
    Statement row = rows_of_trial(*open,
                                  std::string("SELECT ") + kSampleColumns +
                                      " FROM gaze JOIN trial USING (trial_id) WHERE trial = ? AND attempt = "
                                      "? ORDER BY n",
                                  trial_number, attempt);
    while (row.step()) samples.push_back(sample_of(row));
    return samples;
}

std::vector<GazeBetween> read_gaze_between(const std::filesystem::path& path) {
    const std::unique_ptr<Database> open = open_for_reading(path);
    std::vector<GazeBetween> samples;
    Statement row =
        open->prepare(std::string("SELECT ") + kSampleColumns + ", phase FROM gaze_between ORDER BY n");
    while (row.step()) samples.push_back({row.text(15), sample_of(row)});
    return samples;
}

std::vector<ControllerEvent> read_controller_events(const std::filesystem::path& path, int trial_number,
                                                    int attempt) {
    const std::unique_ptr<Database> open = open_for_reading(path);
    std::vector<ControllerEvent> events;
    Statement row =
        rows_of_trial(*open,
                      "SELECT host_ns, host_error_ns, kind, button FROM controller_event JOIN trial USING "
                      "(trial_id) WHERE trial = ? AND attempt = ? ORDER BY n",
                      trial_number, attempt);
    while (row.step()) {
        ControllerEvent event;
        event.time = {row.integer(0)};
        event.time_error = {row.integer(1)};
        const std::string kind = row.text(2);
        event.kind = kind == "press"       ? ControllerEventKind::press
                     : kind == "release"   ? ControllerEventKind::release
                     : kind == "connected" ? ControllerEventKind::connected
                                           : ControllerEventKind::disconnected;
        event.button = button_from_name(row.text(3)).value_or(Button::a);
        events.push_back(event);
    }
    return events;
}

}  // namespace parafovea
