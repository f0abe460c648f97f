// Sessions whose levels follow from the answers.
#include "study/adaptive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/session_log_reader.h"
#include "study/session_replay.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::ProgramRun;
using testing::IsEmpty;

// Alpha is the factor, sigma the parameter that adapts: two tracks of 30 trials in each of two sessions.
Protocol adaptive_protocol(const std::string& procedure) {
    std::string text = test::small_protocol_text();
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("sigma = [1.5, 2]\n", "");
    replace("lead_in_s = 0.05", "lead_in_s = 0.01");
    replace("interval_s = 0.2", "interval_s = 0.01");
    return parse_protocol(
        text +
            "[procedure]\nparameter = \"sigma\"\nlevels = { from = 1, to = 3, step = 0.1 }\ntrials = 30\n" +
            procedure,
        "a.toml");
}

const char* const kStaircase = "kind = \"staircase\"\nstart = 3.0\ndown_after = 1\n";
const char* const kQuest =
    "kind = \"quest_plus\"\nthresholds = { from = 1, to = 3, step = 0.1 }\nslopes = [0.05, 0.1]\nguesses = "
    "[0.02]\nlapses = [0.02]\n";

// Sees a difference where sigma is above 1.55 (alpha 1) or 2.35 (alpha 4).
bool looks_same(const std::set<std::string>& seen) {
    for (const std::string& text : seen) {
        const MethodSetting setting = parse_method_setting(text);
        if (setting.method == "full") continue;
        return setting.numbers.at("sigma") < (setting.numbers.at("alpha") == 1 ? 1.55 : 2.35);
    }
    return true;
}

void run_to_end(SessionLog& log, const SessionHooks& hooks = {}) {
    ProgramRun run;
    run.participant.answers_same = looks_same;
    run.go(log, hooks);
}

class Adaptive : public testing::TestWithParam<const char*> {};

TEST_P(Adaptive, every_track_finds_its_own_threshold_and_replays) {
    TemporaryFolder folder;
    const Protocol protocol = adaptive_protocol(GetParam());
    {
        SessionLog log = test::start(folder / "s.sqlite", protocol);
        run_to_end(log);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    ASSERT_TRUE(rows.finished);
    std::map<std::pair<int, int>, std::vector<double>> tracks;
    for (const TrialRow& trial : rows.trials) {
        EXPECT_EQ(trial.level.has_value(), trial.planned.kind != TrialKind::validation);
        if (trial.planned.kind == TrialKind::condition)
            tracks[{trial.planned.session, trial.planned.condition}].push_back(*trial.level);
    }
    EXPECT_EQ(tracks.size(), 4u);
    for (const auto& [track, levels] : tracks) {
        ASSERT_EQ(levels.size(), 30u);
        const double threshold = track.second == 0 ? 1.55 : 2.35;
        for (std::size_t i = 22; i < levels.size(); ++i)
            EXPECT_NEAR(levels[i], threshold, 0.26) << track.second;
    }
    EXPECT_THAT(replay_session(folder / "s.sqlite").differences, IsEmpty());
}

TEST_P(Adaptive, goes_on_after_an_interruption_as_if_nothing_had_happened) {
    TemporaryFolder folder;
    const Protocol protocol = adaptive_protocol(GetParam());
    {
        SessionLog log = test::start(folder / "whole.sqlite", protocol);
        run_to_end(log);
    }
    {
        SessionLog log = test::start(folder / "cut.sqlite", protocol);
        std::stop_source stop;
        SessionHooks hooks;
        hooks.stop = stop.get_token();
        hooks.on_trial = [&, n = 0](const TrialRecord&) mutable {
            if (++n == 50) stop.request_stop();
        };
        run_to_end(log, hooks);
    }
    {
        SessionLog log = test::resume(folder / "cut.sqlite");
        run_to_end(log);
    }
    const SessionRows whole = read_session(folder / "whole.sqlite"),
                      cut = read_session(folder / "cut.sqlite");
    ASSERT_EQ(whole.trials.size(), cut.trials.size());
    for (std::size_t i = 0; i < whole.trials.size(); ++i) {
        EXPECT_EQ(whole.trials[i].level, cut.trials[i].level) << i;
        EXPECT_EQ(whole.trials[i].answer->identical, cut.trials[i].answer->identical) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Procedures, Adaptive, testing::Values(kStaircase, kQuest));

TEST(AdaptiveSession, a_restarted_session_forgets_and_still_replays) {
    TemporaryFolder folder;
    const Protocol protocol = adaptive_protocol(kStaircase);
    {
        SessionLog log = test::start(folder / "s.sqlite", protocol);
        std::stop_source stop;
        SessionHooks hooks;
        hooks.stop = stop.get_token();
        hooks.on_trial = [&, n = 0](const TrialRecord&) mutable {
            if (++n == 20) stop.request_stop();
        };
        run_to_end(log, hooks);
    }
    {
        SessionLog log = test::resume(folder / "s.sqlite", 5);
        run_to_end(log);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    const auto first_again = std::find_if(rows.trials.begin(), rows.trials.end(), [](const TrialRow& trial) {
        return trial.planned.kind == TrialKind::condition && trial.attempt == 1;
    });
    ASSERT_NE(first_again, rows.trials.end());
    EXPECT_EQ(first_again->level, 3.0);
    EXPECT_THAT(replay_session(folder / "s.sqlite").differences, IsEmpty());
}

}  // namespace
}  // namespace parafovea
