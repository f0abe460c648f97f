// Jobs on every core: each once, and what they throw.
#include "analysis/parallel.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/message_of.h"

namespace parafovea {
namespace {

TEST(ParallelFor, does_each_job_once) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
        std::vector<int> done(count, 0);
        parallel_for(count, [&](std::size_t i) { ++done[i]; });
        EXPECT_EQ(done, std::vector<int>(count, 1));
    }
}

TEST(ParallelFor, throws_the_exception_of_the_lowest_job_that_throws_every_time) {
    for (int round = 0; round < 100; ++round) {
        const std::string message = message_of([] {
            parallel_for(200, [](std::size_t i) {
                if (i < 5) return;
                // The first to fail is the last to say so.
                if (i == 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                throw std::runtime_error("job " + std::to_string(i));
            });
        });
        ASSERT_EQ(message, "job 5");
    }
}

}  // namespace
}  // namespace parafovea
