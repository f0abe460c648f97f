// Names session files by study, participant and time.
#include "app/session_file.h"

#include <stdexcept>
#include <system_error>

namespace parafovea {

namespace {

namespace fs = std::filesystem;

std::string beginning_of(const std::string& study, const std::string& participant) {
    return study + "_" + participant + "_";
}

constexpr std::size_t kTimeLength = 16;  // 20260131T235959Z

}  // namespace

fs::path new_session_file(const fs::path& folder, const std::string& study, const std::string& participant,
                          std::time_t now) {
    std::error_code error;
    if (!fs::exists(folder) && fs::create_directories(folder, error))
        fs::permissions(folder, fs::perms::owner_all, error);
    if (error || !fs::is_directory(folder))
        throw std::runtime_error(folder.string() + ": cannot make this folder (" + error.message() +
                                 "); name another with --data");
    std::tm utc{};
    gmtime_r(&now, &utc);
    char time[kTimeLength + 1];
    std::strftime(time, sizeof time, "%Y%m%dT%H%M%SZ", &utc);
    return folder / (beginning_of(study, participant) + time + ".sqlite");
}

fs::path latest_session_file(const fs::path& folder, const std::string& study,
                             const std::string& participant) {
    const std::string beginning = beginning_of(study, participant);
    fs::path latest;
    if (!fs::is_directory(folder)) return latest;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        // The length keeps a study called "a" apart from one called "a_b".
        const bool ours = name.starts_with(beginning) && name.ends_with(".sqlite") &&
                          name.size() == beginning.size() + kTimeLength + 7;
        if (ours && (latest.empty() || name > latest.filename().string())) latest = entry.path();
    }
    return latest;
}

}  // namespace parafovea
