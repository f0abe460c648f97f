// parafovea power: how often a study of a protocol's design would find what is assumed.
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "analysis/power.h"
#include "analysis/power_shards.h"
#include "app/commands.h"
#include "app/progress.h"
#include "app/tradeoff_plan.h"
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
    command->footer(
        "Example: parafovea power protocols/final.toml --participants 12,18,24 --out power\n"
        "On several machines: --shard 1/8 to --shard 8/8, each with its own --out; then --merge OUT1 OUT2 "
        "... "
        "--out ALL");
    CLI::Option* merge = command->add_option("--merge", merge_, "Folders of all shards: join them");
    CLI::Option* protocol = command->add_option("protocol", protocol_, "Protocol file (TOML)");
    CLI::Option* participants =
        command->add_option("--participants", participants_, "Numbers of participants")
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
    CLI::Option* shard = command->add_option("--shard", shard_, "I/N: simulate the I-th of N parts");
    merge->excludes(protocol)->excludes(participants)->excludes(shard);
    command->add_option("--out", out_, "Folder for the results")->required();
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this, protocol, participants] {
        if (!merge_.empty()) return merge_shards();
        if (protocol->empty()) throw CLI::RequiredError("protocol");
        if (participants->empty()) throw CLI::RequiredError("--participants");
        run();
    });
}

void PowerCommand::merge_shards() const {
    const MergedPower merged = merge_power_shards({merge_.begin(), merge_.end()});
    report(power_of_studies(merged.question, merged.studies), merged.question);
}

void PowerCommand::report(const std::vector<PowerPoint>& points, const PowerQuestion& question) const {
    std::printf("%s\n", power_markdown(points, question).c_str());
    for (const std::filesystem::path& file : write_power(points, question, out_))
        std::printf("%s\n", file.c_str());
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

    const Shard shard = shard_.empty() ? Shard{} : parse_shard(shard_);
    std::vector<SimulatedStudy> studies;
    {
        const auto all = static_cast<int>(study_count(question)) / shard.count;
        Progress progress("study", all, quiet_);
        studies =
            simulate_studies(question, {shard.index, shard.count}, [&](std::int64_t done, std::int64_t of) {
                progress.update(static_cast<int>(done), std::to_string(done) + " of " + std::to_string(of));
            });
    }
    if (shard.count > 1) {
        write_power_shard(question, {shard.index, shard.count}, studies, out_);
        std::printf("%s\n", (std::filesystem::path(out_) / kPowerShardName).c_str());
        return;
    }
    report(power_of_studies(question, studies), question);
}

}  // namespace parafovea
