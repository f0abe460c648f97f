// Writes and reads the rows of study/schema.sql.
#include "study/session_rows.h"

#include <bit>

namespace parafovea {
namespace {

std::int64_t bits(std::uint64_t value) {
    return std::bit_cast<std::int64_t>(value);
}

std::string_view event_name(ControllerEventKind kind) {
    switch (kind) {
        case ControllerEventKind::press:
            return "press";
        case ControllerEventKind::release:
            return "release";
        case ControllerEventKind::connected:
            return "connected";
        case ControllerEventKind::disconnected:
            return "disconnected";
    }
    return "press";
}

std::optional<double> azimuth(const std::optional<DirectionDeg>& direction) {
    return direction ? std::optional(direction->azimuth_deg) : std::nullopt;
}
std::optional<double> elevation(const std::optional<DirectionDeg>& direction) {
    return direction ? std::optional(direction->elevation_deg) : std::nullopt;
}

void write_intervals(Database& database, const TrialRecord& record, std::int64_t trial_id) {
    Statement insert = database.prepare("INSERT INTO interval VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const IntervalRecord& interval : record.intervals)
        insert
            .bind_all(trial_id, static_cast<int>(interval.phase), interval.intended_frames,
                      interval.presented_frames, interval.first_display.ns, interval.last_display.ns,
                      interval.end.ns, static_cast<int>(interval.time_source), interval.missed_vsyncs,
                      interval.longest_frame.ns)
            .run();
}

void write_frames(Database& database, const TrialRecord& record, std::int64_t trial_id) {
    Statement insert =
        database.prepare("INSERT INTO frame VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const FrameRecord& frame : record.frames) {
        insert.bind_all(trial_id, frame.shown.index, static_cast<int>(frame.phase),
                        frame.shown.display_time.ns, static_cast<int>(frame.shown.time_source),
                        frame.shown.missed_vsyncs);
        insert.bind(frame.shown.gpu_time ? std::optional(frame.shown.gpu_time->ns) : std::nullopt);
        insert.bind(frame.shown.image_hash ? std::optional(bits(*frame.shown.image_hash)) : std::nullopt);
        insert.bind_all(frame.fovea.x, frame.fovea.y, frame.fallback, frame.gaze_sequence);
        insert.bind(frame.gaze_age ? std::optional(frame.gaze_age->ns) : std::nullopt);
        insert.bind_all(frame.gaze_known, frame.events_known);
        insert.bind(frame.shown.fault.empty() ? std::nullopt : std::optional(frame.shown.fault)).run();
    }
}

// The columns that both tables of gaze have, after those that say where a sample belongs.
Statement& bind_sample(Statement& insert, const GazeSample& sample) {
    const EyeSample left = sample.left.value_or(EyeSample()), right = sample.right.value_or(EyeSample());
    return insert.bind_all(sample.sequence, sample.device_time.ns, sample.host_time.ns,
                           sample.host_time_error.ns, sample.arrival_time.ns, static_cast<int>(sample.status),
                           azimuth(sample.direction), elevation(sample.direction), azimuth(left.direction),
                           elevation(left.direction), left.pupil_mm, azimuth(right.direction),
                           elevation(right.direction), right.pupil_mm,
                           (sample.left ? 1 : 0) + (sample.right ? 2 : 0));
}

void write_gaze(Database& database, const TrialRecord& record, std::int64_t trial_id) {
    Statement insert =
        database.prepare("INSERT INTO gaze VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    int n = 0;
    for (const GazeSample& sample : record.gaze) bind_sample(insert.bind_all(trial_id, n++), sample).run();
}

void write_controller_events(Database& database, const TrialRecord& record, std::int64_t trial_id) {
    Statement insert = database.prepare("INSERT INTO controller_event VALUES (?, ?, ?, ?, ?, ?)");
    int n = 0;
    for (const ControllerEvent& event : record.events) {
        const bool of_button =
            event.kind == ControllerEventKind::press || event.kind == ControllerEventKind::release;
        insert.bind_all(trial_id, n++, event.time.ns, event.time_error.ns, event_name(event.kind));
        insert.bind(of_button ? std::optional(button_name(event.button)) : std::nullopt).run();
    }
}

}  // namespace

void write_experiment(Database& database, const Protocol& protocol) {
    database.prepare("INSERT INTO experiment VALUES (?, ?, ?, ?)")
        .bind_all(protocol.name, protocol.file_name, protocol.source, protocol_hash(protocol))
        .run();
}

void write_session(Database& database, const SessionFacts& facts, const TrialPlan& plan) {
    database
        .prepare(
            "INSERT INTO session (uuid, participant, participant_index, seed, program_version, display, "
            "gaze_source, "
            "controller, device, driver, refresh_hz, view_width_px, view_height_px, view_fov_deg, "
            "simulated_people) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind_all(facts.uuid, facts.participant, plan.participant_index, bits(plan.seed),
                  facts.program_version, facts.display, facts.gaze_source, facts.controller, facts.device,
                  facts.driver, facts.refresh_hz, facts.view.size.width, facts.view.size.height,
                  facts.view.horizontal_fov_deg, facts.simulated_people)
        .run();
    Statement insert = database.prepare("INSERT INTO session_fact VALUES (?, ?)");
    for (const auto& [name, value] : facts.other) insert.bind_all(name, value).run();
}

void write_plan(Database& database, const TrialPlan& plan, const Protocol& protocol) {
    Statement parameter = database.prepare("INSERT INTO condition VALUES (?, ?, ?, ?)");
    for (int i = 0; i < static_cast<int>(protocol.conditions.size()); ++i) {
        const MethodSetting& setting = protocol.conditions[static_cast<std::size_t>(i)];
        parameter.bind_all(i, "method", std::nullopt, setting.method).run();
        for (const auto& [name, number] : setting.numbers)
            parameter.bind_all(i, name, number, std::nullopt).run();
        for (const auto& [name, word] : setting.words) parameter.bind_all(i, name, std::nullopt, word).run();
    }
    Statement insert = database.prepare("INSERT INTO plan VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const PlannedTrial& trial : plan.trials)
        insert
            .bind_all(trial.number, trial.session, trial.block, trial.position, kind_name(trial.kind),
                      trial.condition < 0 ? std::nullopt
                                          : std::optional(static_cast<std::int64_t>(trial.condition)),
                      trial.reference_interval, trial.scene, to_text(trial.first), to_text(trial.second))
            .run();
}

std::int64_t write_anchor(Database& database, ClockAnchor anchor) {
    database.prepare("INSERT INTO clock_anchor VALUES (NULL, ?, ?)")
        .bind_all(anchor.host.ns, anchor.wall_ns)
        .run();
    return database.last_row_id();
}

void write_trial(Database& database, const TrialRecord& record, std::int64_t anchor) {
    database
        .prepare(
            "INSERT INTO trial (trial, attempt, anchor, started_host_ns, valid, interrupted, level, "
            "content_hash) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
        .bind_all(record.planned.number, record.attempt, anchor, record.started.ns, record.invalid.empty(),
                  record.interrupted, record.level, bits(content_hash(record)))
        .run();
    const std::int64_t trial_id = database.last_row_id();
    write_intervals(database, record, trial_id);
    write_frames(database, record, trial_id);
    write_gaze(database, record, trial_id);
    write_controller_events(database, record, trial_id);
    if (record.answer)
        database.prepare("INSERT INTO response VALUES (?, ?, ?, ?, ?)")
            .bind_all(trial_id, record.answer->identical, button_name(record.answer->button),
                      record.answer->time.ns, record.answer->reaction.ns)
            .run();
    Statement flag = database.prepare("INSERT INTO flag VALUES (NULL, ?, 'invalid', ?)");
    for (const std::string& rule : record.invalid) flag.bind_all(trial_id, rule).run();
}

void write_gaze_between(Database& database, const std::string& phase, std::span<const GazeSample> samples,
                        std::int64_t anchor) {
    Statement insert = database.prepare(
        "INSERT INTO gaze_between VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const GazeSample& sample : samples) bind_sample(insert.bind_all(anchor, phase), sample).run();
}

void write_calibration(Database& database, const CalibrationRecord& record, std::int64_t anchor) {
    database.prepare("INSERT INTO calibration VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind_all(anchor, record.method, record.started.ns, record.ended.ns, record.accepted,
                  record.mean_accuracy_deg, record.worst_accuracy_deg, record.data_loss_share, record.kind)
        .run();
    const std::int64_t calibration = database.last_row_id();
    Statement insert =
        database.prepare("INSERT INTO validation_point VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    int n = 0;
    for (const CalibrationPoint& point : record.points)
        insert
            .bind_all(calibration, n++, point.target.azimuth_deg, point.target.elevation_deg,
                      azimuth(point.measured), elevation(point.measured), point.samples, point.valid_samples,
                      point.accuracy_deg, point.precision_rms_deg, point.precision_sd_deg)
            .run();
    write_gaze_between(database, record.kind, record.gaze, anchor);
}

std::string read_protocol_text(Database& database, std::string* file_name) {
    Statement row = database.prepare("SELECT protocol_text, protocol_file FROM experiment");
    if (!row.step())
        throw std::runtime_error(
            database.path() +
            ": expected a session with its protocol, found none; check that it is a session file");
    if (file_name) *file_name = row.text(1);
    return row.text(0);
}

TrialPlan read_plan(Database& database) {
    TrialPlan plan;
    Statement session = database.prepare("SELECT participant_index, seed FROM session");
    if (session.step()) {
        plan.participant_index = static_cast<int>(session.integer(0));
        plan.seed = std::bit_cast<std::uint64_t>(session.integer(1));
    }
    Statement row = database.prepare(
        "SELECT trial, session, block, position, kind, condition, reference_interval, scene, first_method, "
        "second_method "
        "FROM plan ORDER BY trial");
    while (row.step()) {
        PlannedTrial trial;
        trial.number = static_cast<int>(row.integer(0));
        trial.session = static_cast<int>(row.integer(1));
        trial.block = static_cast<int>(row.integer(2));
        trial.position = static_cast<int>(row.integer(3));
        for (const TrialKind kind : {TrialKind::training, TrialKind::condition, TrialKind::validation})
            if (kind_name(kind) == row.text(4)) trial.kind = kind;
        trial.condition = static_cast<int>(row.optional_integer(5).value_or(-1));
        trial.reference_interval = static_cast<int>(row.integer(6));
        trial.scene = row.text(7);
        trial.first = parse_method_setting(row.text(8));
        trial.second = parse_method_setting(row.text(9));
        plan.trials.push_back(std::move(trial));
    }
    return plan;
}

SessionFacts read_facts(Database& database) {
    SessionFacts facts;
    Statement row = database.prepare(
        "SELECT uuid, participant, program_version, display, gaze_source, controller, device, driver, "
        "refresh_hz, "
        "simulated_people, view_width_px, view_height_px, view_fov_deg FROM session");
    if (row.step()) {
        std::string* const fields[] = {&facts.uuid,    &facts.participant, &facts.program_version,
                                       &facts.display, &facts.gaze_source, &facts.controller,
                                       &facts.device,  &facts.driver};
        for (int i = 0; i < 8; ++i) *fields[i] = row.text(i);
        facts.refresh_hz = row.real(8);
        facts.simulated_people = row.integer(9) != 0;
        facts.view = {{static_cast<int>(row.integer(10)), static_cast<int>(row.integer(11))}, row.real(12)};
    }
    Statement other = database.prepare("SELECT name, value FROM session_fact");
    while (other.step()) facts.other[other.text(0)] = other.text(1);
    return facts;
}

std::vector<ShownTrial> read_shown(Database& database) {
    std::vector<ShownTrial> shown;
    Statement row = database.prepare(
        "SELECT trial, attempt, identical, valid, interrupted, superseded, level FROM trial LEFT JOIN "
        "response "
        "USING (trial_id) "
        "ORDER BY trial_id");
    while (row.step()) {
        ShownTrial trial;
        trial.number = static_cast<int>(row.integer(0));
        trial.attempt = static_cast<int>(row.integer(1));
        trial.answered = !row.is_null(2);
        trial.identical = row.integer(2) != 0;
        trial.valid = row.integer(3) != 0;
        trial.interrupted = row.integer(4) != 0;
        trial.superseded = row.integer(5) != 0;
        trial.level = row.optional_real(6);
        shown.push_back(trial);
    }
    return shown;
}

}  // namespace parafovea
