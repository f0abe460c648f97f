// Plots of psychometric functions: one panel per alpha for everybody, one per participant.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/psychometric_results.h"
#include "analysis/study_description.h"

namespace parafovea {

// Writes stem.svg, .pdf and .png: answers, fitted curves, the criterion and each threshold with its 95 %
// interval (over people; credible for one participant).
std::string psychometric_figure_script(const PsychometricResults& results, const StudyDescription& study,
                                       const std::filesystem::path& stem);

// One small panel per participant, a curve and points per alpha. Nothing to draw without individual fits.
std::string participants_figure_script(const PsychometricResults& results, const StudyDescription& study,
                                       const std::filesystem::path& stem);

std::string psychometric_figure_description(const PsychometricResults& results,
                                            const StudyDescription& study);

}  // namespace parafovea
