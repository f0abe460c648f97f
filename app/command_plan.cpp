// parafovea plan: one participant's complete plan as CSV.
#include <iostream>

#include "app/commands.h"
#include "app/participant_id.h"
#include "study/protocol.h"
#include "study/trial_plan.h"

namespace parafovea {

PlanCommand::PlanCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("plan", "Print the complete plan of one participant as CSV");
    command->footer("Example: parafovea plan protocols/final.toml --participant P01 --seed 2018");
    command->add_option("protocol", protocol_, "Protocol file (TOML)")->required();
    command->add_option("--participant", participant_, "Pseudonym ending in a number, such as P01")
        ->required();
    command->add_option("--seed", seed_, "Seed of every random draw")->required();
    command->callback([this] { run(); });
}

void PlanCommand::run() const {
    const Protocol protocol = load_protocol(protocol_);
    write_plan_csv(std::cout, make_plan(protocol, participant_index(participant_), seed_), protocol);
}

}  // namespace parafovea
