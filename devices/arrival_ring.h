// Hands values from one device thread to one reader without ever making either wait.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace parafovea {

// One thread pushes, another drains. When nobody drains for so long that the ring is full, new values are
// lost and counted. Capacity is a power of two.
template <typename Value, std::size_t kCapacity>
class ArrivalRing {
    static_assert((kCapacity & (kCapacity - 1)) == 0);

  public:
    // Device thread only.
    void push(const Value& value) {
        const std::size_t write = write_.load(std::memory_order_relaxed);
        if (write - read_.load(std::memory_order_acquire) == kCapacity) {
            overflowed_.fetch_add(1, std::memory_order_relaxed);
            return;
        }
        (*values_)[write % kCapacity] = value;
        write_.store(write + 1, std::memory_order_release);
    }

    // Reader's thread only. Appends, oldest first.
    void drain(std::vector<Value>& values) {
        std::size_t read = read_.load(std::memory_order_relaxed);
        const std::size_t write = write_.load(std::memory_order_acquire);
        for (; read != write; ++read) values.push_back((*values_)[read % kCapacity]);
        read_.store(read, std::memory_order_release);
    }

    std::int64_t overflowed() const { return overflowed_.load(std::memory_order_relaxed); }

  private:
    std::unique_ptr<std::array<Value, kCapacity>> values_ = std::make_unique<std::array<Value, kCapacity>>();
    std::atomic<std::size_t> write_ = 0, read_ = 0;
    std::atomic<std::int64_t> overflowed_ = 0;
};

}  // namespace parafovea
