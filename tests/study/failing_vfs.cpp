// Forwards every call to the default VFS but counts, and refuses, writes.
#include "tests/study/failing_vfs.h"

#include <sqlite3.h>

#include <cstddef>

namespace parafovea::test {
namespace {

// SQLite's callbacks have no other way to reach these.
std::atomic<long> writes_done, fails_at;
std::atomic<int> failure_code;
std::atomic<bool> fails_once, has_failed;
sqlite3_vfs failing_vfs;

bool refuses() {
    const long n = ++writes_done;
    const bool refused = fails_at > 0 && (fails_once ? n == fails_at : n >= fails_at);
    if (refused) has_failed = true;
    return refused;
}

struct File {
    sqlite3_file base;
    sqlite3_file* real() {
        return reinterpret_cast<sqlite3_file*>(reinterpret_cast<std::byte*>(this) + kRealOffset);
    }
    static constexpr int kRealOffset = 64;  // room for `base`, aligned
};
static_assert(sizeof(File) <= File::kRealOffset);

sqlite3_file* real(sqlite3_file* file) {
    return reinterpret_cast<File*>(file)->real();
}

const sqlite3_io_methods kMethods = {
    3,
    [](sqlite3_file* f) { return real(f)->pMethods->xClose(real(f)); },
    [](sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
        return real(f)->pMethods->xRead(real(f), to, n, at);
    },
    [](sqlite3_file* f, const void* from, int n, sqlite3_int64 at) {
        return refuses() ? failure_code.load() : real(f)->pMethods->xWrite(real(f), from, n, at);
    },
    [](sqlite3_file* f, sqlite3_int64 size) {
        return refuses() ? failure_code.load() : real(f)->pMethods->xTruncate(real(f), size);
    },
    [](sqlite3_file* f, int flags) {
        return refuses() ? SQLITE_IOERR_FSYNC : real(f)->pMethods->xSync(real(f), flags);
    },
    [](sqlite3_file* f, sqlite3_int64* size) { return real(f)->pMethods->xFileSize(real(f), size); },
    [](sqlite3_file* f, int lock) { return real(f)->pMethods->xLock(real(f), lock); },
    [](sqlite3_file* f, int lock) { return real(f)->pMethods->xUnlock(real(f), lock); },
    [](sqlite3_file* f, int* out) { return real(f)->pMethods->xCheckReservedLock(real(f), out); },
    [](sqlite3_file* f, int what, void* argument) {
        return real(f)->pMethods->xFileControl(real(f), what, argument);
    },
    [](sqlite3_file* f) { return real(f)->pMethods->xSectorSize(real(f)); },
    [](sqlite3_file* f) { return real(f)->pMethods->xDeviceCharacteristics(real(f)); },
    [](sqlite3_file* f, int page, int size, int extend, void volatile** out) {
        return real(f)->pMethods->xShmMap(real(f), page, size, extend, out);
    },
    [](sqlite3_file* f, int at, int n, int flags) {
        return real(f)->pMethods->xShmLock(real(f), at, n, flags);
    },
    [](sqlite3_file* f) { real(f)->pMethods->xShmBarrier(real(f)); },
    [](sqlite3_file* f, int remove) { return real(f)->pMethods->xShmUnmap(real(f), remove); },
    [](sqlite3_file* f, sqlite3_int64 at, int n, void** out) {
        return real(f)->pMethods->xFetch(real(f), at, n, out);
    },
    [](sqlite3_file* f, sqlite3_int64 at, void* page) {
        return real(f)->pMethods->xUnfetch(real(f), at, page);
    },
};

int open_file(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    sqlite3_vfs* underlying = static_cast<sqlite3_vfs*>(vfs->pAppData);
    const int code = underlying->xOpen(underlying, name, real(file), flags, out_flags);
    file->pMethods = code == SQLITE_OK ? &kMethods : nullptr;
    return code;
}

}  // namespace

FailingVfs::FailingVfs() {
    sqlite3_vfs* underlying = sqlite3_vfs_find(nullptr);
    failing_vfs = *underlying;
    failing_vfs.zName = kName;
    failing_vfs.szOsFile = File::kRealOffset + underlying->szOsFile;
    failing_vfs.pAppData = underlying;
    failing_vfs.xOpen = open_file;
    sqlite3_vfs_register(&failing_vfs, 0);
    fail_at(0, SQLITE_OK);
}

FailingVfs::~FailingVfs() {
    sqlite3_vfs_unregister(&failing_vfs);
}

void FailingVfs::fail_at(long n, int code, bool once) {
    writes_done = 0;
    fails_at = n;
    failure_code = code;
    fails_once = once;
    has_failed = false;
}

long FailingVfs::writes() const {
    return writes_done;
}
bool FailingVfs::failed() const {
    return has_failed;
}

}  // namespace parafovea::test
