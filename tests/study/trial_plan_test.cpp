// The plan: complete, repeatable for ever, balanced.
#include "study/trial_plan.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "study/counterbalance.h"
#include "tests/study/fakes.h"

namespace parafovea {
namespace {

Protocol shipped(const char* name) {
    return load_protocol(std::string(PARAFOVEA_SOURCE_DIR "/protocols/") + name);
}

std::vector<PlannedTrial> of_session(const TrialPlan& plan, int session) {
    std::vector<PlannedTrial> trials;
    for (const PlannedTrial& trial : plan.trials)
        if (trial.session == session) trials.push_back(trial);
    return trials;
}

std::vector<int> condition_order(const TrialPlan& plan, int session) {
    std::vector<int> order;
    for (const PlannedTrial& trial : of_session(plan, session))
        if (trial.kind == TrialKind::condition) order.push_back(trial.condition);
    return order;
}

std::string csv(const TrialPlan& plan, const Protocol& protocol) {
    std::ostringstream out;
    write_plan_csv(out, plan, protocol);
    return out.str();
}

// The plan of a seed is part of what a publication may cite: this file never changes. To make it for a new
// protocol, run with PARAFOVEA_WRITE_GOLDEN=1.
void expect_golden(const std::string& name, const std::string& text) {
    const std::filesystem::path path =
        std::filesystem::path(PARAFOVEA_SOURCE_DIR "/tests/study/golden") / name;
    if (std::getenv("PARAFOVEA_WRITE_GOLDEN")) std::ofstream(path, std::ios::binary) << text;
    std::ifstream file(path, std::ios::binary);
    ASSERT_TRUE(file) << path;
    std::stringstream stored;
    stored << file.rdbuf();
    EXPECT_EQ(text, stored.str());
}

TEST(TrialPlan, the_same_seed_gives_the_stored_plan_for_ever) {
    expect_golden("plan_small_participant_3_seed_7.csv",
                  csv(make_plan(test::small_protocol(), 3, 7), test::small_protocol()));
    Protocol protocol = test::small_protocol();
    protocol.design.repetitions = 2;
    protocol.design.scene_use = SceneUse::crossed;
    protocol.design.condition_order = ConditionOrder::shuffled;
    protocol.design.interval_order = IntervalOrder::random;
    expect_golden("plan_crossed_participant_0_seed_1.csv", csv(make_plan(protocol, 0, 1), protocol));
}

TEST(TrialPlan, depends_on_seed_and_participant) {
    const Protocol protocol = shipped("final.toml");
    EXPECT_EQ(make_plan(protocol, 4, 9), make_plan(protocol, 4, 9));
    EXPECT_NE(make_plan(protocol, 4, 9).trials, make_plan(protocol, 4, 10).trials);
    EXPECT_NE(make_plan(protocol, 4, 9).trials, make_plan(protocol, 5, 9).trials);
    // What is balanced over participants must not depend on the seed.
    EXPECT_EQ(condition_order(make_plan(protocol, 4, 9), 1), condition_order(make_plan(protocol, 4, 10), 1));
}

TEST(TrialPlan, numbers_positions_and_intervals_are_consistent) {
    for (const char* name : {"pilot.toml", "final.toml", "demo.toml"}) {
        const Protocol protocol = shipped(name);
        const TrialPlan plan = make_plan(protocol, 11, 5);
        EXPECT_EQ(plan.trials.size(),
                  static_cast<std::size_t>(protocol.design.training_trials +
                                           protocol.design.sessions * (protocol.conditions_per_session() +
                                                                       protocol.validation_per_session())));
        int previous_session = 0, position = 0;
        for (std::size_t i = 0; i < plan.trials.size(); ++i) {
            const PlannedTrial& trial = plan.trials[i];
            EXPECT_EQ(trial.number, static_cast<int>(i));
            if (trial.session != previous_session) position = 0;
            EXPECT_EQ(trial.position, position++);
            EXPECT_GE(trial.session, previous_session);
            previous_session = trial.session;
            if (trial.kind == TrialKind::validation) {
                EXPECT_EQ(trial.condition, -1);
                EXPECT_EQ(to_text(trial.first), "full");
                EXPECT_EQ(trial.first, trial.second);
            } else {
                const MethodSetting& setting =
                    protocol.conditions.at(static_cast<std::size_t>(trial.condition));
                EXPECT_EQ(trial.reference_interval == 0 ? trial.second : trial.first, setting);
                EXPECT_EQ(trial.reference_interval == 0 ? trial.first : trial.second, protocol.reference);
                EXPECT_EQ(trial.kind == TrialKind::training, trial.session == 0);
            }
        }
    }
}

TEST(TrialPlan, training_shows_distinct_conditions) {
    const Protocol protocol = shipped("pilot.toml");
    for (int participant = 0; participant < 20; ++participant) {
        std::set<int> conditions;
        for (const PlannedTrial& trial : of_session(make_plan(protocol, participant, 3), 0))
            conditions.insert(trial.condition);
        EXPECT_EQ(conditions.size(), 20u);
    }
}

TEST(FinalStudy, validation_trials_are_exactly_30_percent_of_every_testing_session) {
    const Protocol protocol = shipped("final.toml");
    for (int participant = 0; participant < 28; ++participant)
        for (std::uint64_t seed = 0; seed < 5; ++seed)
            for (int session = 1; session <= 2; ++session) {
                const auto trials = of_session(make_plan(protocol, participant, seed), session);
                const auto validation = std::count_if(trials.begin(), trials.end(), [](const auto& t) {
                    return t.kind == TrialKind::validation;
                });
                EXPECT_EQ(trials.size(), 40u);
                EXPECT_EQ(validation, 12);
            }
}

TEST(FinalStudy, validation_trials_come_at_every_place_about_equally_often) {
    const Protocol protocol = shipped("final.toml");
    std::array<int, 40> at{};
    const int plans = 1000;
    for (int seed = 0; seed < plans; ++seed)
        for (const PlannedTrial& trial :
             of_session(make_plan(protocol, 0, static_cast<std::uint64_t>(seed)), 1))
            if (trial.kind == TrialKind::validation) ++at[static_cast<std::size_t>(trial.position)];
    // Binomial(1000, 0.3): SD 14.5; the largest of 40 stays within 4.5 SD with probability 0.9997. The seeds
    // are fixed.
    for (const int count : at) EXPECT_NEAR(count, 300, 65);
}

TEST(FinalStudy, over_28_participants_each_session_is_a_williams_square) {
    const Protocol protocol = shipped("final.toml");
    for (int session = 1; session <= 2; ++session) {
        std::vector<std::vector<int>> orders;
        for (int participant = 0; participant < 28; ++participant)
            orders.push_back(condition_order(make_plan(protocol, participant, 77), session));
        // Counted here from scratch: each condition once at each position, each followed by each other once.
        std::map<std::pair<int, std::size_t>, int> at;
        std::map<std::pair<int, int>, int> followed;
        for (const auto& order : orders) {
            ASSERT_EQ(order.size(), 28u);
            for (std::size_t i = 0; i < 28; ++i) {
                ++at[{order[i], i}];
                if (i > 0) ++followed[{order[i - 1], order[i]}];
            }
        }
        EXPECT_EQ(at.size(), 28u * 28u);
        for (const auto& [key, count] : at) EXPECT_EQ(count, 1);
        EXPECT_EQ(followed.size(), 28u * 27u);
        for (const auto& [key, count] : followed) EXPECT_EQ(count, 1);
    }
}

TEST(FinalStudy, a_participants_two_sessions_have_different_orders_and_scenes) {
    const Protocol protocol = shipped("final.toml");
    int first_scene = 0;
    for (int participant = 0; participant < 28; ++participant) {
        const TrialPlan plan = make_plan(protocol, participant, 1);
        EXPECT_NE(condition_order(plan, 1), condition_order(plan, 2));
        EXPECT_NE(of_session(plan, 1).front().scene, of_session(plan, 2).front().scene);
        first_scene += of_session(plan, 1).front().scene == protocol.scenes.front();
    }
    EXPECT_EQ(first_scene, 14);
}

TEST(FinalStudy, the_reference_comes_first_in_half_of_each_session_and_once_for_each_condition) {
    const Protocol protocol = shipped("final.toml");
    for (int participant = 0; participant < 10; ++participant) {
        const TrialPlan plan = make_plan(protocol, participant, 123);
        std::map<int, std::set<int>> intervals;
        for (int session = 1; session <= 2; ++session) {
            int second = 0;
            for (const PlannedTrial& trial : of_session(plan, session)) {
                if (trial.kind != TrialKind::condition) continue;
                second += trial.reference_interval;
                intervals[trial.condition].insert(trial.reference_interval);
            }
            EXPECT_EQ(second, 14);
        }
        for (const auto& [condition, seen] : intervals) EXPECT_EQ(seen.size(), 2u);
    }
}

TEST(TrialPlan, crossed_scenes_show_every_condition_with_every_scene_in_every_session) {
    Protocol protocol = test::small_protocol();
    protocol.design.scene_use = SceneUse::crossed;
    protocol.design.repetitions = 3;
    const TrialPlan plan = make_plan(protocol, 2, 9);
    for (int session = 1; session <= 2; ++session) {
        std::map<std::pair<int, std::string>, int> shown;
        for (const PlannedTrial& trial : of_session(plan, session))
            if (trial.kind == TrialKind::condition) ++shown[{trial.condition, trial.scene}];
        EXPECT_EQ(shown.size(), 8u);
        for (const auto& [key, count] : shown) EXPECT_EQ(count, 3);
    }
}

TEST(TrialPlan, csv_has_a_line_for_every_trial_and_a_column_for_every_factor) {
    const Protocol protocol = test::small_protocol();
    const std::string text = csv(make_plan(protocol, 0, 1), protocol);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 13);
    EXPECT_EQ(
        text.substr(0, text.find('\n')),
        "trial,session,block,position,kind,condition,scene,reference_interval,first,second,sigma,alpha");
}

class WilliamsSquare : public testing::TestWithParam<int> {};

TEST_P(WilliamsSquare, balances_positions_and_carry_over) {
    const int n = GetParam();
    const auto square = williams_square(n);
    EXPECT_EQ(square.size(), static_cast<std::size_t>(n % 2 == 0 || n == 1 ? n : 2 * n));
    for (const auto& row : square)
        EXPECT_EQ(std::set<int>(row.begin(), row.end()).size(), static_cast<std::size_t>(n));
    const Balance balance = balance_of(square, n);
    const int times = n % 2 == 0 || n == 1 ? 1 : 2;
    EXPECT_EQ(balance.position_low, times);
    EXPECT_EQ(balance.position_high, times);
    if (n > 1) {
        EXPECT_EQ(balance.followed_low, times);
        EXPECT_EQ(balance.followed_high, times);
    }
}

INSTANTIATE_TEST_SUITE_P(OfEverySize, WilliamsSquare,
                         testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 9, 27, 28, 56, 57));

TEST(Balance, finds_what_is_not_balanced) {
    const Balance balance = balance_of({{0, 1, 2}, {0, 2, 1}}, 3);
    EXPECT_EQ(balance.position_low, 0);
    EXPECT_EQ(balance.position_high, 2);
    EXPECT_EQ(balance.followed_low, 0);
    EXPECT_EQ(balance.followed_high, 1);
    EXPECT_EQ(balance.at_position[0][0], 2);
    EXPECT_EQ(balance.followed_by[2][1], 1);
}

}  // namespace
}  // namespace parafovea
