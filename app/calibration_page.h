// Shows calibration targets where the stimuli are shown, and measures how well the gaze follows them.
#pragma once

#include <optional>
#include <stop_token>

#include "devices/clock.h"
#include "devices/gaze_source.h"
#include "study/protocol.h"
#include "study/session_log.h"
#include "study/stage.h"

namespace parafovea {

// The tracker is not changed: what is measured is how good the calibration it has is, through the very
// pictures and optics of the stimuli. None where it was stopped.
std::optional<CalibrationRecord> measure_calibration(Stage& stage, GazeSource& gaze, Clock& clock,
                                                     const CalibrationRules& rules, std::stop_token stop);

// One target in the middle, where the participant is to look in every trial: accepted where the gaze lies on
// it by the rules' drift_check_deg. None where it was stopped.
std::optional<CalibrationRecord> measure_drift(Stage& stage, GazeSource& gaze, Clock& clock,
                                               const CalibrationRules& rules, std::stop_token stop);

}  // namespace parafovea
