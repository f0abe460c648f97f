// The simulated participant: it decides as its stated model says, from pictures and gaze alone.
#include "app/simulated_participant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

namespace parafovea {
namespace {

constexpr SizePx kSize{48, 40};
constexpr PointPx kCentre{24, 20};

// Grey with a little chequered contrast of the given depth.
struct Chequers {
    std::vector<std::uint8_t> rgba;
    std::uint64_t hash = 0;

    explicit Chequers(int depth) : hash(1000 + static_cast<std::uint64_t>(depth)) {
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                const auto v = static_cast<std::uint8_t>(188 + ((x / 4 + y / 4) % 2 ? depth : -depth));
                rgba.insert(rgba.end(), {v, v, v, 255});
            }
    }
    operator PictureOnDisplay() const { return {rgba, kSize, hash}; }
};

PicturePairJudge make_judge(std::size_t memory_bytes = std::size_t{1} << 28) {
    return PicturePairJudge(display_model({kSize, 6}, 100), memory_bytes);
}

double share_different(const PictureOnDisplay& a, const PictureOnDisplay& b, const ObserverTraits& traits,
                       int trials) {
    PicturePairJudge judge = make_judge();
    SimulatedParticipant participant(traits, Random(11), judge);
    int different = 0;
    for (int i = 0; i < trials; ++i)
        different += participant.answer({a, kCentre}, {b, kCentre}).identical ? 0 : 1;
    return static_cast<double>(different) / trials;
}

TEST(SimulatedParticipant, OneJodIsThreeQuartersPreferenceInATwoAlternativeChoice) {
    const double d = sensitivity_index(9);
    EXPECT_NEAR(0.5 * std::erfc(-d / 2), 0.75, 1e-9);  // Phi(d / sqrt(2))
    EXPECT_EQ(sensitivity_index(10), 0);
}

// Pairs of false-alarm and hit rate with the differencing model's d', solved independently.
TEST(SimulatedParticipant, DecidesByTheDifferencingRule) {
    struct Row {
        double false_alarms, hits, d_prime, z_of_half_false_alarms;
    };
    for (const Row& row : {Row{0.1, 0.7, 3.0675, -1.644854},
                           {0.2, 0.5, 1.7933, -1.281552},
                           {0.05, 0.9, 4.5842, -1.959964},
                           {0.1, 0.3, 1.5727, -1.644854},
                           {0.1, 0.15, 0.7710, -1.644854}}) {
        ObserverTraits traits;
        traits.lapse_rate = 0;
        traits.criterion = -std::sqrt(2.0) * row.z_of_half_false_alarms;
        EXPECT_NEAR(probability_of_different(10, traits), row.false_alarms, 1e-4);
        EXPECT_NEAR(probability_of_different(10 - row.d_prime / sensitivity_index(9), traits), row.hits,
                    2e-4);
    }
}

TEST(SimulatedParticipant, TheAverageOneCallsOneIdenticalPairInTwentyDifferent) {
    ObserverTraits traits;
    traits.lapse_rate = 0;
    EXPECT_NEAR(probability_of_different(10, traits), 0.05, 1e-5);
}

TEST(SimulatedParticipant, AnswersAtTheRateItsModelPredicts) {
    const Chequers reference(6);
    PicturePairJudge judge = make_judge();
    for (const int depth : {6, 7, 9, 12})
        for (const double sensitivity : {0.7, 1.4}) {
            ObserverTraits traits;
            traits.sensitivity = sensitivity;
            const Chequers test(depth);
            const double expected =
                probability_of_different(judge.jod(test, reference, kCentre, sensitivity), traits);
            const int trials = 4000;
            const double error = std::sqrt(expected * (1 - expected) / trials);
            EXPECT_NEAR(share_different(test, reference, traits, trials), expected, 4 * error) << depth;
        }
}

TEST(SimulatedParticipant, SaysDifferentMoreOftenTheLargerTheDifferenceAndTheKeenerTheEye) {
    PicturePairJudge judge = make_judge();
    const Chequers reference(6);
    double before = 10;
    for (const int depth : {7, 9, 12, 16}) {
        const double jod = judge.jod(Chequers(depth), reference, kCentre);
        EXPECT_LT(jod, before);
        EXPECT_LT(judge.jod(Chequers(depth), reference, kCentre, 1.4), jod);
        EXPECT_GT(probability_of_different(jod, {}), probability_of_different(before, {}));
        before = jod;
    }
}

TEST(SimulatedParticipant, APersonWhoOnlyLapsesTossesACoin) {
    ObserverTraits traits;
    traits.lapse_rate = 1;
    EXPECT_NEAR(share_different(Chequers(6), Chequers(40), traits, 4000), 0.5, 0.04);
    EXPECT_EQ(probability_of_different(0, traits), 0.5);
}

TEST(SimulatedParticipant, EyesShutInOneIntervalLeaveOnlyGuessing) {
    PicturePairJudge judge = make_judge();
    SimulatedParticipant participant({}, Random(5), judge);
    const Chequers a(6), b(60);
    int different = 0;
    for (int i = 0; i < 2000; ++i) {
        const SameDifferentAnswer answer = participant.answer({a, std::nullopt}, {b, kCentre});
        EXPECT_EQ(answer.jod, 10);
        different += answer.identical ? 0 : 1;
    }
    EXPECT_NEAR(different / 2000.0, probability_of_different(10, {}), 0.025);
    EXPECT_EQ(judge.decompositions(), 0);
}

TEST(SimulatedParticipant, ComparesOnlyWhatBothGazesResolve) {
    PicturePairJudge judge = make_judge();
    SimulatedParticipant participant({}, Random(5), judge);
    const Chequers a(6), b(20);
    const PointPx near = kCentre, far{3000, 20};
    const double jod_near = judge.jod(a, b, near), jod_far = judge.jod(a, b, far);
    ASSERT_LT(jod_near, jod_far);
    EXPECT_EQ(participant.answer({a, near}, {b, far}).jod, jod_far);
    EXPECT_EQ(participant.answer({a, far}, {b, near}).jod, jod_far);
    EXPECT_EQ(participant.answer({a, near}, {b, near}).jod, jod_near);
}

TEST(SimulatedParticipant, RepeatsItselfFromTheSameSeedWhicheverPictureComesFirst) {
    PicturePairJudge judge = make_judge();
    const Chequers a(6), b(12);
    SimulatedParticipant one({}, Random(3), judge), two({}, Random(3), judge), other({}, Random(4), judge);
    bool differs = false;
    for (int i = 0; i < 200; ++i) {
        const auto x = one.answer({a, kCentre}, {b, kCentre}), y = two.answer({b, kCentre}, {a, kCentre}),
                   z = other.answer({a, kCentre}, {b, kCentre});
        EXPECT_EQ(x.identical, y.identical);
        EXPECT_EQ(x.response_time, y.response_time);
        differs |= x.response_time != z.response_time;
    }
    EXPECT_TRUE(differs);
}

TEST(SimulatedParticipant, ResponseTimesAreSkewedAndSlowestInDoubt) {
    PicturePairJudge judge = make_judge();
    const auto times = [&](const Chequers& test) {
        SimulatedParticipant participant({}, Random(8), judge);
        std::vector<double> seconds;
        for (int i = 0; i < 4000; ++i)
            seconds.push_back(
                participant.answer({Chequers(6), kCentre}, {test, kCentre}).response_time.seconds());
        std::sort(seconds.begin(), seconds.end());
        return seconds;
    };
    const auto mean = [](const std::vector<double>& v) {
        double sum = 0;
        for (const double x : v) sum += x;
        return sum / static_cast<double>(v.size());
    };
    const auto easy = times(Chequers(66));
    EXPECT_GT(easy.front(), 0);
    EXPECT_NEAR(mean(easy), 0.45 + 0.25, 0.03);  // certain: hardly any doubt is added
    EXPECT_GT(mean(easy), easy[easy.size() / 2]);
    EXPECT_GT(mean(times(Chequers(10))), mean(easy));
}

TEST(SimulatedParticipant, PeopleDifferAsStated) {
    Random random(21);
    double sum = 0, squares = 0, criterion = 0;
    const int people = 4000;
    for (int i = 0; i < people; ++i) {
        const ObserverTraits t = draw_observer_traits(random);
        sum += std::log10(t.sensitivity);
        squares += std::log10(t.sensitivity) * std::log10(t.sensitivity);
        criterion += t.criterion;
        EXPECT_GE(t.lapse_rate, 0.01);
        EXPECT_LT(t.lapse_rate, 0.02);
        EXPECT_GT(t.exponential_response_s, 0);
    }
    EXPECT_NEAR(sum / people, 0, 0.01);
    EXPECT_NEAR(std::sqrt(squares / people), 0.15, 0.01);
    EXPECT_NEAR(criterion / people, 2.7718, 0.02);
}

TEST(SimulatedParticipant, TheExpectedShareIsTheMeanOfManyPeople) {
    PicturePairJudge judge = make_judge();
    const Chequers reference(6);
    for (const int depth : {6, 8, 11, 20}) {
        const Chequers test(depth);
        Random random(77);
        double sum = 0;
        const int people = 2000;
        for (int i = 0; i < people; ++i) {
            const ObserverTraits t = draw_observer_traits(random);
            sum += 1 - probability_of_different(judge.jod(test, reference, kCentre, t.sensitivity), t);
        }
        EXPECT_NEAR(expected_share_identical(test, reference, kCentre, judge), sum / people, 0.015) << depth;
    }
}

TEST(PicturePairJudge, TakesEachPairApartOnceInEitherOrder) {
    PicturePairJudge judge = make_judge();
    const Chequers a(6), b(12), c(13);
    const double jod = judge.jod(a, b, kCentre);
    EXPECT_EQ(judge.jod(b, a, kCentre), jod);
    EXPECT_EQ(judge.jod(a, a, kCentre), 10);
    EXPECT_NE(judge.jod(a, b, {40, 2}), jod);
    EXPECT_EQ(judge.decompositions(), 1);
    judge.jod(a, c, kCentre);
    EXPECT_EQ(judge.decompositions(), 2);
}

TEST(PicturePairJudge, ForgettingChangesNoAnswer) {
    PicturePairJudge roomy = make_judge(), forgetful = make_judge(0);
    for (int round = 0; round < 2; ++round)
        for (const int depth : {7, 9, 12})
            EXPECT_EQ(roomy.jod(Chequers(6), Chequers(depth), kCentre),
                      forgetful.jod(Chequers(6), Chequers(depth), kCentre));
    EXPECT_EQ(roomy.decompositions(), 3);
    EXPECT_EQ(forgetful.decompositions(), 6);
}

TEST(PicturePairJudge, ThreadsShareItWithoutChangingAnswers) {
    PicturePairJudge judge = make_judge(40000), alone = make_judge();
    const Chequers reference(6);
    std::vector<double> expected;
    for (int depth = 7; depth < 17; ++depth)
        expected.push_back(alone.jod(Chequers(depth), reference, kCentre));
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 100; ++i) {
                const int k = (i * (t + 3)) % 10;
                wrong[t] += judge.jod(Chequers(7 + k), reference, kCentre) != expected[k] ? 1 : 0;
            }
        });
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(PicturePairJudge, PicturesOfAnotherSizeAreRefused) {
    PicturePairJudge judge(display_model({{20, 20}, 60}, 100));
    EXPECT_THROW(judge.jod(Chequers(6), Chequers(7), kCentre), std::runtime_error);
}

}  // namespace
}  // namespace parafovea
