// A folder that lives as long as a test, and what its files hold.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace parafovea {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        // In memory where there is room: what tests ask does not depend on the disk's speed.
        const std::filesystem::path memory = "/dev/shm";
        const bool fast = access(memory.c_str(), W_OK) == 0 &&
                          std::filesystem::space(memory).available > std::uintmax_t{1} << 29;
        std::string name =
            ((fast ? memory : std::filesystem::temp_directory_path()) / "parafovea_test_XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

    // Makes the folders on the way.
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace parafovea
