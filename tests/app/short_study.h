// A study of a few short trials with tiny pictures, and the program running it, for tests of whole sessions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/session_file.h"
#include "tests/temporary_folder.h"

namespace parafovea {

// What the tests need differently.
struct ShortStudy {
    std::string view = "width_px = 96\nheight_px = 64\nhorizontal_fov_deg = 40";
    std::string gaze = "center";
    double interval_s = 0.8;
    double gap_s = 0.2;
    std::string sigmas = "1.2, 2.4";
    std::string alphas = "1, 4";
    int training_trials = 1;
    int sessions = 2;
    double validation_share = 0.2;
    bool pages = true;   // of text, beside the question
    std::string tables;  // more of them
};

inline std::string short_study_toml(const ShortStudy& study = {}) {
    return R"(name = "short"
kind = "final"
description = "A few short trials"
language = "en"
scenes = ["primitives"]
[display]
)" + study.view +
           R"(
refresh_hz = 70
[foveation]
gaze = ")" +
           study.gaze + R"("
[timing]
lead_in_s = 0.1
lead_in = "fixation"
interval_s = )" +
           std::to_string(study.interval_s) + R"(
gap_s = )" +
           std::to_string(study.gap_s) + R"(
[conditions]
method = "kfr"
reference = "full"
[conditions.factors]
sigma = [)" +
           study.sigmas + R"(]
alpha = [)" +
           study.alphas + R"(]
[design]
training_trials = )" +
           std::to_string(study.training_trials) + R"(
sessions = )" +
           std::to_string(study.sessions) + R"(
validation_share = )" +
           std::to_string(study.validation_share) + R"(
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
)" + study.tables +
           R"([texts.en]
question = "The same?\n\nA  the same\nB  different"
)" +
           (study.pages ? R"(introduction = "Welcome."
calibration = "Follow the dot."
training = "Practice."
session = "Part {session} of {sessions}."
rest = "Rest."
rest_after_failed_validation = "Rest a little."
paused = "A pause."
finished = "That was all."
)"
                        : "");
}

// The words of a command that runs `short.toml` of a folder without a display, its sessions in `data` there.
inline std::vector<std::string> headless_run(const TemporaryFolder& folder, const std::string& data,
                                             const std::string& gaze = "simulated") {
    return {PARAFOVEA_PROGRAM,
            "run",
            (folder / "short.toml").string(),
            "--participant",
            "P03",
            "--seed",
            "11",
            "--display",
            "headless",
            "--gaze",
            gaze,
            "--controller",
            "simulated",
            "--quiet",
            "--data",
            (folder / data).string()};
}

// Its session; empty where there is none.
inline std::filesystem::path short_session(const TemporaryFolder& folder, const std::string& data) {
    return latest_session_file(folder / data, "short", "P03");
}

}  // namespace parafovea
