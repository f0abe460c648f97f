// A study of a few short trials with tiny pictures, for tests that run whole sessions.
#pragma once

#include <string>

namespace parafovea {

// `extra` stands before the first table: top-level keys.
inline std::string short_study_toml(const std::string& gaze_policy = "center",
                                    const std::string& lead_in_s = "0.1",
                                    const std::string& interval_s = "0.8", const std::string& gap_s = "0.2") {
    return R"(name = "short"
kind = "final"
description = "A few short trials"
language = "en"
scenes = ["primitives"]
[display]
width_px = 96
height_px = 64
horizontal_fov_deg = 40
refresh_hz = 70
[foveation]
gaze = ")" +
           gaze_policy + R"("
[timing]
lead_in_s = )" +
           lead_in_s + R"(
lead_in = "fixation"
interval_s = )" +
           interval_s + R"(
gap_s = )" +
           gap_s + R"(
[conditions]
method = "kfr"
reference = "full"
[conditions.factors]
sigma = [1.2, 2.4]
alpha = [1, 4]
[design]
training_trials = 1
sessions = 2
validation_share = 0.2
condition_order = "williams"
interval_order = "balanced"
scene_use = "per_session"
[rests]
after_session = true
after_failed_validation = true
[keys]
same = "a"
different = "b"
proceed = "a"
[texts.en]
introduction = "Welcome."
calibration = "Follow the dot."
training = "Practice."
session = "Part {session} of {sessions}."
question = "The same?\n\nA  the same\nB  different"
rest = "Rest."
rest_after_failed_validation = "Rest a little."
paused = "A pause."
finished = "That was all."
)";
}

}  // namespace parafovea
