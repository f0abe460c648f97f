// The photodiode's patch: a square in the lower left corner, white during the intervals and black otherwise.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/geometry.h"

namespace parafovea {

// The side of the square; 3 degrees are as wide as a photodiode's holder on a desktop screen.
inline int patch_side_px(const ViewGeometry& view) {
    constexpr double kSideDeg = 3;
    return std::max(1, static_cast<int>(kSideDeg * view.pixels_per_degree()));
}

// Into a picture of 4 bytes a pixel, rows from the top.
inline void draw_patch(std::span<std::uint8_t> rgba, SizePx size, int side_px, bool white) {
    for (int y = std::max(0, size.height - side_px); y < size.height; ++y)
        for (int x = 0; x < std::min(side_px, size.width); ++x) {
            const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                        static_cast<std::size_t>(x));
            std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(at), 3, white ? 255 : 0);
        }
}

}  // namespace parafovea
