// From session files to the plain rows that the analysis takes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/responses.h"
#include "analysis/study_description.h"

namespace parafovea {

struct StudyData {
    std::vector<Response> responses;
    StudyDescription description;
};

// Reads session files (.sqlite), folders of them, or responses tables (.csv), in the order given, folders in
// the order of names. Sessions of one study only: a different protocol hash, or a session given twice, is an
// error that names both files. Throws std::runtime_error with one line.
StudyData read_study_data(const std::vector<std::string>& inputs);

}  // namespace parafovea
