// Work over all processors: each piece once, and what it throws.
#include "renderer/all_processors.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/message_of.h"

namespace parafovea {
namespace {

TEST(AllProcessors, DoEachPieceOnce) {
    for (const int count : {0, 1, 2, 1000}) {
        std::vector<int> done(static_cast<std::size_t>(count), 0);
        on_all_processors(count, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
        EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(count), 1));
    }
}

TEST(AllProcessors, ThrowTheExceptionOfTheLowestPieceThatThrowsEveryTime) {
    for (int round = 0; round < 100; ++round) {
        const std::string message = message_of([] {
            on_all_processors(200, [](int i) {
                if (i < 5) return;
                // The first to fail is the last to say so.
                if (i == 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                throw std::runtime_error("piece " + std::to_string(i));
            });
        });
        ASSERT_EQ(message, "piece 5");
    }
}

TEST(AllProcessors, BeginNoMoreOnceAPieceHasThrown) {
    std::vector<int> done(100'000, 0);
    EXPECT_THROW(on_all_processors(static_cast<int>(done.size()),
                                   [&](int i) {
                                       done[static_cast<std::size_t>(i)] = 1;
                                       if (i == 0) throw std::runtime_error("no");
                                       std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                   }),
                 std::runtime_error);
    EXPECT_EQ(done.back(), 0);
}

}  // namespace
}  // namespace parafovea
