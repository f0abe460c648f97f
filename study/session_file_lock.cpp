// An open-file-description lock on the session file.
#include "study/session_file_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace parafovea {
namespace {

constexpr off_t kLockedByte = 0x7000000000000000;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& expected,
                       const std::string& found, const std::string& advice) {
    throw std::runtime_error(path.string() + ": expected " + expected + ", found " + found + "; " + advice);
}

}  // namespace

SessionFileLock::SessionFileLock(const std::filesystem::path& path, Mode mode) {
    const int flags = O_RDWR | O_CLOEXEC | (mode == Mode::create ? O_CREAT | O_EXCL : 0);
    file_ = ::open(path.c_str(), flags, S_IRUSR | S_IWUSR);
    if (file_ < 0) {
        const int error = errno;
        if (mode == Mode::open) fail(path, "a session file", std::strerror(error), "check the path");
        if (error == EEXIST)
            fail(path, "a new session file", "an existing one", "resume it or choose another folder");
        fail(path, "a folder to write the session in", std::strerror(error),
             "choose one that can be written");
    }
    struct flock lock = {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = kLockedByte;
    lock.l_len = 1;
    if (::fcntl(file_, F_OFD_SETLK, &lock) != 0) {
        ::close(std::exchange(file_, -1));
        fail(path, "a session nobody is running", "one in use by another process", "end that process first");
    }
}

SessionFileLock::SessionFileLock(SessionFileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

SessionFileLock::~SessionFileLock() {
    if (file_ >= 0) ::close(file_);
}

}  // namespace parafovea
