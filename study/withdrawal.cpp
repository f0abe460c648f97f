// Finds and deletes a participant's session files.
#include "study/withdrawal.h"

#include <algorithm>
#include <stdexcept>

#include "study/session_file_lock.h"
#include "study/session_log_reader.h"

namespace parafovea {
namespace {

bool is_session_of(const std::filesystem::path& path, const std::string& participant) {
    try {
        return read_session(path).facts.participant == participant;
    } catch (const std::runtime_error&) {
        return false;  // no session file
    }
}

}  // namespace

std::vector<std::filesystem::path> withdraw_participant(const std::filesystem::path& folder,
                                                        const std::string& participant) {
    if (!std::filesystem::is_directory(folder))
        throw std::runtime_error(folder.string() +
                                 ": expected the folder of the session files, found none; check the path");
    std::vector<std::filesystem::path> sessions;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".sqlite" &&
            is_session_of(entry.path(), participant))
            sessions.push_back(entry.path());
    std::sort(sessions.begin(), sessions.end());
    std::vector<SessionFileLock> locks;
    for (const auto& session : sessions) locks.emplace_back(session, SessionFileLock::Mode::open);
    for (const auto& session : sessions)
        for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(session.string() + end);
    return sessions;
}

}  // namespace parafovea
