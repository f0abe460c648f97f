// parafovea withdraw: removes one person's data.
#include <cstdio>

#include "app/commands.h"
#include "study/withdrawal.h"

namespace parafovea {

WithdrawCommand::WithdrawCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("withdraw", "Delete every session file of one participant");
    command->footer("Example: parafovea withdraw P07 --data sessions");
    command->add_option("participant", participant_, "The participant's pseudonym")->required();
    command->add_option("--data", data_, "Folder to search, with those below it")->capture_default_str();
    command->callback([this] { run(); });
}

void WithdrawCommand::run() const {
    const std::vector<std::filesystem::path> deleted = withdraw_participant(data_, participant_);
    for (const std::filesystem::path& file : deleted) std::printf("deleted %s\n", file.c_str());
    std::printf("%zu files of participant %s deleted in %s\n", deleted.size(), participant_.c_str(),
                data_.c_str());
}

}  // namespace parafovea
