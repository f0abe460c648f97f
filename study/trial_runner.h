// One trial from lead-in to answer.
#pragma once

#include <functional>
#include <stop_token>

#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/gaze_source.h"
#include "study/protocol.h"
#include "study/stage.h"
#include "study/trial_plan.h"
#include "study/trial_record.h"

namespace parafovea {

// Whole frames nearest to a duration, halves up: 0.75 s at 90 Hz is 68.
int frames_from_seconds(double seconds, double refresh_hz);

// What reaches into a running trial from outside. Both may be left empty.
struct TrialControl {
    std::stop_token stop;  // ends the trial as interrupted at the next frame
    std::function<bool()>
        stimulus_ready;  // asked at the end of the lead-in, which goes on until it says true
};

// Lead-in, first interval, black gap, second interval, question. Every frame: drain the gaze, choose the
// fovea, show, drain the controller. The answer is the first press of one of the two answer keys at or after
// the moment at which the question was first displayed, and within the response window.
TrialRecord run_trial(const PlannedTrial& trial, const Protocol& protocol, Stage& stage, GazeSource& gaze,
                      ControllerSource& controller, Clock& clock, const TrialControl& control = {});

}  // namespace parafovea
