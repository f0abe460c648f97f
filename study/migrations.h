// Brings session files written by earlier versions up to date.
#pragma once

#include <memory>

#include "study/database.h"

namespace parafovea {

// Changes the open file to kSchemaVersion, one version at a time, each in a transaction. Throws
// std::runtime_error where the file is no session, or from a newer program.
void migrate(Database& database);

// The file itself where it is of kSchemaVersion, else a copy in memory brought up to date: reading changes no
// file.
std::unique_ptr<Database> open_for_reading(const std::filesystem::path& path);

}  // namespace parafovea
