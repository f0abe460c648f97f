// Random numbers that are the same on every machine: xoshiro256** and our own distributions.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

namespace parafovea {

// The step of splitmix64 (Steele, Lea and Flood 2014): advances the state and returns the next output.
std::uint64_t splitmix64(std::uint64_t& state);

// xoshiro256** (Blackman and Vigna 2021), its state filled by splitmix64 from one 64-bit seed. The
// distributions are ours because those of the standard library differ between implementations. Each call's
// number of draws is part of the contract of a seed only in so far as the tests pin it: a stored plan, not a
// seed, is the record.
class Random {
  public:
    explicit Random(std::uint64_t seed);

    // An independent stream for each name under one seed, e.g. stream(seed, "blinks"): drawing more from one
    // stream never shifts another.
    static Random stream(std::uint64_t seed, std::string_view name);

    // The generator at a given state, which must not be all zeros.
    static Random from_state(const std::array<std::uint64_t, 4>& state);

    // 64 uniform bits.
    std::uint64_t next();

    // A whole number in [0, n), every one equally likely; n > 0.
    std::uint64_t below(std::uint64_t n);

    // A real number in [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

    // A real number in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    // True with the given probability.
    bool chance(double probability) { return uniform() < probability; }

    // Standard normal (Box-Muller, one of the pair; two draws a call).
    double normal();
    double normal(double mean, double sd) { return mean + sd * normal(); }

    // exp of a normal: `median` is the distribution's median, `sigma` the SD of its logarithm.
    double lognormal(double median, double sigma) { return median * std::exp(sigma * normal()); }

    // Waiting time of a Poisson process of the given rate, in the reciprocal of the rate's unit; rate > 0.
    double exponential(double rate);

    // Puts the items into an order drawn uniformly from all orders (Fisher-Yates). Takes a vector, array or
    // span.
    template <typename Items>
    void shuffle(Items&& items) {
        for (std::size_t i = std::size(items); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
    }

  private:
    Random() = default;

    std::array<std::uint64_t, 4> state_{};
};

}  // namespace parafovea
