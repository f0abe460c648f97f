// From session files to the plain rows that the analysis takes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/inventory.h"
#include "analysis/recordings.h"
#include "analysis/responses.h"
#include "analysis/study_description.h"
#include "study/session_log_reader.h"

namespace parafovea {

// Session files (.sqlite), folders of them in the order of their names, and responses tables (.csv). Throws
// std::runtime_error with one line where an input is missing or a folder holds no session.
std::vector<std::filesystem::path> input_files(const std::vector<std::string>& inputs);

// What identifies a session among many.
SessionStamp stamp_of(const SessionRows& session, const std::filesystem::path& file);

// A response for every testing trial that was not broken off or started over; a trial that broke a validity
// rule, or a session that breaks an exclusion rule of its protocol, keeps its rows, with the reason.
std::vector<Response> responses_of(const SessionRows& session);

// Study data in one go, without holding all of it in memory: each response is handed over once.
struct StudyData {
    StudyDescription description;
    StudyRecordings recordings;
    std::vector<std::string> problems;  // duplicates, mismatched protocols, ...: one line each, files named
};

// Reads everything `analyze` is given. Sessions that the inventory leaves out are named in `problems`. Throws
// std::runtime_error with one line where an input cannot be read or nothing is left to analyse.
StudyData read_study(const std::vector<std::string>& inputs,
                     const std::function<void(const Response&)>& on_response);

}  // namespace parafovea
