// The decision, its bootstrap, the warnings and the validation arithmetic.
#include "analysis/decision.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/random_draw.h"
#include "analysis/report_warnings.h"
#include "analysis/validation.h"

namespace parafovea {
namespace {

Response answer(int participant, double sigma, double alpha, bool identical, int session = 1) {
    Response response;
    response.participant = "P" + std::to_string(participant);
    response.session = session;
    response.sigma = sigma;
    response.alpha = alpha;
    response.identical = identical;
    return response;
}

TEST(Decision, takes_the_highest_sigma_that_reaches_the_criterion_and_there_the_best_alpha) {
    Tally tally;
    for (int p = 0; p < 10; ++p) {
        tally.add(answer(p, 1.2, 1, true));
        tally.add(answer(p, 1.8, 1, p < 8));  // exactly 80 %: reached
        tally.add(answer(p, 1.8, 4, p < 9));
        tally.add(answer(p, 2.4, 4, p < 7));
    }
    const Decision decision = decide(tally, 0.8, 0.1);
    ASSERT_TRUE(decision.chosen);
    EXPECT_EQ(decision.chosen->sigma, 1.8);
    EXPECT_EQ(decision.chosen->alpha, 4.0);
    double all = 0.0;
    for (const SigmaShare& share : decision.highest_sigma) all += share.share;
    EXPECT_NEAR(all, 1.0, 1e-12);
}

// With one trial each the bootstrap draws a binomial count, whose distribution is known.
TEST(Decision, its_bootstrap_probability_is_the_binomial_one) {
    Tally tally;
    for (int p = 0; p < 20; ++p) tally.add(answer(p, 1.8, 4, p < 17));
    const Decision decision = decide(tally, 0.8, 0.1, 20'000);
    EXPECT_NEAR(decision.probability_reached, probability_of_passing(16, 20, 0.85), 0.015);
    EXPECT_EQ(decision.probability_reached, decision.probability_chosen);
    EXPECT_LT(decision.non_inferiority->low, 0.85);
    EXPECT_EQ(decision.probability_reached, decide(tally, 0.8, 0.1, 20'000).probability_reached);
}

TEST(Decision, says_so_when_nothing_is_reached_or_only_one_person_took_part) {
    Tally none;
    for (int p = 0; p < 5; ++p) none.add(answer(p, 2.4, 1, false));
    const Decision nothing = decide(none, 0.8, 0.1);
    EXPECT_FALSE(nothing.chosen || nothing.non_inferiority);
    EXPECT_NE(decision_text(nothing).find("No setting reaches"), std::string::npos);
    Tally one;
    one.add(answer(0, 1.2, 1, true));
    const Decision single = decide(one, 0.8, 0.1);
    EXPECT_TRUE(single.chosen);
    EXPECT_EQ(single.resamples, 0);
    EXPECT_NE(decision_text(single).find("one participant"), std::string::npos);
    EXPECT_FALSE(decide(Tally(), 0.8, 0.1).chosen);
}

TEST(Decision, shows_non_inferiority_only_with_enough_answers) {
    Tally few, many;
    for (int p = 0; p < 6; ++p) few.add(answer(p, 1.8, 4, true));
    for (int p = 0; p < 60; ++p) many.add(answer(p, 1.8, 4, p % 10 != 0));
    EXPECT_FALSE(decide(few, 0.8, 0.1).non_inferiority->non_inferior);  // 6 of 6 is not yet 70 % for sure
    EXPECT_TRUE(decide(many, 0.8, 0.1).non_inferiority->non_inferior);
}

TEST(Validation, chances_of_guessers_and_attentive_people_agree_with_reference_values) {
    struct Reference {
        int needed, trials;
        double guesser, fails_95, fails_90;
    };
    for (const Reference& r : {Reference{8, 10, .0547, .0115, .0702}, Reference{9, 12, .0730, .0022, .0256},
                               Reference{10, 12, .0193, .0196, .1109}, Reference{15, 20, .0207, .0003, .0113},
                               Reference{16, 20, .0059, .0026, .0432}, Reference{18, 24, .0113, .0001, .0075},
                               Reference{21, 30, .0214, .00001, .0005}}) {
        EXPECT_NEAR(probability_of_passing(r.needed, r.trials, 0.5), r.guesser, 5.1e-5);
        EXPECT_NEAR(1.0 - probability_of_passing(r.needed, r.trials, 0.95), r.fails_95, 5.1e-5);
        EXPECT_NEAR(1.0 - probability_of_passing(r.needed, r.trials, 0.90), r.fails_90, 5.1e-5);
    }
    EXPECT_EQ(probability_of_passing(0, 0, 0.5), 1.0);
    EXPECT_EQ(probability_of_passing(1, 0, 0.5), 0.0);
}

std::vector<std::string> subjects(const std::vector<Response>& responses, const StudyDescription& study) {
    Tally tally;
    for (const Response& response : responses) tally.add(response);
    std::vector<std::string> found;
    for (const ReportWarning& warning :
         find_warnings(tally, study, condition_rows(tally), cochran_table(tally, 1), validation_rows(tally)))
        found.push_back(warning.subject);
    return found;
}

bool holds(const std::vector<std::string>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

// A study with nothing to complain about: one block per participant, spread answers, a planned size.
std::vector<Response> sound_study() {
    std::mt19937_64 generator(61);
    std::vector<Response> responses;
    for (int p = 0; p < 40; ++p)
        for (double sigma : {1.4, 1.8})
            for (double alpha : {1.0, 4.0}) {
                responses.push_back(answer(p, sigma, alpha, draw_unit(generator) < 0.5));
                responses.back().foveated_first = draw_below(generator, 2) == 0;
                responses.back().dropped_frames = 0.002 * draw_unit(generator);
                responses.back().gaze_loss = 0.02 * draw_unit(generator);
            }
    return responses;
}

StudyDescription planned(int participants) {
    StudyDescription study;
    study.planned_participants = participants;
    return study;
}

TEST(Warnings, are_none_for_a_sound_study) {
    EXPECT_TRUE(subjects(sound_study(), planned(40)).empty());
}

TEST(Warnings, find_each_fault_put_into_a_sound_study) {
    const auto expect_found = [](auto&& spoil, const std::string& subject,
                                 StudyDescription study = planned(40)) {
        std::vector<Response> responses = sound_study();
        EXPECT_FALSE(holds(subjects(responses, planned(40)), subject)) << subject;
        spoil(responses);
        EXPECT_TRUE(holds(subjects(responses, study), subject)) << subject;
    };
    expect_found(
        [](auto& responses) {
            const auto copy = responses;
            for (Response response : copy) {
                response.session = 2;
                responses.push_back(response);
            }
        },
        "Rows that are not independent");
    expect_found(
        [](auto& responses) {
            for (auto& r : responses) r.identical = r.identical || r.sigma < 1.5;
        },
        "Ceiling or floor");
    expect_found(
        [](auto& responses) {
            for (auto& r : responses) r.identical = r.identical || r.sigma < 1.5;
        },
        "No informative block");
    expect_found([](auto& responses) { responses.resize(16); }, "Too few informative blocks");
    expect_found(
        [](auto& responses) {
            for (int i = 0; i < 12; ++i) {
                responses.push_back(answer(0, 0, 0, i < 5));
                responses.back().validation = true;
            }
        },
        "Validation failures");
    expect_found(
        [](auto& responses) {
            for (int i = 0; i < 12; ++i)
                responses.push_back(answer(99, 1.4 + 0.4 * (i % 2), i % 4 < 2 ? 1 : 4, true));
        },
        "One answer throughout");
    expect_found(
        [](auto& responses) {
            for (auto& r : responses)
                if (r.sigma > 1.5) *r.dropped_frames += 0.03;
        },
        "Dropped frames differ by condition");
    expect_found(
        [](auto& responses) {
            for (auto& r : responses)
                if (r.alpha > 2) *r.gaze_loss += 0.05;
        },
        "Gaze loss differs by condition");
    expect_found(
        [](auto& responses) {
            for (auto& r : responses)
                if (*r.foveated_first) r.identical = true;
        },
        "Interval bias");
    expect_found([](auto&) {}, "Fewer participants than planned", planned(1000));
    expect_found([](auto&) {}, "Optional stopping", planned(1));
    expect_found([](auto&) {}, "Sample size not fixed beforehand", planned(0));
    expect_found([](auto& responses) { responses[3].excluded_reason = "too slow"; },
                 "Exclusions without stored rules");
    expect_found([](auto& responses) { responses.erase(responses.begin()); }, "Missing answers");
    expect_found(
        [](auto& responses) {
            for (std::size_t i = 0; i < responses.size(); ++i)
                if (responses[i].sigma > 1.5 && responses[i].alpha > 2 && i % 8 > 3)
                    responses[i].excluded_reason = "gaze lost";
        },
        "Exclusions differ by condition");
    expect_found(
        [](auto& responses) {
            for (std::size_t i = 0; i < responses.size(); ++i) responses[i].site = i < 80 ? "A" : "B";
        },
        "Several sites");
}

TEST(EqualMeans, p_is_that_of_students_t_for_two_groups_and_safe_at_the_edges) {
    RunningMoments a, b;
    for (double value : {1.0, 2.0, 3.0, 4.0}) a.add(value);
    for (double value : {3.0, 4.0, 5.0, 6.0}) b.add(value);
    // t = -2 / sqrt((5/3) / 4 x 2) = -2.19089, 6 degrees of freedom: p = 0.0710 (R: t.test(1:4, 3:6,
    // var.equal = TRUE)).
    EXPECT_NEAR(*equal_means_p({a, b}), 0.0710, 5e-5);
    EXPECT_FALSE(equal_means_p({a}));
    RunningMoments c, d;
    c.add(1.0), c.add(1.0), d.add(2.0), d.add(2.0);
    EXPECT_EQ(*equal_means_p({c, d}), 0.0);
    EXPECT_EQ(*equal_means_p({c, c}), 1.0);
}

}  // namespace
}  // namespace parafovea
