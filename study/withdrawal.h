// Removes one person's data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace parafovea {

// Deletes every session file of the participant in the folder and below, with what SQLite keeps beside it,
// and returns their paths. Files that are no sessions are left alone. Throws std::runtime_error, before
// anything is deleted, where the folder cannot be read or one of the sessions is in use.
std::vector<std::filesystem::path> withdraw_participant(const std::filesystem::path& folder,
                                                        const std::string& participant);

}  // namespace parafovea
