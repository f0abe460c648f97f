// Power by simulation: what must hold for any design.
#include "analysis/power.h"

#include <gtest/gtest.h>

#include "tests/analysis/temporary_folder.h"

namespace parafovea {
namespace {

PowerQuestion small_question() {
    PowerQuestion question;
    for (double sigma : {1.4, 1.8, 2.2})
        for (double alpha : {1.0, 2.0, 3.0, 4.0}) question.plan.push_back({{sigma, alpha}, 1});
    for (double alpha : {1.0, 2.0, 3.0, 4.0})
        question.assumptions.functions.push_back({alpha, 2.4 + 0.7 * alpha, 4.0});
    question.studies = 200;
    question.permutations = 99;
    return question;
}

TEST(Power, rises_with_participants_sessions_and_effect) {
    PowerQuestion question = small_question();
    question.participants = {6, 40};
    question.sessions = {1, 4};
    question.effects = {0.5, 1.5};
    const auto points = simulate_power(question);
    ASSERT_EQ(points.size(), 8u);
    const auto power = [&](int people, int sessions, double effect) {
        for (const PowerPoint& point : points)
            if (point.participants == people && point.sessions == sessions && point.effect == effect)
                return point.sigmas[1].permutation;
        ADD_FAILURE() << "no such point";
        return 0.0;
    };
    for (double effect : {0.5, 1.5})
        for (int sessions : {1, 4}) EXPECT_GT(power(40, sessions, effect), power(6, sessions, effect));
    for (int people : {6, 40}) EXPECT_GT(power(people, 4, 1.5), power(people, 4, 0.5));
    EXPECT_GT(power(40, 4, 1.5), 0.9);
    for (const PowerPoint& point : points) EXPECT_GT(point.wilson_width, 0.0);
}

TEST(Power, without_an_effect_is_the_level_of_the_permutation_test) {
    PowerQuestion question = small_question();
    question.participants = {18};
    question.sessions = {8};
    question.effects = {0.0};
    question.assumptions.condition_sd = 1.5;
    question.studies = 600;
    const auto points = simulate_power(question);
    for (const SigmaPower& sigma : points[0].sigmas) {
        EXPECT_LT(sigma.permutation, 0.05 + 4.0 * monte_carlo_error(0.05, 600));
        EXPECT_GT(sigma.cochran, 0.09)
            << "treating sessions as independent must be seen to reject too often here";
    }
}

TEST(Power, is_the_same_for_the_same_seed_and_reports_progress_to_the_end) {
    PowerQuestion question = small_question();
    question.participants = {8};
    question.studies = 40;
    std::int64_t last = 0, all = 0;
    const auto first = simulate_power(question, [&](std::int64_t done, std::int64_t of) {
        EXPECT_GT(done, last);
        last = done;
        all = of;
    });
    EXPECT_EQ(last, 40);
    EXPECT_EQ(all, 40);
    EXPECT_EQ(power_csv(first), power_csv(simulate_power(question)));
    question.seed = 2;
    EXPECT_NE(power_csv(first), power_csv(simulate_power(question)));
}

TEST(Power, writes_its_files_and_reads_its_assumptions) {
    const TemporaryFolder folder;
    PowerQuestion question = small_question();
    question.participants = {1, 6};
    question.studies = 20;
    for (const auto& file : write_power(simulate_power(question), question, folder.path() / "out"))
        EXPECT_GT(std::filesystem::file_size(file), 0u) << file;
    const auto path = folder.write(
        "psychometric.csv",
        "participant,alpha,sigmoid,threshold,width,lambda,gamma\nall,1,logistic,3.1,4.5,0.01,0.05\n"
        "P01,1,logistic,9,9,0,0\nall,1,normal,9,9,0,0\nall,4,logistic,5.2,4.0,0.03,0.07\n");
    const PowerAssumptions assumptions = read_power_assumptions(path);
    ASSERT_EQ(assumptions.functions.size(), 2u);
    EXPECT_EQ(assumptions.functions[1].alpha, 4.0);
    EXPECT_EQ(assumptions.functions[1].threshold, 5.2);
    EXPECT_NEAR(assumptions.guess_rate, 0.06, 1e-12);
    EXPECT_NE(message_of([&] {
                  read_power_assumptions(
                      folder.write("x.csv", "participant,alpha,sigmoid,threshold\nall,1,logistic,zwei\n"));
              }).find("x.csv:2"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] { read_power_assumptions(folder.path() / "none.csv"); }).find("cannot be opened"),
        std::string::npos);
}

TEST(Power, refuses_a_plan_without_conditions_or_with_an_alpha_nobody_assumed) {
    PowerQuestion question = small_question();
    question.plan.push_back({{1.4, 7.0}, 1});
    EXPECT_NE(message_of([&] { simulate_power(question); }).find("no assumed function for alpha 7"),
              std::string::npos);
    question.plan.clear();
    EXPECT_NE(message_of([&] { simulate_power(question); }).find("no condition"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
