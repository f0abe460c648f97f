// Writes a text file whole or says why not.
#include "analysis/text_file.h"

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace parafovea {

void write_text_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file)
        throw std::runtime_error(path.string() +
                                 ": cannot be written; is the folder writable and the disk not full?");
}

void make_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!std::filesystem::is_directory(folder))
        throw std::runtime_error(folder.string() + ": cannot be made a folder for the results" +
                                 (error ? " (" + error.message() + ")" : std::string()));
}

}  // namespace parafovea
