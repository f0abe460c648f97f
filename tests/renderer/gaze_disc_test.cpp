// The rectangles that are drawn for a disc of pixels around the gaze.
#include "renderer/methods/gaze_disc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "devices/random.h"

namespace parafovea {
namespace {

std::set<std::pair<int, int>> pixels_of(const GazeDisc& disc) {
    std::set<std::pair<int, int>> pixels;
    for (const VkRect2D& r : rectangles_over(disc)) {
        for (int y = r.offset.y; y < r.offset.y + static_cast<int>(r.extent.height); ++y) {
            for (int x = r.offset.x; x < r.offset.x + static_cast<int>(r.extent.width); ++x)
                EXPECT_TRUE(pixels.insert({x, y}).second) << "drawn twice";
        }
    }
    return pixels;
}

TEST(GazeDisc, RectanglesHoldEveryPixelInsideOnceAndNoneOfWhereItMayNotBeDrawn) {
    Random random(3);
    for (int round = 0; round < 300; ++round) {
        const auto at = [&] { return static_cast<float>(random.uniform(-60, 160)); };
        const GazeDisc disc{
            {at(), at()},
            static_cast<float>(random.uniform(0, 90)),
            {{static_cast<int>(random.below(20)), static_cast<int>(random.below(20))}, {80, 70}}};
        const std::set<std::pair<int, int>> pixels = pixels_of(disc);
        const int left = disc.within.offset.x, top = disc.within.offset.y;
        for (const auto& [x, y] : pixels) {
            ASSERT_TRUE(x >= left && x < left + 80 && y >= top && y < top + 70);
        }
        for (int y = top; y < top + 70; ++y) {
            for (int x = left; x < left + 80; ++x) {
                const double r = std::hypot(x + 0.5 - disc.centre.x, y + 0.5 - disc.centre.y);
                ASSERT_TRUE(r > disc.radius_px || pixels.contains({x, y})) << x << ", " << y;
            }
        }
    }
}

TEST(GazeDisc, RectanglesAreHardlyLargerThanTheDisc) {
    for (const float radius : {100.0f, 187.2f}) {
        const GazeDisc disc{{200.3f, 199.8f}, radius, {{0, 0}, {400, 400}}};
        EXPECT_LT(static_cast<double>(pixels_of(disc).size()), 1.12 * std::numbers::pi * radius * radius);
    }
}

}  // namespace
}  // namespace parafovea
