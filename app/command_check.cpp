// parafovea check: what a protocol would do, or each of its mistakes with its line.
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "app/commands.h"
#include "study/protocol.h"
#include "study/trial_plan.h"
#include "study/trial_runner.h"
#include "study/word_list.h"

namespace parafovea {

namespace {

void print_duration(const char* what, double seconds, double refresh_hz) {
    const int frames = frames_from_seconds(seconds, refresh_hz);
    std::printf("%-22s %.4g s: %d frames at %.4g Hz, realised %.4f s\n", what, seconds, frames, refresh_hz,
                frames / refresh_hz);
}

}  // namespace

CheckCommand::CheckCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "check", "Read a protocol and say what it would do, or each mistake with its line");
    command->footer("Example: parafovea check protocols/final.toml");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    command->callback([this] { run(); });
}

void CheckCommand::run() const {
    const Protocol protocol = load_protocol(protocol_);
    const TrialPlan plan = make_plan(protocol, 0, 1);

    std::printf("%-22s %s (hash %s)\n", "protocol", protocol.name.c_str(), protocol_hash(protocol).c_str());
    std::printf("%-22s %s\n", "scenes", joined(protocol.scenes).c_str());
    const ViewGeometry& view = protocol.display.view;
    std::printf("%-22s %d x %d px, %.4g degrees wide, %.1f px/degree at the centre\n", "display",
                view.size.width, view.size.height, view.horizontal_fov_deg, view.pixels_per_degree());
    print_duration("interval", protocol.timing.interval_s, protocol.display.refresh_hz);
    print_duration("gap", protocol.timing.gap_s, protocol.display.refresh_hz);
    std::printf("%-22s %zu (%s)\n", "conditions", protocol.conditions.size(),
                joined(protocol.factors).c_str());
    if (protocol.design.participants > 0)
        std::printf("%-22s %d\n", "participants planned", protocol.design.participants);
    std::printf("%-22s %d\n", "training trials", protocol.design.training_trials);
    std::printf("%-22s %d, each of %d condition and %d validation trials\n", "testing sessions",
                protocol.design.sessions, protocol.conditions_per_session(),
                protocol.validation_per_session());
    const double trial_s = protocol.timing.lead_in_s + 2 * protocol.timing.interval_s + protocol.timing.gap_s;
    std::printf("%-22s %zu, at least %.0f minutes without answers and rests\n", "trials of a participant",
                plan.trials.size(), std::ceil(trial_s * static_cast<double>(plan.trials.size()) / 60));
}

}  // namespace parafovea
