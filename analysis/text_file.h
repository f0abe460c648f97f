// Writes a text file whole or says why not.
#pragma once

#include <filesystem>
#include <string>

namespace parafovea {

// Throws std::runtime_error naming the file when it cannot be written to the last byte.
void write_text_file(const std::filesystem::path& path, const std::string& text);

// Makes the folder, parents included; throws std::runtime_error naming it when that fails or a file is in its
// place.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace parafovea
