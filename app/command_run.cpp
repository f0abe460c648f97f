// parafovea run: a real session.
#include <cstdio>
#include <stdexcept>

#include "app/commands.h"
#include "app/live_session.h"
#include "app/progress.h"
#include "app/stop_on_signal.h"
#include "study/protocol.h"
#include "study/trial_plan.h"

namespace parafovea {

RunCommand::RunCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("run", "Run a session with a participant");
    command->footer("Example: parafovea run protocols/final.toml --participant P01 --data sessions");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    command->add_option("--participant", participant_, "Pseudonym ending in a number, such as P01")
        ->required();
    command->add_option("--data", data_, "Folder for the session file")->capture_default_str();
    command->add_option("--display", display_, "Where the pictures are shown")
        ->check(CLI::IsMember({"openxr", "window", "headless"}))
        ->capture_default_str();
    command->add_option("--gaze", gaze_,
                        "Eye tracker: openxr, hid, fove, gazepoint[:HOST:PORT], mouse, simulated, "
                        "replay:FILE; openxr in a headset, "
                        "mouse in a window, else simulated, if absent");
    command->add_option("--controller", controller_,
                        "Answers: auto, evdev, hidapi, libusb, gamepad, keyboard, simulated; auto in a "
                        "headset or window, else simulated, if absent");
    command->add_option("--seed", seed_, "Seed of every random draw; drawn and stored if absent");
    command->add_flag("--resume", resume_, "Go on with the participant's latest session of this study");
    command->add_option("--monitor", monitor_, "Which monitor shows the window, from 0")
        ->capture_default_str();
    command->add_flag("--full-screen", full_screen_, "The window takes the whole monitor");
    command->add_flag("--no-console", no_console_, "No operator's console beside the participant's window");
    command->add_flag(
        "--hash-pictures", hash_pictures_,
        "With --display openxr: store a hash of every stimulus, so that replay --verify compares "
        "pictures too; costs time in every frame");
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] { run(); });
}

void RunCommand::run() const {
    std::stop_source stop;
    const StopOnSignal stop_on_signal(stop);

    const bool headset = display_ == "openxr", window = display_ == "window";
    const std::string gaze = !gaze_.empty() ? gaze_ : headset ? "openxr" : window ? "mouse" : "simulated";
    const std::string controller = !controller_.empty() ? controller_
                                   : headset || window  ? "auto"
                                                        : "simulated";
    const LiveSessionRequest request{protocol_, participant_, data_,        display_,
                                     gaze,      controller,   seed_,        resume_,
                                     monitor_,  full_screen_, !no_console_, hash_pictures_};
    const int trials = static_cast<int>(make_plan(load_protocol(protocol_), 0, 0).trials.size());
    LiveSessionOutcome outcome;
    {
        Progress bar("trial", trials, quiet_);
        outcome = run_live_session(request, stop, [&](const SessionProgress& progress) {
            bar.update(progress.done, progress.next ? to_text(progress.next->reference_interval == 0
                                                                  ? progress.next->second
                                                                  : progress.next->first) +
                                                          ", " + progress.next->scene
                                                    : progress.state);
        });
    }
    std::printf("%s\n", outcome.file.c_str());
    if (outcome.end == SessionEnd::stopped)
        throw std::runtime_error("stopped before the end; go on with: parafovea run " + protocol_ +
                                 " --participant " + participant_ + " --data " + data_ + " --resume");
}

}  // namespace parafovea
