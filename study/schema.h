// The session file's tables (study/schema.sql) and their version.
#pragma once

namespace parafovea {

extern const char* const kSchemaSql;

// PRAGMA user_version of a file with these tables.
constexpr int kSchemaVersion = 3;

}  // namespace parafovea
