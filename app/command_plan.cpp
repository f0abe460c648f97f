// parafovea plan: one participant's complete plan as CSV.
#include <iostream>

#include "app/commands.h"
#include "app/options.h"
#include "app/participant_id.h"
#include "study/balance_report.h"
#include "study/protocol.h"
#include "study/trial_plan.h"

namespace parafovea {

PlanCommand::PlanCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("plan", "Print one participant's complete plan, or how plans balance");
    command->footer(
        "Example: parafovea plan protocols/final.toml --participant P01 --seed 2018\n"
        "         parafovea plan protocols/final.toml --balance 1..28 --seed 2018");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    CLI::Option* participant =
        command->add_option("--participant", participant_, "Pseudonym ending in a number, such as P01");
    command
        ->add_option("--balance", balance_, "FIRST..LAST: a balance report over these participants instead")
        ->excludes(participant);
    command->add_option("--seed", seed_, "Seed of every random draw")->required();
    command->callback([this] { run(); });
}

void PlanCommand::run() const {
    const Protocol protocol = load_protocol(protocol_);
    if (!balance_.empty()) {
        const auto [first, last] = parse_range(balance_);
        write_balance_report(std::cout, protocol, first - 1, last - 1, seed_);
        return;
    }
    if (participant_.empty()) throw CLI::RequiredError("--participant or --balance");
    write_plan_csv(std::cout, make_plan(protocol, participant_index(participant_), seed_), protocol);
}

}  // namespace parafovea
