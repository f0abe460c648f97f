// Whole files compressed with gzip.
#pragma once

#include <filesystem>
#include <string>

namespace parafovea {

// The same text gives the same bytes: no time stamp, no name inside. Throws std::runtime_error naming the
// file.
void write_gzip_file(const std::filesystem::path& path, const std::string& text);

// Throws std::runtime_error naming the file when it cannot be read or is damaged.
std::string read_gzip_file(const std::filesystem::path& path);

}  // namespace parafovea
