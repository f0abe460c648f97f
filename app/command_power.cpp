// parafovea power: how often a study of a protocol's design would find what is assumed.
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "analysis/power.h"
#include "app/commands.h"
#include "app/progress.h"
#include "study/protocol.h"

namespace parafovea {

namespace {

PlanCell cell_of(const Protocol& protocol, const MethodSetting& setting) {
    const auto number = [&](const char* name) {
        const auto found = setting.numbers.find(name);
        if (found == setting.numbers.end())
            throw std::runtime_error(protocol.file_name +
                                     ": power needs conditions with a sigma and an alpha, found " +
                                     to_text(setting));
        return found->second;
    };
    const int scenes =
        protocol.design.scene_use == SceneUse::crossed ? static_cast<int>(protocol.scenes.size()) : 1;
    return {{number("sigma"), number("alpha")}, protocol.design.repetitions * scenes};
}

// Without an earlier study: half of the answers are "different" at the end of the paper's range of sigma
// (sigma^2 = 5.76) for the highest alpha, and one sigma step of the paper's (0.2) sooner for each alpha below
// it.
PowerAssumptions default_assumptions(const std::vector<PlanCell>& plan) {
    std::vector<double> alphas;
    for (const PlanCell& cell : plan)
        if (std::find(alphas.begin(), alphas.end(), cell.condition.alpha) == alphas.end())
            alphas.push_back(cell.condition.alpha);
    std::sort(alphas.begin(), alphas.end());
    PowerAssumptions assumptions;
    for (std::size_t i = 0; i < alphas.size(); ++i) {
        const double sigma = 2.4 - 0.2 * static_cast<double>(alphas.size() - 1 - i);
        assumptions.functions.push_back({alphas[i], sigma * sigma, 5.0});
    }
    return assumptions;
}

}  // namespace

PowerCommand::PowerCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("power", "Simulate how often a study of this design finds an effect");
    command->footer("Example: parafovea power protocols/final.toml --participants 12,18,24 --out power");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    command->add_option("--participants", participants_, "Numbers of participants")
        ->required()
        ->delimiter(',')
        ->check(CLI::PositiveNumber);
    command->add_option("--assume", assume_,
                        "psychometric.csv of an earlier analysis; a stated default otherwise");
    command->add_option("--effects", effects_, "Multiples of the assumed effect of alpha; 0 is none")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--studies", studies_, "Simulated studies for each combination")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    command->add_option("--seed", seed_, "Seed of the simulation")->capture_default_str();
    command->add_option("--out", out_, "Folder for the results")->required();
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] { run(); });
}

void PowerCommand::run() const {
    const Protocol protocol = load_protocol(protocol_);
    PowerQuestion question;
    for (const MethodSetting& condition : protocol.conditions)
        question.plan.push_back(cell_of(protocol, condition));
    question.assumptions =
        assume_.empty() ? default_assumptions(question.plan) : read_power_assumptions(assume_);
    question.participants = participants_;
    question.sessions = {protocol.design.sessions};
    question.effects = effects_;
    question.studies = studies_;
    question.seed = seed_;

    std::vector<PowerPoint> points;
    {
        const auto all = static_cast<int>(participants_.size() * effects_.size()) * studies_;
        Progress progress("study", all, quiet_);
        points = simulate_power(question, [&](std::int64_t done, std::int64_t) {
            progress.update(static_cast<int>(done), std::to_string(done) + " of " + std::to_string(all));
        });
    }
    std::printf("%s\n", power_markdown(points, question).c_str());
    for (const std::filesystem::path& file : write_power(points, question, out_))
        std::printf("%s\n", file.c_str());
}

}  // namespace parafovea
