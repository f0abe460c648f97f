// Figures and a table of how well gaze and timing were recorded.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/recordings.h"
#include "analysis/study_description.h"

namespace parafovea {

// A heat map of gaze, on a scale of the share of samples per square degree. Throws std::runtime_error when
// the counts do not fill the grid.
std::string gaze_figure_script(const GazeHeatMap& gaze, const StudyDescription& study,
                               const std::filesystem::path& stem);

// Frame intervals as a histogram with a logarithmic count axis, so that single missed frames are seen.
std::string timing_figure_script(const FrameTimes& frames, const StudyDescription& study,
                                 const std::filesystem::path& stem);

// CSV: participant, session, accuracy_deg, precision_deg, gaze_loss, gaze_hz, gaze_age_ms, frames, missed.
std::string quality_csv(const StudyRecordings& recordings);

}  // namespace parafovea
