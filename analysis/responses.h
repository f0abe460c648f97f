// One answered trial as the analysis sees it, and the reader of response tables kept as CSV.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace parafovea {

struct Response {
    std::string participant;
    int session = 1;
    double sigma = 0.0;
    double alpha = 0.0;
    // The participant's answer: "the two pictures were the same".
    bool identical = false;
    // Both pictures were drawn at full resolution; sigma and alpha mean nothing then.
    bool validation = false;
    std::string method;  // how the reduced picture was drawn ("kfr"), empty when not known
    std::string scene;
    std::string site;                    // where it was recorded, for studies with several laboratories
    int block = 0;                       // of the session
    int trial = 0;                       // index in the session
    std::optional<bool> foveated_first;  // interval order
    std::optional<double> response_time_s;
    std::optional<double> dropped_frames;  // share of the trial's refreshes that were missed, 0 to 1
    std::optional<double> gaze_loss;       // share of the trial's gaze samples without a gaze, 0 to 1
    bool answered = true;                  // false only together with an excluded_reason
    // Empty: counted. Otherwise set by the rules stored before the session ("no answer", ...).
    std::string excluded_reason;
};

// Reads a table with a header line. Columns participant, session, sigma, alpha, identical are required;
// validation, method, scene, site, block, trial, foveated_first, response_time_s, dropped_frames, gaze_loss
// and excluded_reason are used where present; any other column is ignored. An empty "identical" is no answer
// and needs an excluded_reason. Quotes as in RFC 4180; blank lines are skipped. Throws std::runtime_error
// "FILE:LINE: what, and what was expected" on the first row that cannot be read.
std::vector<Response> read_responses_csv(const std::filesystem::path& path);

// The same, one row at a time, for tables that should not be held in memory.
void for_each_response_csv(const std::filesystem::path& path,
                           const std::function<void(const Response&)>& row);

}  // namespace parafovea
