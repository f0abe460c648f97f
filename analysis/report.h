// report.html: what the study found, in words, figures and tables, with what a reviewer asks for.
#pragma once

#include <string>

#include "analysis/cochran_table.h"
#include "analysis/condition_table.h"
#include "analysis/study_description.h"
#include "analysis/tally.h"

namespace parafovea {

struct ReportInputs {
    const Tally& tally;
    const StudyDescription& study;
    const std::vector<ConditionRow>& conditions;
    const CochranTable& cochran;
    std::string figure_svg;  // an <svg> element
};

std::string report_html(const ReportInputs& inputs);

}  // namespace parafovea
