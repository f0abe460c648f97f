// The way in for programs: responses in, every figure, table and report file out.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/responses.h"
#include "analysis/study_description.h"

namespace parafovea {

struct AnalysisFiles {
    std::filesystem::path report;                // report.html
    std::filesystem::path figure;                // figure10.svg, or figure9.svg for a pilot study
    std::filesystem::path table;                 // table1.csv
    std::vector<std::filesystem::path> written;  // every file, these included
};

// Analyses the responses and writes the files into out, which is made if absent.
// Throws std::runtime_error when there is no countable response, out cannot be written or gnuplot cannot be
// run.
AnalysisFiles write_analysis(std::span<const Response> responses, const StudyDescription& study,
                             const std::filesystem::path& out);

// Table 1 (Cochran's Q across alpha, per sigma) as plain text for a terminal, its blocks stated.
std::string table1_text(std::span<const Response> responses, const StudyDescription& study);

}  // namespace parafovea
