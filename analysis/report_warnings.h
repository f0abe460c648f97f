// What a reader must be warned of, found by looking at the data as a careful reviewer would.
#pragma once

#include <string>
#include <vector>

#include "analysis/cochran_table.h"
#include "analysis/condition_table.h"
#include "analysis/study_description.h"
#include "analysis/tally.h"
#include "analysis/validation.h"

namespace parafovea {

struct ReportWarning {
    std::string subject;  // a few words, the same for every study
    std::string text;     // what was found, with its numbers, and what follows from it
};

// Looks for: rows that are not independent, ceiling, too few informative blocks, failed validation,
// participants who give one answer only, dropped frames or lost gaze that differ between conditions, a
// preference for one interval, a sample size that was not planned, exclusions without stored rules or uneven
// between conditions, incomplete blocks, several sites.
std::vector<ReportWarning> find_warnings(const Tally& tally, const StudyDescription& study,
                                         const std::vector<ConditionRow>& conditions,
                                         const CochranTable& cochran,
                                         const std::vector<ValidationRow>& validation);

// F test of equal means over groups from their running summaries; absent with fewer than two groups of two or
// no variance.
std::optional<double> equal_means_p(const std::vector<RunningMoments>& groups);

}  // namespace parafovea
