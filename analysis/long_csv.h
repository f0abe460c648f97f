// One long table of all trials with a codebook: the export that every statistics program reads.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "analysis/responses.h"

namespace parafovea {

// What a column holds, for the codebook.
struct LongColumn {
    std::string name;
    std::string description;
    std::string units;   // empty: none
    std::string values;  // what the cells may be, such as "0 or 1"; empty: anything
};

// Writes responses one by one: responses.csv as read_responses_csv reads it, with further columns of the
// caller's, and responses.codebook.json.
class LongCsvWriter {
  public:
    // Throws std::runtime_error when the folder or a file cannot be made, or a further column has the name of
    // a fixed one.
    LongCsvWriter(const std::filesystem::path& folder, const std::vector<LongColumn>& further = {});

    // further: one text for each further column, empty where not known.
    void write(const Response& response, const std::vector<std::string>& further = {});

    // Closes the table; throws when its last byte could not be written.
    void finish();

    const std::filesystem::path& table() const { return table_path_; }
    const std::filesystem::path& codebook() const { return codebook_path_; }

  private:
    std::filesystem::path table_path_, codebook_path_;
    std::size_t further_ = 0;
    std::ofstream table_;
};

}  // namespace parafovea
