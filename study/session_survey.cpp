// What an overview of many session files needs of each, in few and light queries.
#include "study/session_survey.h"

#include <stdexcept>

#include "study/database.h"
#include "study/migrations.h"
#include "study/session_rows.h"

namespace parafovea {

// The rows of a table in the order of its showings, taken one showing at a time.
class SessionSurvey::Rows {
  public:
    // The first column is the trial_id.
    Rows(Database& database, const char* sql) : row_(database.prepare(sql)), more_(row_.step()) {}

    template <typename Take>
    void take(int shown, Take&& take_row) {
        const std::int64_t trial_id = shown + 1;
        for (; more_ && row_.integer(0) < trial_id; more_ = row_.step()) {
        }
        for (; more_ && row_.integer(0) == trial_id; more_ = row_.step()) take_row(row_);
    }

  private:
    Statement row_;
    bool more_;
};

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

std::vector<FrameTime> SessionSurvey::frame_times(int shown) {
    if (!frames_)
        frames_ = std::make_unique<Rows>(
            *database_,
            "SELECT trial_id, phase, display_host_ns, gaze_age_ns FROM frame ORDER BY trial_id, frame");
    std::vector<FrameTime> frames;
    frames_->take(shown, [&](const Statement& row) {
        FrameTime frame{static_cast<Phase>(row.integer(1)), {row.integer(2)}, {}};
        if (const auto age = row.optional_integer(3)) frame.gaze_age = Duration{*age};
        frames.push_back(frame);
    });
    return frames;
}

std::vector<GazeDirection> SessionSurvey::gaze_directions(int shown) {
    if (!gaze_)
        gaze_ = std::make_unique<Rows>(
            *database_,
            "SELECT trial_id, host_ns, azimuth_deg, elevation_deg FROM gaze ORDER BY trial_id, n");
    std::vector<GazeDirection> samples;
    gaze_->take(shown, [&](const Statement& row) {
        GazeDirection sample{{row.integer(1)}, {}};
        if (!row.is_null(2)) sample.direction = DirectionDeg{row.real(2), row.real(3)};
        samples.push_back(sample);
    });
    return samples;
}

}  // namespace parafovea
