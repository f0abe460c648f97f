// A disk that fails on order: an SQLite VFS that refuses the n-th write and all that follow.
#pragma once

#include <atomic>

namespace parafovea::test {

// Registered with SQLite while it lives, under the name kName. Writes, truncations and syncs of every file
// opened through it are counted together.
class FailingVfs {
  public:
    static constexpr const char* kName = "failing";

    FailingVfs();
    FailingVfs(const FailingVfs&) = delete;
    FailingVfs& operator=(const FailingVfs&) = delete;
    ~FailingVfs();

    // From now on, the n-th write (from 1) fails with the SQLite code given. If `once`, later ones succeed
    // again.
    void fail_at(long n, int code, bool once = false);
    long writes() const;
    bool failed() const;
};

}  // namespace parafovea::test
