// Runs independent jobs on every core.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace parafovea {

// Calls job(i) once for every i below count, from several threads; returns when all are done. The first
// exception a job throws is thrown again here; jobs not yet begun are then left out.
template <typename Job>
void parallel_for(std::size_t count, Job&& job, std::size_t threads = std::thread::hardware_concurrency()) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                job(i);
            } catch (...) {
                const std::lock_guard lock(failure_mutex);
                if (!failure) failure = std::current_exception();
                next = count;
            }
        }
    };
    {
        std::vector<std::jthread> helpers;
        for (std::size_t i = 1; i < threads && i < count; ++i) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace parafovea
