// Shows calibration targets where the stimuli are shown, and measures how well the gaze follows them.
#pragma once

#include <optional>
#include <stop_token>

#include "devices/clock.h"
#include "devices/gaze_source.h"
#include "study/session_log.h"
#include "study/stage.h"

namespace parafovea {

struct CalibrationPageSettings {
    int targets = 9;  // 5, 9 or 13
    // Farthest target from straight ahead; less where the picture ends sooner.
    double extent_deg = 15;
    Duration each{1'500'000'000};  // the first half second is the eye's way there and is not used
    // Accepted: mean accuracy and loss no worse than this, and data at every target.
    double greatest_mean_accuracy_deg = 2;
    double greatest_loss_percent = 20;
};

// The tracker is not changed: what is measured is how good the calibration it has is, through the very
// pictures and optics of the stimuli. None where it was stopped.
std::optional<CalibrationRecord> measure_calibration(Stage& stage, GazeSource& gaze, Clock& clock,
                                                     std::stop_token stop,
                                                     const CalibrationPageSettings& settings = {});

}  // namespace parafovea
