// parafovea simulate: simulated participants through a whole study, several at a time.
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <stdexcept>

#include "analysis/parallel.h"
#include "app/commands.h"
#include "app/progress.h"
#include "app/session_responses.h"
#include "app/simulated_session.h"
#include "study/protocol.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

std::string what_is_next(const SessionProgress& progress) {
    if (!progress.next) return progress.state;
    const PlannedTrial& trial = *progress.next;
    if (trial.kind == TrialKind::validation) return "validation trial, " + trial.scene;
    return to_text(trial.reference_interval == 0 ? trial.second : trial.first) + ", " + trial.scene;
}

// Adds up the progress of several sessions into one bar.
class StudyProgress {
  public:
    StudyProgress(int participants, int trials_each, bool quiet)
        : done_(static_cast<std::size_t>(participants), 0),
          bar_("trial", participants * trials_each, quiet) {}

    void update(int participant, const SessionProgress& progress) {
        const std::scoped_lock lock(mutex_);
        total_ += progress.done - done_[static_cast<std::size_t>(participant)];
        done_[static_cast<std::size_t>(participant)] = progress.done;
        bar_.update(total_, simulated_participant_id(participant) + ", " + what_is_next(progress));
    }

  private:
    std::mutex mutex_;
    std::vector<int> done_;
    int total_ = 0;
    Progress bar_;
};

}  // namespace

SimulateCommand::SimulateCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("simulate", "Run a study with simulated participants and analyse it");
    command->footer(
        "Example: parafovea simulate protocols/demo.toml --participants 18 --seed 2018 --out demo_study");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    command->add_option("--participants", participants_, "How many")->required()->check(CLI::PositiveNumber);
    command->add_option("--seed", seed_, "Seed of every random draw")->required();
    command->add_option("--out", out_, "Folder for session files and results")->required();
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] { run(); });
}

void SimulateCommand::run() const {
    const Protocol protocol = load_protocol(protocol_);
    const fs::path sessions = fs::path(out_) / "sessions";
    std::error_code error;
    fs::create_directories(sessions, error);
    if (error)
        throw std::runtime_error(sessions.string() + ": cannot make this folder (" + error.message() +
                                 "); name another with --out");
    if (!fs::is_empty(sessions))
        throw std::runtime_error(sessions.string() +
                                 ": holds session files already; name another folder with --out, or "
                                 "analyse what is there with: parafovea analyze " +
                                 sessions.string() + " --out " + out_);

    PictureSource pictures(protocol.display.view);
    PicturePairJudge judge(display_model(protocol.display.view, protocol.display.peak_luminance_cd_m2));
    {
        StudyProgress progress(participants_, static_cast<int>(make_plan(protocol, 0, 0).trials.size()),
                               quiet_);
        parallel_for(static_cast<std::size_t>(participants_), [&](std::size_t i) {
            const int participant = static_cast<int>(i);
            const fs::path file =
                sessions / (protocol.name + "_" + simulated_participant_id(participant) + ".sqlite");
            run_simulated_session(protocol, {participant, seed_, file}, pictures, judge,
                                  [&](const SessionProgress& now) { progress.update(participant, now); });
        });
    }
    analyze_and_print({sessions.string()}, out_);
}

}  // namespace parafovea
