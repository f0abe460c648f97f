// From session files to the plain rows that the analysis takes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/recordings.h"
#include "analysis/responses.h"
#include "analysis/study_description.h"
#include "study/session_survey.h"

namespace parafovea {

// Session files (.sqlite), folders of them in the order of their names, and responses tables (.csv). Throws
// std::runtime_error with one line where an input is missing or a folder holds no session.
std::vector<std::filesystem::path> input_files(const std::vector<std::string>& inputs);

// Session files that may be used together, and what is wrong with the others: duplicates, mismatched
// protocols, ...: one line each, files named. Light: no trial is read.
struct ListedSession {
    std::filesystem::path file;
    SessionHead head;
};
struct SessionList {
    std::vector<ListedSession> sessions;  // in the order of the files; all of one protocol
    std::vector<std::string> problems;
};
SessionList list_sessions(const std::vector<std::filesystem::path>& files);

// Study data in one go, without holding all of it in memory: each response is handed over once.
struct StudyData {
    StudyDescription description;
    StudyRecordings recordings;
    std::vector<std::string> problems;  // duplicates, mismatched protocols, ...: one line each, files named
};

// Reads everything `analyze` is given, each file once. A response is every testing trial that was not broken
// off or started over; one that broke a validity rule, or whose session breaks an exclusion rule of its
// protocol, carries the reason. Sessions that the inventory leaves out are named in `problems`. Throws
// std::runtime_error with one line where an input cannot be read or nothing is left to analyse.
StudyData read_study(const std::vector<std::string>& inputs,
                     const std::function<void(const Response&)>& on_response);

}  // namespace parafovea
