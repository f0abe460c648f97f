// Protocols are read strictly, and every mistake is named with its line.
#include "study/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "study/condition_list.h"
#include "tests/study/fakes.h"

namespace parafovea {
namespace {

using test::small_protocol;
using test::small_protocol_text;
using testing::AllOf;
using testing::HasSubstr;

std::string with(const std::string& from, const std::string& to) {
    std::string text = small_protocol_text();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

int line_in(const std::string& text, const std::string& what) {
    return 1 + static_cast<int>(std::count(
                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(what)), '\n'));
}

std::vector<ProtocolMistake> mistakes_of(const std::string& text) {
    try {
        parse_protocol(text, "p.toml");
    } catch (const ProtocolError& error) {
        return error.mistakes();
    }
    return {};
}

struct Mistaken {
    const char* from;
    const char* to;
    const char* where;  // a text on the line of the mistake
    const char* says;
};

class EveryMistake : public testing::TestWithParam<Mistaken> {};

TEST_P(EveryMistake, is_named_with_its_line_what_was_expected_and_what_was_found) {
    const std::string text = with(GetParam().from, GetParam().to);
    const std::vector<ProtocolMistake> mistakes = mistakes_of(text);
    ASSERT_EQ(mistakes.size(), 1u) << (mistakes.size() > 1 ? mistakes[1].message : "no mistake found");
    EXPECT_EQ(mistakes[0].line, line_in(text, GetParam().where)) << mistakes[0].message;
    EXPECT_THAT(mistakes[0].message, AllOf(HasSubstr("expected"), HasSubstr("found"), HasSubstr("; "),
                                           HasSubstr(GetParam().says)));
}

INSTANTIATE_TEST_SUITE_P(
    Protocol, EveryMistake,
    testing::Values(
        Mistaken{"interval_s = 0.2", "interval_s = 0.2\nintervals = 3", "intervals = 3",
                 "\"intervals\"; write interval_s"},
        Mistaken{"name = \"small\"", "name = \"small\"\nparticipants = 3", "participants",
                 "\"participants\""},
        Mistaken{"width_px = 640", "width_px = 640.5", "640.5", "a whole number"},
        Mistaken{"width_px = 640", "width_px = \"640\"", "\"640\"", "a whole number"},
        Mistaken{"width_px = 640", "width_px = 1", "width_px = 1", "from 16 to 32768"},
        Mistaken{"horizontal_fov_deg = 60", "horizontal_fov_deg = 180", "180", "from 1 to 170"},
        Mistaken{"horizontal_fov_deg = 60", "horizontal_fov_deg = nan", "nan", "a number"},
        Mistaken{"refresh_hz = 100\n", "", "[display]", "\"refresh_hz\""},
        Mistaken{"name = \"small\"", "name = \"a b\"", "a b", "letters"},
        Mistaken{"name = \"small\"\n", "", "language", "\"name\""},
        Mistaken{"name = \"small\"", "name = \"small\"\nkind = \"finale\"", "finale", "free, pilot, final"},
        Mistaken{"scenes = [\"one\", \"two\"]", "scenes = [\"one\", 2]", "scenes", "a list of texts"},
        Mistaken{"scenes = [\"one\", \"two\"]", "scenes = []", "scenes", "a list of texts"},
        Mistaken{"sigma = [1.5, 2]", "sigma = { from = 1, to = 2, step = 0.3 }", "sigma", "whole steps"},
        Mistaken{"sigma = [1.5, 2]", "sigma = { from = 1, to = 2 }", "sigma", "\"step\""},
        Mistaken{"sigma = [1.5, 2]", "sigma = { from = 1, to = 2, step = 0.5, stop = 3 }", "sigma",
                 "\"stop\""},
        Mistaken{"sigma = [1.5, 2]", "sigma = []", "sigma", "at least one level"},
        Mistaken{"sigma = [1.5, 2]", "sigma = [2, 2]", "sigma", "twice"},
        Mistaken{"sigma = [1.5, 2]", "sigma = 2", "sigma", "a list"},
        Mistaken{"method = \"kfr\"\n", "", "[conditions]", "\"method\""},
        Mistaken{"training_trials = 1", "training_trials = 9", "[design]", "at most 4"},
        Mistaken{"sessions = 2", "sessions = 0", "sessions = 0", "from 1"},
        Mistaken{"sessions = 2", "sessions = true", "sessions = true", "found true"},
        Mistaken{"validation_share = 0.3333333333", "validation_share = 1.0", "validation_share",
                 "from 0 to 0.9"},
        Mistaken{"[texts.en]", "[keys]\nsame = \"A\"\n[texts.en]", "same =", "left_shoulder"},
        Mistaken{"[texts.en]", "[keys]\nsame = \"b\"\n[texts.en]", "[keys]", "two different buttons"},
        Mistaken{"[texts.en]", "[foveation]\ngaze = \"centre\"\n[texts.en]", "gaze =", "center, tracked"},
        Mistaken{"[texts.en]", "[rests]\nafter_session = 1\n[texts.en]", "after_session", "true or false"},
        Mistaken{"[texts.en]", "[validity]\ngaze_off_share = 0.5\n[texts.en]", "gaze_off_share",
                 "gaze_off_center_deg"},
        Mistaken{"[texts.en]", "[resume]\nrestart_after_h = 9\nrefuse_after_h = 3\n[texts.en]", "[resume]",
                 "swap"},
        Mistaken{"[texts.en]", "[question]\n[texts.en]", "[question]", "questions"},
        Mistaken{"language = \"en\"", "language = \"fr\"", "[texts.en]", "[texts.fr]"},
        Mistaken{"question = \"Same?\"\n", "", "[texts.en]", "\"question\""},
        Mistaken{"rest = \"Rest\"", "rest = \"Rest\"\nbreak = \"Break\"", "break =", "\"break\""},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"stair\"\nparameter = \"x\"\nlevels = [1, 2]\ntrials = 3\n[design]",
                 "kind =", "quest_plus"},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"staircase\"\nparameter = \"sigma\"\nlevels = [1, 2]\ntrials = "
                 "3\nstart = 1\n[design]",
                 "parameter =", "no factor"},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"staircase\"\nparameter = \"x\"\nlevels = [2, 1]\ntrials = 3\nstart = "
                 "1\n[design]",
                 "levels =", "ascending"},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"staircase\"\nparameter = \"x\"\nlevels = [1, 2]\ntrials = 3\nstart = "
                 "1.5\n[design]",
                 "start =", "one of the levels"},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"staircase\"\nparameter = \"x\"\nlevels = [1, 2]\ntrials = 3\nstart = "
                 "1\nslopes = [1]\n[design]",
                 "slopes =", "\"slopes\""},
        Mistaken{"[design]",
                 "[procedure]\nkind = \"quest_plus\"\nparameter = \"x\"\nlevels = [1, 2]\ntrials = "
                 "3\nthresholds = [1, 2]\nslopes = [0]\n[design]",
                 "slopes =", "above 0"},
        Mistaken{"gap_s = 0.1", "gap_s = ", "gap_s", "grammar"}));

TEST(Protocol, all_mistakes_are_told_at_once_in_the_order_of_lines) {
    std::string text = with("width_px = 640", "width_px = 1");
    text.replace(text.find("gap_s = 0.1"), 11, "gap_s = -1\ngab_s = 2");
    text.replace(text.find("refresh_hz = 100"), 16, "refresh = 100");
    const auto mistakes = mistakes_of(text);
    // A required key under another spelling is one mistake, not also a missing key.
    ASSERT_EQ(mistakes.size(), 4u);
    EXPECT_TRUE(std::is_sorted(mistakes.begin(), mistakes.end(),
                               [](const auto& a, const auto& b) { return a.line < b.line; }));
    try {
        parse_protocol(text, "p.toml");
        FAIL();
    } catch (const ProtocolError& error) {
        const std::string what = error.what();
        EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 3);
        EXPECT_THAT(what, HasSubstr("found \"refresh\"; write refresh_hz"));
        EXPECT_THAT(
            what, HasSubstr("p.toml:" + std::to_string(line_in(text, "gap_s = -1")) + ": expected a number"));
    }
}

TEST(Protocol, a_file_that_is_not_there_is_one_clear_line) {
    try {
        load_protocol("/nonexistent/p.toml");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("/nonexistent/p.toml"), HasSubstr("expected"),
                                        HasSubstr("check the path")));
    }
}

TEST(Protocol, hash_changes_with_any_byte) {
    std::set<std::string> hashes;
    Protocol protocol;
    protocol.source = small_protocol_text();
    hashes.insert(protocol_hash(protocol));
    for (std::size_t i = 0; i < protocol.source.size(); ++i) {
        Protocol changed = protocol;
        changed.source[i] = static_cast<char>(changed.source[i] ^ 1);
        hashes.insert(protocol_hash(changed));
    }
    EXPECT_EQ(hashes.size(), protocol.source.size() + 1);
    // The published FNV-1a hash of "foobar".
    protocol.source = "foobar";
    EXPECT_EQ(protocol_hash(protocol), "85944171f73967e8");
}

TEST(Protocol, factors_are_crossed_with_the_first_slowest) {
    const Protocol protocol = small_protocol();
    ASSERT_EQ(protocol.conditions.size(), 4u);
    EXPECT_EQ(to_text(protocol.conditions[0]), "kfr(alpha=1,sigma=1.5)");
    EXPECT_EQ(to_text(protocol.conditions[1]), "kfr(alpha=4,sigma=1.5)");
    EXPECT_EQ(to_text(protocol.conditions[2]), "kfr(alpha=1,sigma=2)");
    EXPECT_EQ(to_text(protocol.conditions[3]), "kfr(alpha=4,sigma=2)");
    EXPECT_EQ(protocol.factors, (std::vector<std::string>{"sigma", "alpha"}));
    EXPECT_EQ(to_text(protocol.reference), "full");
}

TEST(Protocol, methods_words_and_switches_can_be_factors) {
    const Protocol protocol = parse_protocol(
        with("sigma = [1.5, 2]",
             "method = [\"kfr\", \"f3d\"]\nkernel = [\"power\", \"sine\"]\nas_printed = [true, false]"),
        "p.toml");
    ASSERT_EQ(protocol.conditions.size(), 16u);
    EXPECT_EQ(to_text(protocol.conditions[0]), "kfr(alpha=1,as_printed=1,kernel=power)");
    EXPECT_EQ(to_text(protocol.conditions[15]), "f3d(alpha=4,as_printed=0,kernel=sine)");
}

TEST(Protocol, conditions_can_be_listed) {
    const std::string list =
        "[conditions.fixed]\nkernel = \"sine\"\n[[conditions.list]]\nsigma = 1.2\nalpha = "
        "3\n[[conditions.list]]\nmethod = \"f3d\"\nrings = 3\n";
    const Protocol protocol =
        parse_protocol(with("[conditions.factors]\nsigma = [1.5, 2]\nalpha = [1, 4]\n", list), "p.toml");
    ASSERT_EQ(protocol.conditions.size(), 2u);
    EXPECT_EQ(to_text(protocol.conditions[0]), "kfr(alpha=3,kernel=sine,sigma=1.2)");
    EXPECT_EQ(to_text(protocol.conditions[1]), "f3d(kernel=sine,rings=3)");
}

TEST(Protocol, stepped_numbers_are_the_doubles_their_decimals_name) {
    EXPECT_EQ(stepped_numbers(1.2, 2.4, 0.2), (std::vector<double>{1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4}));
    EXPECT_EQ(stepped_numbers(1.0, 3.6, 0.2).size(), 14u);
    EXPECT_EQ(stepped_numbers(2, 1, -0.5), (std::vector<double>{2, 1.5, 1}));
    EXPECT_EQ(stepped_numbers(3, 3, 1), (std::vector<double>{3}));
    EXPECT_TRUE(stepped_numbers(1, 2, 0).empty());
    EXPECT_TRUE(stepped_numbers(1, 2, -1).empty());
    EXPECT_TRUE(stepped_numbers(0, 1e9, 1).empty());
}

TEST(Protocol, every_button_has_a_name_that_reads_back) {
    for (int i = 0; i <= static_cast<int>(Button::right); ++i)
        EXPECT_EQ(button_from_name(button_name(static_cast<Button>(i))), static_cast<Button>(i));
    EXPECT_FALSE(button_from_name("A"));
}

TEST(Protocol, resume_policy_follows_the_age) {
    const ResumeRules rules{1, 24};
    EXPECT_EQ(rules.policy(0), ResumePolicy::resume);
    EXPECT_EQ(rules.policy(1), ResumePolicy::resume);
    EXPECT_EQ(rules.policy(1.001), ResumePolicy::restart_block);
    EXPECT_EQ(rules.policy(24.001), ResumePolicy::refuse);
}

std::string protocol_path(const char* name) {
    return std::string(PARAFOVEA_SOURCE_DIR "/protocols/") + name;
}

TEST(ShippedProtocols, final_is_section_4_3_of_the_paper) {
    const Protocol protocol = load_protocol(protocol_path("final.toml"));
    EXPECT_EQ(protocol.kind, StudyKind::final);
    EXPECT_EQ(protocol.timing.interval_s, 2.5);
    EXPECT_EQ(protocol.timing.gap_s, 0.75);
    EXPECT_FALSE(protocol.timing.response_window_s);
    EXPECT_EQ(protocol.design.training_trials, 5);
    EXPECT_EQ(protocol.conditions_per_session(), 28);
    EXPECT_EQ(protocol.validation_per_session(), 12);
    EXPECT_EQ(protocol.foveation_gaze, GazePolicy::center);
    EXPECT_TRUE(protocol.rests.after_session);
    EXPECT_TRUE(protocol.rests.after_failed_validation);
    std::set<std::pair<double, double>> conditions;
    for (const MethodSetting& setting : protocol.conditions)
        conditions.emplace(setting.numbers.at("sigma"), setting.numbers.at("alpha"));
    std::set<std::pair<double, double>> expected;
    for (const double sigma : {1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4})
        for (const double alpha : {1.0, 2.0, 3.0, 4.0}) expected.emplace(sigma, alpha);
    EXPECT_EQ(conditions, expected);
}

TEST(ShippedProtocols, pilot_is_section_4_2_of_the_paper) {
    const Protocol protocol = load_protocol(protocol_path("pilot.toml"));
    EXPECT_EQ(protocol.kind, StudyKind::pilot);
    EXPECT_EQ(protocol.timing.interval_s, 2.0);
    EXPECT_EQ(protocol.timing.gap_s, 0.75);
    EXPECT_EQ(protocol.design.training_trials, 20);
    EXPECT_EQ(protocol.design.sessions, 3);
    EXPECT_EQ(protocol.conditions_per_session(), 56);
    EXPECT_EQ(protocol.validation_per_session(), 0);
    EXPECT_EQ(protocol.conditions.front().numbers.at("sigma"), 1.0);
    EXPECT_EQ(protocol.conditions.back().numbers.at("sigma"), 3.6);
}

TEST(ShippedProtocols, each_is_read_and_has_14_pixels_a_degree_and_two_languages) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PARAFOVEA_SOURCE_DIR "/protocols")) {
        if (entry.path().extension() != ".toml") continue;
        ++count;
        const Protocol protocol = load_protocol(entry.path());
        EXPECT_EQ(protocol.name, entry.path().stem());
        EXPECT_NEAR(protocol.display.view.pixels_per_degree(), 14, 0.25) << entry.path();
        EXPECT_GE(protocol.texts.size(), 2u) << entry.path();
    }
    EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace parafovea
