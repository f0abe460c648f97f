// xoshiro256**, splitmix64 and the distributions drawn from them.
#include "devices/random.h"

#include <bit>
#include <cassert>
#include <numbers>

namespace parafovea {

std::uint64_t splitmix64(std::uint64_t& state) {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

Random::Random(std::uint64_t seed) {
    for (auto& word : state_) word = splitmix64(seed);
}

Random Random::stream(std::uint64_t seed, std::string_view name) {
    // FNV-1a over the name, then one splitmix64 step to spread the seed: similar names get unrelated streams.
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return Random(splitmix64(seed) ^ hash);
}

Random Random::from_state(const std::array<std::uint64_t, 4>& state) {
    assert((state[0] | state[1] | state[2] | state[3]) != 0);
    Random random;
    random.state_ = state;
    return random;
}

std::uint64_t Random::next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
}

std::uint64_t Random::below(std::uint64_t n) {
    assert(n > 0);
    // Reject the first 2^64 mod n values, so that what is left divides evenly.
    const std::uint64_t reject = (0 - n) % n;
    std::uint64_t x = next();
    while (x < reject) x = next();
    return x % n;
}

double Random::normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
}

double Random::exponential(double rate) {
    assert(rate > 0);
    return -std::log(1 - uniform()) / rate;
}

}  // namespace parafovea
