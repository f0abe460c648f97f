// Power by simulation: what must hold for any design.
#include <gtest/gtest.h>

#include "analysis/power_shards.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

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

// Three folders, each with its shard of the question.
std::vector<std::filesystem::path> write_shards(const PowerQuestion& question,
                                                const TemporaryFolder& folder) {
    std::vector<std::filesystem::path> folders;
    for (int index = 1; index <= 3; ++index) {
        folders.push_back(folder.path() / std::to_string(index));
        write_power_shard(question, {index, 3}, simulate_studies(question, {index, 3}), folders.back());
    }
    return folders;
}

PowerQuestion question_for_shards() {
    PowerQuestion question = small_question();
    question.participants = {6, 9};
    question.effects = {0, 1};
    question.studies = 10;  // not a multiple of the number of shards
    return question;
}

TEST(PowerShards, joined_are_the_unsharded_run_to_the_last_bit) {
    const PowerQuestion question = question_for_shards();
    const TemporaryFolder folder;
    const MergedPower merged = merge_power_shards(write_shards(question, folder));
    EXPECT_EQ(merged.studies, simulate_studies(question));
    EXPECT_EQ(power_csv(power_of_studies(merged.question, merged.studies)),
              power_csv(simulate_power(question)));
}

TEST(PowerShards, say_what_is_missing_given_twice_or_of_another_question) {
    const PowerQuestion question = question_for_shards();
    const TemporaryFolder folder;
    const auto folders = write_shards(question, folder);
    const auto message = [](const std::vector<std::filesystem::path>& given) {
        return message_of([&] { merge_power_shards(given); });
    };
    EXPECT_EQ(message({folders[0], folders[2]}), "power --merge: shard 2/3 is missing; name its folder, too");
    EXPECT_NE(message({folders[0], folders[1], folders[1]}).find("is shard 2, and so is"), std::string::npos);
    EXPECT_NE(message({folders[0], folder.path() / "nowhere"}).find("cannot be read"), std::string::npos);

    PowerQuestion other = question;
    other.seed = 2;
    write_power_shard(other, {2, 3}, simulate_studies(other, {2, 3}), folders[1]);
    EXPECT_NE(message(folders).find("answers another question"), std::string::npos);

    const std::string text = text_of(folders[0] / kPowerShardName);
    folder.write("1/power.shard", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
    EXPECT_NE(message({folders[0]}).find("Run that shard again"), std::string::npos);
    folder.write("1/power.shard", "something else\n");
    EXPECT_NE(message({folders[0]}).find("is no shard of a power simulation"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
