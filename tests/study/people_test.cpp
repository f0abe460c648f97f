// Consent, questionnaires, exclusion and withdrawal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "study/balance_report.h"
#include "study/exclusion.h"
#include "study/questionnaire.h"
#include "study/session_log_reader.h"
#include "study/withdrawal.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::ProgramRun;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

QuestionnaireAnswers all_symptoms(const char* value) {
    QuestionnaireAnswers answers;
    for (const Question& question : sickness_questionnaire("s", "en").questions)
        answers[question.name] = value;
    return answers;
}

// Kennedy et al. 1993: seven symptoms a scale (six for disorientation, with nausea: seven),
// weights 9.54, 7.58, 13.92 and 3.74.
TEST(SicknessScore, has_the_published_maxima) {
    const SicknessScore none = sickness_score(all_symptoms("0")), most = sickness_score(all_symptoms("3"));
    EXPECT_EQ(none.total, 0);
    EXPECT_NEAR(most.nausea, 200.34, 1e-9);
    EXPECT_NEAR(most.oculomotor, 159.18, 1e-9);
    EXPECT_NEAR(most.disorientation, 292.32, 1e-9);
    EXPECT_NEAR(most.total, 235.62, 1e-9);
}

TEST(SicknessScore, counts_each_symptom_on_its_published_scales) {
    const std::map<std::string, std::array<int, 3>> scales = {{"general_discomfort", {1, 1, 0}},
                                                              {"fatigue", {0, 1, 0}},
                                                              {"headache", {0, 1, 0}},
                                                              {"eye_strain", {0, 1, 0}},
                                                              {"difficulty_focusing", {0, 1, 1}},
                                                              {"increased_salivation", {1, 0, 0}},
                                                              {"sweating", {1, 0, 0}},
                                                              {"nausea", {1, 0, 1}},
                                                              {"difficulty_concentrating", {1, 1, 0}},
                                                              {"fullness_of_head", {0, 0, 1}},
                                                              {"blurred_vision", {0, 1, 1}},
                                                              {"dizzy_eyes_open", {0, 0, 1}},
                                                              {"dizzy_eyes_closed", {0, 0, 1}},
                                                              {"vertigo", {0, 0, 1}},
                                                              {"stomach_awareness", {1, 0, 0}},
                                                              {"burping", {1, 0, 0}}};
    ASSERT_EQ(scales.size(), 16u);
    for (const auto& [name, counts] : scales) {
        QuestionnaireAnswers answers = all_symptoms("0");
        ASSERT_TRUE(answers.contains(name));
        answers[name] = "1";
        const SicknessScore score = sickness_score(answers);
        EXPECT_NEAR(score.nausea, 9.54 * counts[0], 1e-9) << name;
        EXPECT_NEAR(score.oculomotor, 7.58 * counts[1], 1e-9) << name;
        EXPECT_NEAR(score.disorientation, 13.92 * counts[2], 1e-9) << name;
        EXPECT_NEAR(score.total, 3.74 * (counts[0] + counts[1] + counts[2]), 1e-9) << name;
    }
}

TEST(SicknessScore, an_incomplete_questionnaire_is_refused) {
    QuestionnaireAnswers answers = all_symptoms("1");
    answers.erase("vertigo");
    EXPECT_THROW(sickness_score(answers), std::runtime_error);
    answers["vertigo"] = "4";
    EXPECT_THROW(sickness_score(answers), std::runtime_error);
    answers["vertigo"] = "a lot";
    EXPECT_THROW(sickness_score(answers), std::runtime_error);
}

TEST(Questionnaires, both_languages_ask_the_same_questions) {
    Protocol protocol = load_protocol(PARAFOVEA_SOURCE_DIR "/protocols/final.toml");
    const auto english = questionnaires_before(protocol);
    protocol.language = "de";
    const auto german = questionnaires_before(protocol);
    ASSERT_EQ(english.size(), 3u);
    ASSERT_EQ(german.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(english[i].name, german[i].name);
        EXPECT_NE(english[i].title, german[i].title);
        ASSERT_EQ(english[i].questions.size(), german[i].questions.size());
        for (std::size_t k = 0; k < english[i].questions.size(); ++k) {
            EXPECT_EQ(english[i].questions[k].name, german[i].questions[k].name);
            EXPECT_EQ(english[i].questions[k].options.size(), german[i].questions[k].options.size());
            EXPECT_NE(english[i].questions[k].text, german[i].questions[k].text);
        }
    }
    EXPECT_EQ(english[0].name, "consent");
}

TEST(Questionnaires, answers_are_checked) {
    const Question number{"age_years", "", {}, 0, 120}, choice{"vision", "", {"good", "bad"}, 0, 0};
    for (const char* good : {"0", "18", "120"}) EXPECT_FALSE(answer_mistake(number, good)) << good;
    for (const char* bad : {"", "-1", "121", "18.5", "x", "18 "})
        EXPECT_TRUE(answer_mistake(number, bad)) << bad;
    EXPECT_FALSE(answer_mistake(choice, "1"));
    EXPECT_TRUE(answer_mistake(choice, "2"));
}

// A protocol that asks everything, for real people.
struct RealSession {
    explicit RealSession(const std::filesystem::path& path) {
        protocol = parse_protocol(test::small_protocol_text() +
                                      "[questions]\nconsent = true\nminimum_age_years = 18\nvision = "
                                      "true\nsickness_before_after = true\n",
                                  "p.toml");
        SessionFacts facts = test::facts();
        facts.simulated_people = false;
        log.emplace(SessionLog::create(path, facts, protocol, make_plan(protocol, 0, 1), {{}, 1}));
    }
    std::map<std::string, QuestionnaireAnswers> answers = {
        {"consent", {{"consent", "1"}}},
        {"participant", {{"age_years", "30"}, {"vision", "1"}}},
        {"sickness_before", all_symptoms("0")},
        {"sickness_after", all_symptoms("1")}};
    SessionEnd go() {
        SessionHooks hooks;
        hooks.ask = [&](const Questionnaire& questionnaire) -> std::optional<QuestionnaireAnswers> {
            asked.push_back(questionnaire.name);
            return answers.at(questionnaire.name);
        };
        return run.go(*log, hooks);
    }
    Protocol protocol;
    std::optional<SessionLog> log;
    ProgramRun run;
    std::vector<std::string> asked;
};

TEST(Consent, is_asked_first_and_everything_asked_is_kept) {
    TemporaryFolder folder;
    {
        RealSession session(folder / "s.sqlite");
        EXPECT_EQ(session.go(), SessionEnd::finished);
        EXPECT_THAT(session.asked,
                    ElementsAre("consent", "participant", "sickness_before", "sickness_after"));
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    EXPECT_EQ(rows.questionnaires.at("participant").at("age_years"), "30");
    EXPECT_NEAR(sickness_score(rows.questionnaires.at("sickness_after")).total, 78.54, 1e-9);
}

TEST(Consent, without_it_no_gaze_is_read_and_no_trial_is_shown) {
    TemporaryFolder folder;
    for (const auto& [name, question, answer] :
         {std::tuple("consent", "consent", "0"), std::tuple("participant", "age_years", "17"),
          std::tuple("participant", "vision", "3")}) {
        const auto path = folder / (std::string(question) + ".sqlite");
        {
            RealSession session(path);
            session.answers[name][question] = answer;
            EXPECT_EQ(session.go(), SessionEnd::stopped);
            std::vector<GazeSample> unread;
            session.run.clock.wait_until({1'000'000'000'000});
            session.run.gaze.drain(unread);
            EXPECT_EQ(unread.size(), session.run.gaze.to_come.size());
        }
        const SessionRows rows = read_session(path);
        EXPECT_THAT(rows.trials, IsEmpty());
        EXPECT_EQ(rows.events.front().kind, "not taking part");
    }
}

TEST(Consent, a_program_that_cannot_ask_is_refused) {
    TemporaryFolder folder;
    RealSession session(folder / "s.sqlite");
    EXPECT_THROW(session.run.go(*session.log), std::runtime_error);
}

TEST(Exclusion, follows_the_protocols_rules) {
    TemporaryFolder folder;
    {
        SessionLog log = test::start(folder / "s.sqlite");
        ProgramRun run;
        // Fails the validation trials of the second session.
        run.participant.answers_same = [&](const auto& seen) {
            return seen.size() == 1 && log.shown().size() < 7;
        };
        run.go(log);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    EXPECT_THAT(exclusion_reasons(rows, {}), IsEmpty());
    EXPECT_THAT(exclusion_reasons(rows, {0.5, std::nullopt}), IsEmpty());
    EXPECT_THAT(exclusion_reasons(rows, {0.49, std::nullopt}),
                ElementsAre(HasSubstr("2 of 4 validation trials failed")));
    EXPECT_THAT(exclusion_reasons(rows, {std::nullopt, 0}), IsEmpty());
    SessionRows lost = rows;
    lost.trials[3].invalid = {"gaze_lost"};
    lost.trials[4].invalid = {"gaze_lost"};
    EXPECT_EQ(exclusion_reasons(lost, {std::nullopt, 0}).size(), 1u);
}

TEST(Withdrawal, removes_one_persons_files_and_nothing_else) {
    TemporaryFolder folder;
    std::filesystem::create_directory(folder / "more");
    const auto make = [&](const std::string& name, const std::string& participant) {
        SessionFacts facts = test::facts();
        facts.participant = participant;
        SessionLog::create(folder / name, facts, test::small_protocol(),
                           make_plan(test::small_protocol(), 0, 1), {{}, 1});
    };
    make("a.sqlite", "p1");
    make("more/b.sqlite", "p1");
    make("c.sqlite", "p2");
    std::ofstream(folder / "d.sqlite") << "not a session";
    std::ofstream(folder / "p1.txt") << "p1";
    EXPECT_THAT(withdraw_participant(folder / "", "p1"),
                ElementsAre(folder / "a.sqlite", folder / "more/b.sqlite"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.sqlite"));
    EXPECT_FALSE(std::filesystem::exists(folder / "more/b.sqlite"));
    for (const char* kept : {"c.sqlite", "d.sqlite", "p1.txt"})
        EXPECT_TRUE(std::filesystem::exists(folder / kept)) << kept;
    EXPECT_THAT(withdraw_participant(folder / "", "p1"), IsEmpty());
    EXPECT_THROW(withdraw_participant(folder / "none", "p1"), std::runtime_error);
}

TEST(Withdrawal, leaves_everything_where_a_session_is_running) {
    TemporaryFolder folder;
    SessionLog log = test::start(folder / "s.sqlite");
    EXPECT_THROW(withdraw_participant(folder / "", "p07"), std::runtime_error);
    EXPECT_TRUE(std::filesystem::exists(folder / "s.sqlite"));
}

TEST(BalanceReport, says_what_28_participants_of_the_final_study_balance) {
    std::ostringstream out;
    write_balance_report(out, load_protocol(PARAFOVEA_SOURCE_DIR "/protocols/final.toml"), 0, 27, 7);
    const std::string text = out.str();
    EXPECT_THAT(text, HasSubstr("a condition at a position         1 times"));
    EXPECT_THAT(text, HasSubstr("a condition followed by another   1 times"));
    EXPECT_THAT(text, HasSubstr("validation trials                 12 (30 %)"));
    EXPECT_THAT(text, HasSubstr("reference first, a participant    14 of 28"));
    EXPECT_THAT(text, HasSubstr("session 2"));
    out.str("");
    write_balance_report(out, load_protocol(PARAFOVEA_SOURCE_DIR "/protocols/final.toml"), 0, 17, 7);
    EXPECT_THAT(out.str(), HasSubstr("a condition at a position         0 to 1 times"));
}

}  // namespace
}  // namespace parafovea
