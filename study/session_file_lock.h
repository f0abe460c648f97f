// Keeps a second process off a session file.
#pragma once

#include <filesystem>

namespace parafovea {

// Held while it lives, and released by the system when the process dies, however it dies. It locks one byte
// far beyond SQLite's own locks, so that others can still read the file.
class SessionFileLock {
  public:
    enum class Mode { create, open };

    // Throws std::runtime_error where the file exists (create), is missing (open), or is in use. A created
    // file is readable by its owner alone.
    SessionFileLock(const std::filesystem::path& path, Mode mode);
    SessionFileLock(SessionFileLock&& other) noexcept;
    SessionFileLock(const SessionFileLock&) = delete;
    SessionFileLock& operator=(const SessionFileLock&) = delete;
    ~SessionFileLock();

  private:
    int file_ = -1;
};

}  // namespace parafovea
