// The way in for programs: responses in, every figure, table and report file out.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/recordings.h"
#include "analysis/responses.h"
#include "analysis/study_description.h"
#include "analysis/tally.h"

namespace parafovea {

struct AnalysisFiles {
    std::filesystem::path report;                // report.html
    std::filesystem::path figure;                // figure10.svg, or figure9.svg for a pilot study
    std::filesystem::path table;                 // table1.csv
    std::vector<std::filesystem::path> written;  // every file, these included
    std::string table1;                          // Table 1 as plain text for a terminal, its blocks stated
};

// Takes responses one by one, so that studies of any size need no list of them: hundreds of logs stream
// through here.
class StudyTally {
  public:
    void add(const Response& response) {
        applied_.add(response);
        ignored_.add(response);
    }
    const Tally& with_exclusions() const { return applied_; }
    const Tally& all_answers() const { return ignored_; }

  private:
    Tally applied_{Exclusions::applied};
    Tally ignored_{Exclusions::ignored};
};

// Analyses the responses and writes the files into out, which is made if absent:
//   figure10.{svg,png,pdf,csv} (figure9 for a pilot), table1.{csv,md}, report.html, pairwise.csv,
//   psychometric.{csv,svg,png,pdf}, and where the data hold them: participants.{svg,png,pdf} (fits one by
//   one), sensitivity.csv, sensitivity_participants.csv and validation.csv (validation trials),
//   response_times.csv, exclusions.csv, gaze.* , timing.* and quality.csv (recordings).
// Throws std::runtime_error when there is no countable response, out cannot be written or gnuplot cannot be
// run.
AnalysisFiles write_analysis(const StudyTally& tally, const StudyDescription& study,
                             const StudyRecordings& recordings, const std::filesystem::path& out);
AnalysisFiles write_analysis(std::span<const Response> responses, const StudyDescription& study,
                             const std::filesystem::path& out);

// Table 1 (Cochran's Q across alpha, per sigma) alone, as plain text for a terminal.
std::string table1_text(std::span<const Response> responses, const StudyDescription& study);

}  // namespace parafovea
