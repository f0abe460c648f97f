// Runs independent jobs on every core.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace parafovea {

// Calls job(i) once for every i below count, from as many threads as there are processors; returns when all
// are done. Where jobs throw, those not yet begun are left out and the exception of the lowest i is thrown
// again here: the same one every time.
template <typename Job>
void parallel_for(std::size_t count, Job&& job) {
    std::atomic<std::size_t> next{0};
    std::mutex failing;
    std::exception_ptr failure;
    std::size_t failed = count;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                job(i);
            } catch (...) {
                // All below i have been begun, so the lowest that fails is always reached.
                next = count;
                const std::lock_guard lock(failing);
                if (i > failed) continue;
                failed = i;
                failure = std::current_exception();
            }
        }
    };
    {
        const std::size_t threads = std::min<std::size_t>(std::thread::hardware_concurrency(), count);
        std::vector<std::jthread> helpers;
        for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace parafovea
