// Where the files of real sessions are, and which of them to go on with.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

namespace parafovea {

// folder/study_participant_20260131T235959Z.sqlite; makes the folder, readable by its owner alone, where it
// is missing. Throws std::runtime_error with one line where it cannot.
std::filesystem::path new_session_file(const std::filesystem::path& folder, const std::string& study,
                                       const std::string& participant, std::time_t now);

// The participant's latest session of the study, finished or not; empty where there is none.
std::filesystem::path latest_session_file(const std::filesystem::path& folder, const std::string& study,
                                          const std::string& participant);

}  // namespace parafovea
