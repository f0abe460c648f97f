// The clock mapping against simulated devices whose true clocks are known.
#include "devices/clock_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "devices/random.h"

namespace parafovea {
namespace {

struct Outcome {
    int samples = 0, outside = 0;  // outside: the truth is not within the stated error
    double worst_late_ms = 0, worst_early_ms = 0, final_error_ms = 0;
    Duration last_stated;
    int resets = 0;
    std::optional<double> skew;
};

// A device of 120 Hz with the given delay of sample i in seconds (beyond a known 14 ms) and clock.
Outcome run(
    double seconds, double skew, const std::function<double(int)>& delay_s,
    const std::function<double(double)>& device_step_s = [](double) { return 0.0; }) {
    ClockMappingSettings settings;
    settings.least_latency = Duration::from_ms(14);
    settings.resolution = {1000};
    ClockMapping mapping(settings);
    Outcome outcome;
    HostTime last_arrival;
    for (int i = 0; i < seconds * 120; ++i) {
        const double t = i / 120.0;
        const HostTime truth = HostTime{77'000'000'000} + Duration::from_seconds(t);
        const DeviceTime device{Duration::from_seconds(3 + t * (1 + skew) + device_step_s(t)).ns / 1000 *
                                1000};
        const HostTime arrival = std::max(last_arrival, truth + Duration::from_seconds(0.014 + delay_s(i)));
        last_arrival = arrival;
        const MappedTime mapped = mapping.map(device, arrival);
        const Duration off = mapped.time - truth;
        outcome.outside += std::abs(off.ns) > mapped.error.ns;
        ++outcome.samples;
        outcome.worst_late_ms = std::max(outcome.worst_late_ms, off.ms());
        outcome.worst_early_ms = std::max(outcome.worst_early_ms, -off.ms());
        outcome.final_error_ms = std::abs(off.ms());
        outcome.last_stated = mapped.error;
    }
    outcome.resets = mapping.resets();
    outcome.skew = mapping.skew();
    return outcome;
}

TEST(ClockMapping, WithoutJitterTheTruthIsFoundFromTheFirstSample) {
    const Outcome outcome = run(20, 0, [](int) { return 0.0; });
    EXPECT_EQ(outcome.outside, 0);
    EXPECT_LT(outcome.worst_late_ms, 0.01);
    EXPECT_LT(outcome.worst_early_ms, 0.01);
}

TEST(ClockMapping, TheTruthLiesWithinTheStatedErrorUnderJitterAndSkew) {
    int samples = 0, outside = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const double skew = random.uniform(-100e-6, 100e-6);
        const Outcome outcome = run(120, skew, [&](int) { return std::abs(random.normal(0, 0.001)); });
        samples += outcome.samples;
        outside += outcome.outside;
        EXPECT_EQ(outcome.resets, 0);
        EXPECT_LT(outcome.final_error_ms, 0.2);
        EXPECT_LT(outcome.last_stated.ms(), 1);
        ASSERT_TRUE(outcome.skew);
        EXPECT_NEAR(*outcome.skew, skew, 20e-6);
    }
    EXPECT_LT(outside, 0.005 * samples);
}

TEST(ClockMapping, SamplesArrivingInBunchesAreSpreadOutAgain) {
    // Every other sample waits for the next one: intervals of about 14 and 2 ms.
    Random random(4);
    const Outcome outcome = run(60, 20e-6, [&](int i) {
        return (i % 2 == 0 ? 1 / 120.0 : 0.002) + std::abs(random.normal(0, 0.0005));
    });
    EXPECT_LT(outcome.worst_late_ms, 12);  // before anything but the bunches is known
    EXPECT_LT(outcome.final_error_ms,
              2.5);  // the pair's common delay of 2 ms is indistinguishable from latency
    EXPECT_EQ(outcome.resets, 0);
}

TEST(ClockMapping, AStallOfTheHostMovesNothing) {
    // For 0.6 s nothing is read; then all arrives at once.
    const Outcome outcome = run(30, 0, [](int i) {
        const double t = i / 120.0;
        return t > 15 && t < 15.6 ? 15.6 - t : 0.0;
    });
    EXPECT_EQ(outcome.resets, 0);
    EXPECT_EQ(outcome.outside, 0);
    EXPECT_LT(outcome.worst_late_ms, 0.02);
}

TEST(ClockMapping, AClockThatStartsAnewIsAReset) {
    const Outcome outcome = run(
        40, 0, [](int) { return 0.0; }, [](double t) { return t < 20 ? 0 : -22.0; });
    EXPECT_EQ(outcome.resets, 1);
    EXPECT_EQ(outcome.outside, 0);
    EXPECT_LT(outcome.worst_late_ms, 1);
}

TEST(ClockMapping, AClockThatJumpsAheadIsAReset) {
    const Outcome outcome = run(
        40, 0, [](int) { return 0.0; }, [](double t) { return t < 20 ? 0 : 5.0; });
    EXPECT_EQ(outcome.resets, 1);
    EXPECT_EQ(outcome.outside, 0);
}

TEST(ClockMapping, AClockThatStoppedWhileUnpluggedIsFoundOutWithinASecond) {
    // The device time goes on where it was, 5 s of host time later: only the persistence of the delay shows
    // it.
    ClockMapping mapping({.least_latency = {}, .resolution = {1000}});
    for (int i = 0; i < 1200; ++i) mapping.map({i * 8'333'333LL}, {i * 8'333'333LL});
    MappedTime mapped;
    HostTime arrival;
    for (int i = 1200; i < 1200 + 150; ++i) {
        arrival = {i * 8'333'333LL + 5'000'000'000LL};
        mapped = mapping.map({i * 8'333'333LL}, arrival);
    }
    EXPECT_EQ(mapping.resets(), 1);
    EXPECT_LE(std::abs((mapped.time - arrival).ns), mapped.error.ns);
}

TEST(ClockMapping, TheErrorShrinksAsSamplesCome) {
    ClockMapping mapping;
    Random random(8);
    Duration first, last;
    for (int i = 0; i < 600; ++i) {
        const std::int64_t t = i * 8'333'333LL;
        last = mapping.map({t}, {t + std::llround(std::abs(random.normal(0, 1e6)))}).error;
        if (i == 0) first = last;
    }
    EXPECT_GT(first.ms(), 10);
    EXPECT_LT(last.ms(), 4);
}

TEST(ClockMapping, AnUnknownLatencyIsPartOfTheError) {
    ClockMapping sure({.least_latency = Duration::from_ms(14)});
    ClockMapping unsure(
        {.least_latency = Duration::from_ms(14), .least_latency_error = Duration::from_ms(6)});
    const MappedTime a = sure.map({0}, {0}), b = unsure.map({0}, {0});
    EXPECT_EQ(a.time.ns, -14'000'000);
    EXPECT_EQ(b.error - a.error, Duration::from_ms(6));
}

}  // namespace
}  // namespace parafovea
