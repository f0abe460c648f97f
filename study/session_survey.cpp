// What an overview of many session files needs of each, in few and light queries.
#include "study/session_survey.h"

#include <stdexcept>

#include "study/database.h"
#include "study/migrations.h"
#include "study/session_rows.h"

namespace parafovea {
namespace {

// A statement that is prepared once and run for every showing.
Statement& prepared(Database& database, std::unique_ptr<Statement>& statement, const char* sql) {
    if (!statement) statement = std::make_unique<Statement>(database.prepare(sql));
    return statement->reset();
}

}  // namespace

SessionSurvey::SessionSurvey(const std::filesystem::path& path) : database_(open_for_reading(path)) {}

SessionSurvey::~SessionSurvey() = default;

SessionHead SessionSurvey::head() {
    SessionHead head;
    Statement experiment =
        database_->prepare("SELECT name, protocol_text, protocol_file, protocol_hash FROM experiment");
    if (!experiment.step())
        throw std::runtime_error(
            database_->path() +
            ": expected a session with its protocol, found none; check that it is a session file");
    head.protocol_name = experiment.text(0);
    head.protocol_text = experiment.text(1);
    head.protocol_file = experiment.text(2);
    head.protocol_hash = experiment.text(3);
    head.facts = read_facts(*database_);
    Statement answers = database_->prepare("SELECT count(*) FROM response");
    if (answers.step()) head.answers = answers.integer(0);
    Statement answer = database_->prepare(
        "SELECT name, question, answer FROM questionnaire JOIN questionnaire_answer USING (questionnaire) "
        "ORDER BY questionnaire");
    while (answer.step()) head.questionnaires[answer.text(0)][answer.text(1)] = answer.text(2);
    return head;
}

std::vector<FrameTime> SessionSurvey::frame_times(int trial_number, int attempt) {
    std::vector<FrameTime> frames;
    Statement& row = prepared(
        *database_, frames_,
        "SELECT phase, display_host_ns, gaze_age_ns FROM trial JOIN frame USING (trial_id) WHERE trial = ? "
        "AND attempt = ? ORDER BY frame");
    row.bind_all(trial_number, attempt);
    while (row.step()) {
        FrameTime frame{static_cast<Phase>(row.integer(0)), {row.integer(1)}, {}};
        if (const auto age = row.optional_integer(2)) frame.gaze_age = Duration{*age};
        frames.push_back(frame);
    }
    return frames;
}

std::vector<GazeDirection> SessionSurvey::gaze_directions(int trial_number, int attempt) {
    std::vector<GazeDirection> samples;
    Statement& row = prepared(
        *database_, gaze_,
        "SELECT host_ns, azimuth_deg, elevation_deg FROM trial JOIN gaze USING (trial_id) WHERE trial = ? "
        "AND attempt = ? ORDER BY n");
    row.bind_all(trial_number, attempt);
    while (row.step()) {
        GazeDirection sample{{row.integer(0)}, {}};
        if (!row.is_null(1)) sample.direction = DirectionDeg{row.real(1), row.real(2)};
        samples.push_back(sample);
    }
    return samples;
}

}  // namespace parafovea
