// Random draws from std::mt19937_64 that are the same with every standard library (its distributions are
// not).
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <utility>

namespace parafovea {

// A whole number in [0, bound), unbiased: the multiply-and-reject draw of Lemire 2019, "Fast random integer
// generation", which divides only where it may have to reject.
inline std::uint32_t draw_below(std::mt19937_64& generator, std::uint32_t bound) {
    assert(bound > 0);
    for (;;) {
        const std::uint64_t product = (generator() >> 32) * bound;
        const auto remainder = static_cast<std::uint32_t>(product);
        if (remainder >= bound || remainder >= (0u - bound) % bound)
            return static_cast<std::uint32_t>(product >> 32);
    }
}

// A number in [0, 1) with 53 random bits.
inline double draw_unit(std::mt19937_64& generator) {
    return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

// A standard normal number (Box and Muller 1958, the cosine branch).
inline double draw_normal(std::mt19937_64& generator) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - draw_unit(generator)));
    return radius * std::cos(2.0 * std::numbers::pi * draw_unit(generator));
}

// Fisher and Yates: every order equally likely.
template <typename T>
void shuffle(std::span<T> items, std::mt19937_64& generator) {
    for (std::size_t left = items.size(); left > 1; --left)
        std::swap(items[left - 1], items[draw_below(generator, static_cast<std::uint32_t>(left))]);
}

}  // namespace parafovea
