// Writes a study as a BIDS 1.11 data set: events, eye tracking, motion, participants and questionnaires.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace parafovea {

// All times are seconds from the start of the run, on one clock.
struct BidsEvent {
    double onset_s = 0.0;
    std::optional<double> duration_s;
    std::string trial_type;  // empty: n/a, here and below
    std::optional<double> response_time_s;
    std::vector<std::string> values;  // of BidsRun::event_columns, in order
};

struct BidsGazeSample {
    double timestamp_s = 0.0;
    std::optional<double> x, y;  // absent where the eye was lost
    std::optional<double> pupil;
};

struct BidsGazeEvent {
    double onset_s = 0.0;
    std::optional<double> duration_s;
    std::string trial_type;  // "fixation", "saccade", "blink", ...
    std::string message;
};

enum class BidsEye { left, right, cyclopean };

struct BidsGaze {
    BidsEye eye = BidsEye::cyclopean;
    double sampling_hz = 0.0;
    double start_time_s = 0.0;
    bool on_screen = false;  // x and y in pixels of the screen; otherwise degrees in the head
    std::string
        pupil_description;  // must say area or diameter, with its unit; empty when the pupil was not measured
    std::optional<double> average_calibration_error_deg, maximal_calibration_error_deg;
    std::string manufacturer, model, software_version;
    std::vector<BidsGazeSample> samples;
    std::vector<BidsGazeEvent> events;
};

struct BidsPose {
    double latency_s = 0.0;  // since the first sample
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;
    double quat_x = 0.0, quat_y = 0.0, quat_z = 0.0, quat_w = 1.0;
};

struct BidsColumn {
    std::string name;
    std::string description;
    std::string units;  // empty: none
};

struct BidsRun {
    std::string participant;
    int session = 1;
    int run = 1;
    std::vector<BidsColumn> event_columns;  // after onset, duration, trial_type and response_time
    std::vector<BidsEvent> events;          // sorted by onset when written
    std::vector<BidsGaze> gaze;             // at most one per eye
    double motion_hz = 0.0;
    std::vector<BidsPose> motion;  // of the head-mounted display
    std::optional<double> screen_refresh_hz;
    std::optional<std::pair<int, int>> screen_resolution_px;
    std::optional<std::pair<double, double>> screen_size_m;
    std::optional<double> screen_distance_m;
    std::string acquired;  // date and time, ISO 8601; empty: n/a
};

struct BidsParticipant {
    std::string id;
    std::vector<std::string> values;  // of BidsDataset::participant_columns
};

struct BidsQuestionnaire {
    std::string name;  // letters and digits, such as "ssq"
    std::string description;
    std::vector<BidsColumn> items;
    std::vector<BidsParticipant> answers;
};

struct BidsDataset {
    std::string name;
    std::string data_origin;  // "simulated participants", empty for people
    std::string license = "n/a";
    std::vector<std::string> authors;
    std::string task = "pairs";
    std::string task_description = "Two pictures after one another: do they look identical or different?";
    std::string software_name = "Parafovea";
    std::string software_version;
    std::vector<BidsColumn> participant_columns;
    std::vector<BidsParticipant> participants;
    std::vector<BidsQuestionnaire> questionnaires;
};

// Writes run by run, so that a study never has to be in memory at once.
class BidsWriter {
  public:
    // Makes the folder and the files of the whole set. Throws std::runtime_error when it cannot be written,
    // or when two participants would get the same label (BIDS allows letters and digits only).
    BidsWriter(const std::filesystem::path& folder, const BidsDataset& dataset);

    // Throws std::runtime_error for a participant the data set does not have, a run written before, two
    // recordings of one eye, events whose values do not fit the columns, or a pupil without a description.
    void write(const BidsRun& run);

    const std::vector<std::filesystem::path>& written() const { return written_; }

  private:
    void write_events(const BidsRun& run, const std::filesystem::path& stem);
    void write_gaze(const BidsRun& run, const BidsGaze& gaze, const std::filesystem::path& stem);
    void write_motion(const BidsRun& run, const std::filesystem::path& folder, const std::string& prefix);
    void put(const std::filesystem::path& path, const std::string& text);
    void put_compressed(const std::filesystem::path& path, const std::string& text);

    std::filesystem::path folder_;
    BidsDataset dataset_;
    std::set<std::string> labels_;
    std::set<std::filesystem::path> scans_;
    std::set<std::string> runs_;
    std::vector<std::filesystem::path> written_;
};

// A participant's label: the letters and digits of the identifier.
std::string bids_label(const std::string& identifier);

}  // namespace parafovea
