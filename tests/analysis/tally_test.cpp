// Counting answers: what enters a condition, what makes a complete block, and what is left out.
#include "analysis/tally.h"

#include <gtest/gtest.h>

namespace parafovea {
namespace {

Response answer(const std::string& participant, int session, double sigma, double alpha, bool identical) {
    Response response;
    response.participant = participant;
    response.session = session;
    response.sigma = sigma;
    response.alpha = alpha;
    response.identical = identical;
    return response;
}

TEST(Tally, keeps_validation_and_excluded_trials_out_of_the_conditions) {
    Tally tally;
    tally.add(answer("A", 1, 1.2, 1, true));
    Response validation = answer("A", 1, 0, 0, false);
    validation.validation = true;
    tally.add(validation);
    Response excluded = answer("A", 1, 1.2, 1, false);
    excluded.excluded_reason = "no answer";
    tally.add(excluded);
    EXPECT_EQ(tally.counted(), 1);
    EXPECT_EQ(tally.validation_trials(), 1);
    EXPECT_EQ(tally.excluded(), 1);
    EXPECT_EQ(tally.exclusions().at("no answer"), 1);
    ASSERT_EQ(tally.by_participant({1.2, 1}).size(), 1u);
    EXPECT_EQ(tally.by_participant({1.2, 1})[0].n, 1);
    EXPECT_EQ(tally.validation_by_participant()[0].successes, 0);
}

TEST(Tally, takes_1_2_and_six_times_0_2_for_one_setting) {
    Tally tally;
    tally.add(answer("A", 1, 1.2, 1, true));
    tally.add(answer("A", 1, 6 * 0.2, 1, true));
    EXPECT_EQ(tally.sigmas().size(), 1u);
}

TEST(Tally, makes_rows_of_participant_sessions_and_leaves_incomplete_ones_out) {
    Tally tally;
    for (double alpha : {2.0, 1.0}) {
        tally.add(answer("A", 1, 1.8, alpha, alpha > 1.5));
        tally.add(answer("A", 2, 1.8, alpha, true));
        if (alpha < 1.5) tally.add(answer("B", 1, 1.8, alpha, true));
    }
    const BlockTable blocks = tally.blocks(1.8, BlockKind::participant_session);
    EXPECT_EQ(blocks.alphas, (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ(blocks.table.values, (std::vector<std::uint8_t>{0, 1, 1, 1}));
    EXPECT_EQ(blocks.incomplete_blocks, 1);
    EXPECT_EQ(blocks.participant_sums, (std::vector<std::int64_t>{1, 2}));
}

TEST(Tally, makes_one_row_of_each_repetition_within_a_session) {
    Tally tally;
    for (bool first : {true, false})
        for (double alpha : {1.0, 2.0}) tally.add(answer("A", 1, 1.8, alpha, first));
    tally.add(answer("A", 1, 1.8, 1.0, true));  // a third repetition of one condition only
    const BlockTable blocks = tally.blocks(1.8, BlockKind::participant_session);
    EXPECT_EQ(blocks.table.values, (std::vector<std::uint8_t>{1, 1, 0, 0}));
    EXPECT_EQ(blocks.repeated_blocks, 1);
    EXPECT_EQ(blocks.incomplete_blocks, 1);
}

TEST(Tally, calls_a_participant_identical_only_above_half) {
    Tally tally;
    for (int session : {1, 2, 3}) {
        tally.add(answer("A", session, 1.8, 1.0, session <= 2));  // 2 of 3
        tally.add(answer("A", session, 1.8, 2.0, session <= 1));  // 1 of 3
    }
    for (int session : {1, 2}) {
        tally.add(answer("B", session, 1.8, 1.0, session == 1));  // a tie
        tally.add(answer("B", session, 1.8, 2.0, true));
    }
    const BlockTable blocks = tally.blocks(1.8, BlockKind::participant);
    EXPECT_EQ(blocks.table.values, (std::vector<std::uint8_t>{1, 0, 0, 1}));
}

}  // namespace
}  // namespace parafovea
