// Splits work over the processors: each takes the next piece when it is done with one.
#include "renderer/all_processors.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace parafovea {

void on_all_processors(int count, const std::function<void(int)>& work) {
    std::atomic<int> next = 0;
    const auto take_turns = [&] {
        for (int i = next++; i < count; i = next++) work(i);
    };
    const int threads = std::min(static_cast<int>(std::thread::hardware_concurrency()), count);
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(take_turns);
    take_turns();
}

}  // namespace parafovea
