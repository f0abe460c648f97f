// Splits work over the processors: each takes the next piece when it is done with one.
#include "renderer/all_processors.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace parafovea {

void on_all_processors(int count, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    std::mutex failing;
    std::exception_ptr failure;
    int failed = count;
    const auto take_turns = [&] {
        for (int i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                // All below i have been begun, so the lowest that fails is always reached.
                next = count;
                const std::scoped_lock lock(failing);
                if (i > failed) continue;
                failed = i;
                failure = std::current_exception();
            }
        }
    };
    {
        const int threads = std::min(static_cast<int>(std::thread::hardware_concurrency()), count);
        std::vector<std::jthread> others;
        for (int i = 1; i < threads; ++i) others.emplace_back(take_turns);
        take_turns();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace parafovea
