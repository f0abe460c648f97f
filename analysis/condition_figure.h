// Figures 9 and 10: P_I against sigma^2, one series per alpha.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/condition_table.h"
#include "analysis/study_description.h"

namespace parafovea {

// A gnuplot script that writes stem.svg, stem.pdf and stem.png. Error bars are one standard error.
std::string condition_figure_script(const std::vector<ConditionRow>& rows, std::int64_t participants,
                                    const StudyDescription& study, const std::filesystem::path& stem);

// The figure in words, for readers who cannot see it.
std::string condition_figure_description(const std::vector<ConditionRow>& rows,
                                         const StudyDescription& study);

}  // namespace parafovea
