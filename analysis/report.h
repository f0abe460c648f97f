// report.html: what the study found, in words, figures and tables, with what a reviewer asks for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/cochran_table.h"
#include "analysis/condition_table.h"
#include "analysis/decision.h"
#include "analysis/psychometric_results.h"
#include "analysis/recordings.h"
#include "analysis/report_warnings.h"
#include "analysis/study_description.h"
#include "analysis/summary_tables.h"
#include "analysis/tally.h"
#include "analysis/validation.h"

namespace parafovea {

// Everything the analysis has computed of one study.
struct StudyResults {
    std::vector<ConditionRow> conditions;
    CochranTable cochran;
    PsychometricResults psychometric;
    Decision decision;
    std::vector<SigmaEffects> effects;
    std::vector<SensitivityRow> sensitivity;                      // empty without validation trials
    std::vector<ParticipantSensitivity> participant_sensitivity;  // the same
    std::vector<ValidationRow> validation;                        // the same
    std::vector<ResponseTimeRow> response_times;                  // empty when not measured
    std::vector<ConditionRow> without_exclusions;                 // empty without exclusions
    std::vector<ReportWarning> warnings;
    std::vector<std::pair<std::string, std::string>> figures;  // name and <svg> element
};

std::string report_html(const Tally& tally, const StudyDescription& study, const StudyRecordings& recordings,
                        const StudyResults& results);

}  // namespace parafovea
