// parafovea export: session files as a BIDS 1.11 data set, or as one long CSV with a codebook.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>

#include "analysis/bids.h"
#include "analysis/bids_check.h"
#include "analysis/long_csv.h"
#include "app/commands.h"
#include "app/session_responses.h"
#include "study/session_log_reader.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

const std::vector<BidsColumn> kEventColumns = {
    {"trial", "Number of the planned trial, from 0", ""},
    {"kind", "condition or validation (two full-resolution pictures)", ""},
    {"first_method", "How the first interval's picture was drawn", ""},
    {"second_method", "How the second interval's picture was drawn", ""},
    {"reference_interval", "Which interval showed full resolution: 1 or 2", ""},
    {"scene", "The scene shown", ""},
    {"identical", "The answer: 1 the same, 0 different", ""},
    {"valid", "1 if no validity rule of the protocol was broken", ""},
    {"gap_onset", "When the black gap between the intervals began", "s"},
    {"question_onset", "When the question appeared", "s"},
};

const IntervalRecord& phase_of(const TrialRow& trial, Phase phase) {
    return trial.intervals.at(static_cast<std::size_t>(phase));
}

BidsEvent event_of(const TrialRow& trial, HostTime start) {
    const IntervalRecord& first = phase_of(trial, Phase::first_interval);
    const IntervalRecord& second = phase_of(trial, Phase::second_interval);
    const PlannedTrial& planned = trial.planned;
    const auto seconds = [&](HostTime time) { return (time - start).seconds(); };
    BidsEvent event;
    event.onset_s = seconds(first.first_display);
    event.duration_s = (second.end - first.first_display).seconds();
    event.trial_type = "pair";
    if (trial.answer) event.response_time_s = trial.answer->reaction.seconds();
    event.values = {
        std::to_string(planned.number),
        std::string(kind_name(planned.kind)),
        to_text(planned.first),
        to_text(planned.second),
        planned.kind == TrialKind::validation ? "n/a" : std::to_string(planned.reference_interval + 1),
        planned.scene,
        trial.answer ? (trial.answer->identical ? "1" : "0") : "n/a",
        trial.invalid.empty() ? "1" : "0",
        std::to_string(seconds(first.end)),
        std::to_string(seconds(phase_of(trial, Phase::question).first_display))};
    return event;
}

// The three recordings of one run: each eye where the tracker told them apart, and the cyclopean gaze.
class GazeRecordings {
  public:
    explicit GazeRecordings(HostTime start) : start_(start) {
        eyes_[0].eye = BidsEye::left;
        eyes_[1].eye = BidsEye::right;
        eyes_[2].eye = BidsEye::cyclopean;
    }

    void add(const GazeSample& sample) {
        const double time_s = (sample.host_time - start_).seconds();
        if (sample.left) add_eye(eyes_[0], time_s, sample.left->direction, sample.left->pupil_mm);
        if (sample.right) add_eye(eyes_[1], time_s, sample.right->direction, sample.right->pupil_mm);
        add_eye(eyes_[2], time_s, sample.direction, std::nullopt);
    }

    std::vector<BidsGaze> finish(const CalibrationRecord* calibration) {
        std::vector<BidsGaze> recordings;
        for (BidsGaze& eye : eyes_) {
            if (eye.samples.size() < 2) continue;
            const double span_s = eye.samples.back().timestamp_s - eye.samples.front().timestamp_s;
            eye.start_time_s = eye.samples.front().timestamp_s;
            // Trials are recorded, not the pauses between them: the median step is the tracker's rate.
            std::vector<double> steps;
            for (std::size_t i = 1; i < eye.samples.size(); ++i)
                steps.push_back(eye.samples[i].timestamp_s - eye.samples[i - 1].timestamp_s);
            std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                             steps.end());
            const double step_s = steps[steps.size() / 2];
            eye.sampling_hz = step_s > 0 ? 1 / step_s : static_cast<double>(eye.samples.size() - 1) / span_s;
            if (calibration) {
                eye.average_calibration_error_deg = calibration->mean_accuracy_deg;
                eye.maximal_calibration_error_deg = calibration->worst_accuracy_deg;
            }
            recordings.push_back(std::move(eye));
        }
        return recordings;
    }

  private:
    static void add_eye(BidsGaze& eye, double time_s, const std::optional<DirectionDeg>& direction,
                        std::optional<double> pupil_mm) {
        BidsGazeSample sample;
        sample.timestamp_s = time_s;
        if (direction) {
            sample.x = direction->azimuth_deg;
            sample.y = direction->elevation_deg;
        }
        if (pupil_mm) eye.pupil_description = "Pupil diameter in mm";
        sample.pupil = pupil_mm;
        eye.samples.push_back(sample);
    }

    HostTime start_;
    std::array<BidsGaze, 3> eyes_;
};

// One testing session of one participant.
BidsRun run_of(const SessionRows& session, const fs::path& file, int testing_session) {
    BidsRun run;
    run.participant = session.facts.participant;
    run.event_columns = kEventColumns;
    const Protocol protocol = parse_protocol(session.protocol_text, session.protocol_file);
    run.screen_refresh_hz = session.facts.refresh_hz;
    run.screen_resolution_px = {protocol.display.view.size.width, protocol.display.view.size.height};

    std::optional<HostTime> start;
    std::optional<GazeRecordings> gaze;
    for (const TrialRow& trial : session.trials) {
        if (trial.planned.session != testing_session || trial.interrupted || trial.superseded) continue;
        if (!start) {
            start = trial.started;
            gaze.emplace(*start);
        }
        if (trial.started < *start)
            throw std::runtime_error(
                file.string() +
                ": this session was resumed after its host clock began anew, so its trials have no "
                "common time; export it as --format csv");
        run.events.push_back(event_of(trial, *start));
        for (const GazeSample& sample : read_gaze(file, trial.planned.number, trial.attempt))
            gaze->add(sample);
    }
    if (gaze) run.gaze = gaze->finish(session.last_calibration());
    return run;
}

// The questionnaires that anybody answered, each with every item that was answered.
std::vector<BidsQuestionnaire> questionnaires_of(const std::vector<ListedSession>& sessions) {
    std::map<std::string, BidsQuestionnaire> by_name;
    for (const auto& [file, head] : sessions) {
        for (const auto& [name, answers] : head.questionnaires) {
            BidsQuestionnaire& questionnaire = by_name[name];
            if (questionnaire.items.empty()) {
                questionnaire.name = bids_label(name);
                questionnaire.description = "Questionnaire " + name;
                for (const auto& [item, answer] : answers) questionnaire.items.push_back({item, item, ""});
            }
            BidsParticipant row{head.facts.participant, {}};
            for (const BidsColumn& item : questionnaire.items) {
                const auto answer = answers.find(item.name);
                row.values.push_back(answer == answers.end() ? "n/a" : answer->second);
            }
            questionnaire.answers.push_back(std::move(row));
        }
    }
    std::vector<BidsQuestionnaire> list;
    for (auto& [name, questionnaire] : by_name) list.push_back(std::move(questionnaire));
    return list;
}

// One session's rows are in memory at a time.
void export_bids(const std::vector<std::string>& inputs, const fs::path& out) {
    const SessionList list = list_sessions(input_files(inputs));
    for (const std::string& problem : list.problems) std::fprintf(stderr, "parafovea: %s\n", problem.c_str());
    if (list.sessions.empty())
        throw std::runtime_error("no session with an answer in the input; nothing to export");

    BidsDataset dataset;
    dataset.name = list.sessions.front().head.protocol_name;
    dataset.software_version = PARAFOVEA_VERSION;
    std::set<std::string> people;
    for (const auto& [file, head] : list.sessions) {
        if (head.facts.simulated_people) dataset.data_origin = "simulated participants";
        if (people.insert(head.facts.participant).second)
            dataset.participants.push_back({head.facts.participant, {}});
    }
    dataset.questionnaires = questionnaires_of(list.sessions);

    BidsWriter writer(out, dataset);
    std::map<std::string, int> runs;  // written of each participant: several files of one go on counting
    for (const auto& [file, head] : list.sessions) {
        const SessionRows session = read_session(file);
        std::set<int> testing_sessions;
        for (const TrialRow& trial : session.trials)
            if (trial.planned.session > 0) testing_sessions.insert(trial.planned.session);
        for (const int testing_session : testing_sessions) {
            BidsRun run = run_of(session, file, testing_session);
            run.run = ++runs[run.participant];
            writer.write(run);
        }
    }
    const std::vector<BidsViolation> violations = check_bids(out);
    for (const BidsViolation& violation : violations)
        std::fprintf(stderr, "parafovea: %s: %s\n", violation.file.c_str(), violation.text.c_str());
    std::printf("%zu files, %zu violations of the checked BIDS rules\n", writer.written().size(),
                violations.size());
}

void export_csv(const std::vector<std::string>& inputs, const fs::path& out) {
    LongCsvWriter writer(out);
    const StudyData data = read_study(inputs, [&](const Response& response) { writer.write(response); });
    writer.finish();
    for (const std::string& problem : data.problems) std::fprintf(stderr, "parafovea: %s\n", problem.c_str());
    std::printf("%s\n%s\n", writer.table().c_str(), writer.codebook().c_str());
}

}  // namespace

ExportCommand::ExportCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("export", "Write session files as BIDS 1.11 or as one long CSV");
    command->footer("Example: parafovea export demo_study --format bids --out demo_bids");
    command->add_option("inputs", inputs_, "Session files or folders of them")->required();
    command->add_option("--format", format_, "bids or csv")
        ->required()
        ->check(CLI::IsMember({"bids", "csv"}));
    command->add_option("--out", out_, "Folder to write")->required();
    command->callback([this] { run(); });
}

void ExportCommand::run() const {
    if (format_ == "bids")
        export_bids(inputs_, out_);
    else
        export_csv(inputs_, out_);
}

}  // namespace parafovea
