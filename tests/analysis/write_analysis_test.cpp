// The whole way from responses to files.
#include "analysis/write_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "analysis/random_draw.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

std::vector<std::vector<std::string>> csv_rows(const std::filesystem::path& path) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(text_of(path));
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream fields(line + ",");
        for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
    }
    return rows;
}

std::vector<Response> simulated_responses(int participants, int sessions) {
    std::mt19937_64 generator(21);
    std::vector<Response> responses;
    for (int p = 0; p < participants; ++p)
        for (int s = 1; s <= sessions; ++s)
            for (double sigma : {1.2, 1.8, 2.4})
                for (double alpha : {1.0, 4.0}) {
                    Response response;
                    response.participant = "P" + std::to_string(p);
                    response.session = s;
                    response.sigma = sigma;
                    response.alpha = alpha;
                    response.identical = draw_unit(generator) < 1.3 - 0.45 * sigma + 0.05 * alpha;
                    responses.push_back(response);
                }
    return responses;
}

TEST(WriteAnalysis, gives_the_papers_table_1_from_the_data_constructed_for_it) {
    const std::filesystem::path csv =
        std::filesystem::path(PARAFOVEA_SHARED_DIR) / "data/table1_consistent_responses.csv";
    if (!std::filesystem::exists(csv)) GTEST_SKIP() << "no " << csv;
    const TemporaryFolder folder;
    StudyDescription study;
    study.data_origin = "synthetic";
    const AnalysisFiles files = write_analysis(read_responses_csv(csv), study, folder.path());
    const auto rows = csv_rows(files.table);
    const std::vector<std::string> head{"sigma", "sigma2", "blocks",  "informative_blocks", "q",
                                        "df",    "p_chi2", "p_exact", "p_permutation"};
    ASSERT_EQ(rows.size(), 8u);
    ASSERT_GE(rows[0].size(), head.size());
    EXPECT_TRUE(std::equal(head.begin(), head.end(), rows[0].begin()));
    const double q[] = {1.72, 5.79, 8.20, 8.25, 7.49, 14.27, 5.48};
    const double p[] = {.631, .122, .042, .041, .058, .002, .139};
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(std::round(std::stod(rows[i + 1][4]) * 100.0), std::round(q[i] * 100.0));
        EXPECT_NEAR(std::round(std::stod(rows[i + 1][6]) * 1000.0), p[i] * 1000.0, 1.0 + 1e-9)
            << "the paper's third digit is rounded in some places and cut off in others";
        EXPECT_EQ(rows[i + 1][2], "36");
        EXPECT_EQ(rows[i + 1][5], "3");
    }
    const auto figure = csv_rows(folder.path() / "figure10.csv");
    ASSERT_EQ(figure.size(), 29u);
    EXPECT_EQ(figure[0][0] + figure[0][5] + figure[0][9], "sigmap_identicalwilson_high");
    EXPECT_NE(text_of(folder.path() / "table1.md")
                  .find("Blocks are participants x sessions (18 participants, 36 blocks)"),
              std::string::npos);
}

TEST(WriteAnalysis, writes_every_promised_file_with_its_own_signature) {
    const TemporaryFolder folder;
    const auto out = folder.path() / "new" / "folder";
    const AnalysisFiles files = write_analysis(simulated_responses(6, 2), {}, out);
    EXPECT_TRUE(text_of(out / "figure10.svg").find("<svg") != std::string::npos);
    EXPECT_TRUE(text_of(out / "figure10.png").starts_with("\x89PNG"));
    EXPECT_TRUE(text_of(out / "figure10.pdf").starts_with("%PDF"));
    EXPECT_TRUE(text_of(out / "table1.md").starts_with("# Table 1"));
    EXPECT_EQ(files.report, out / "report.html");
    EXPECT_EQ(files.figure, out / "figure10.svg");
    for (const auto& file : files.written) EXPECT_GT(std::filesystem::file_size(file), 0u) << file;
    std::size_t on_disk = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(out)) ++on_disk;
    EXPECT_EQ(on_disk, files.written.size()) << "nothing is left behind that is not listed";
}

TEST(WriteAnalysis, of_a_pilot_gives_figure_9) {
    const TemporaryFolder folder;
    StudyDescription study;
    study.is_pilot = true;
    write_analysis(simulated_responses(4, 3), study, folder.path());
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "figure9.svg"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "figure10.svg"));
    EXPECT_NE(text_of(folder.path() / "report.html").find("Figure 9."), std::string::npos);
}

TEST(WriteAnalysis, says_that_simulated_people_are_simulated_wherever_results_are_shown) {
    const TemporaryFolder folder;
    StudyDescription study;
    study.data_origin = "simulated participants";
    const auto responses = simulated_responses(5, 2);
    write_analysis(responses, study, folder.path());
    for (const char* name : {"figure10.svg", "report.html", "table1.md"})
        EXPECT_NE(text_of(folder.path() / name).find("simulated participants"), std::string::npos) << name;
    EXPECT_NE(table1_text(responses, study).find("simulated participants"), std::string::npos);
}

TEST(WriteAnalysis, makes_a_report_that_needs_no_network_and_runs_no_script) {
    const TemporaryFolder folder;
    StudyDescription study;
    study.title = "A <b>study</b> & \"more\" of_it";
    write_analysis(simulated_responses(5, 2), study, folder.path());
    const std::string html = text_of(folder.path() / "report.html");
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<b>study"), std::string::npos) << "text from outside is escaped";
    EXPECT_NE(html.find("A &lt;b&gt;study"), std::string::npos);
    for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import", "<link rel=\"stylesheet"})
        EXPECT_EQ(html.find(outside), std::string::npos) << outside;
    EXPECT_NE(html.find("role=\"img\" aria-label=\"Share of trials"), std::string::npos);
    EXPECT_NE(html.find("lang=\"en\""), std::string::npos);
    // Every reference inside the page meets its target, and no name is given twice.
    std::multiset<std::string> ids;
    const std::regex id("[ \\n]id=['\"]([^'\"]*)['\"]"), reference("href=['\"]#([^'\"]*)['\"]");
    for (std::sregex_iterator at(html.begin(), html.end(), id), end; at != end; ++at) ids.insert((*at)[1]);
    for (std::sregex_iterator at(html.begin(), html.end(), reference), end; at != end; ++at)
        EXPECT_EQ(ids.count((*at)[1]), 1u) << (*at)[1];
    EXPECT_GT(ids.size(), 20u);
    for (const char* bad : {">nan", " nan", ">-nan", ">inf<", " inf "})
        EXPECT_EQ(html.find(bad), std::string::npos) << bad;
}

TEST(WriteAnalysis, is_the_same_for_the_same_input) {
    const TemporaryFolder folder;
    const auto responses = simulated_responses(5, 2);
    write_analysis(responses, {}, folder.path() / "a");
    write_analysis(responses, {}, folder.path() / "b");
    for (const char* name : {"figure10.csv", "figure10.svg", "table1.csv", "table1.md", "report.html"})
        EXPECT_EQ(text_of(folder.path() / "a" / name), text_of(folder.path() / "b" / name)) << name;
}

TEST(WriteAnalysis, answers_for_one_participant_one_condition_and_all_identical) {
    const TemporaryFolder folder;
    Response response;
    response.participant = "only";
    response.sigma = 1.8;
    response.alpha = 4.0;
    response.identical = true;
    write_analysis(std::vector<Response>{response}, {}, folder.path() / "one");
    EXPECT_NE(text_of(folder.path() / "one/figure10.csv").find("1.8,3.24,4,1,1,1,0,,"), std::string::npos)
        << text_of(folder.path() / "one/figure10.csv");

    std::vector<Response> all;
    for (int p = 0; p < 5; ++p)
        for (double alpha : {1.0, 2.0}) {
            response.participant = "P" + std::to_string(p);
            response.alpha = alpha;
            all.push_back(response);
        }
    write_analysis(all, {}, folder.path() / "all");
    const auto rows = csv_rows(folder.path() / "all/table1.csv");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1][4], "") << "Q is undefined";
    EXPECT_EQ(rows[1][7], "1") << "the exact p is 1";
    EXPECT_NE(text_of(folder.path() / "all/table1.md").find("n/a"), std::string::npos);
}

TEST(WriteAnalysis, prints_no_nan_and_no_infinity_whatever_the_answers) {
    const TemporaryFolder folder;
    std::vector<Response> responses;
    Response response;
    for (int p = 0; p < 3; ++p) {
        response.participant = "P" + std::to_string(p);
        for (int alpha = 1; alpha <= 20; ++alpha)
            for (double sigma : {1.0, 2.0, 3.0}) {  // always identical, always different, mixed; 20 columns
                response.sigma = sigma;
                response.alpha = alpha;
                response.identical = sigma < 2.0 || (sigma > 2.0 && (alpha + p) % 3 == 0);
                responses.push_back(response);
            }
    }
    response.sigma = 4.0;  // one answer of one participant
    responses.push_back(response);
    response.validation = true;  // one validation trial, of one participant
    responses.push_back(response);
    const AnalysisFiles files = write_analysis(responses, {}, folder.path());
    const std::regex bad("(^|[^a-zA-Z])-?(nan|inf|infinity)($|[^a-zA-Z])", std::regex::icase);
    for (const auto& file : files.written) {
        if (file.extension() != ".csv" && file.extension() != ".md") continue;
        EXPECT_FALSE(std::regex_search(text_of(file), bad)) << file;
    }
    const std::string html = text_of(files.report);
    for (const char* word : {">nan", " nan", ">-nan", ">inf<", " inf ", " -inf"})
        EXPECT_EQ(html.find(word), std::string::npos) << word;
    EXPECT_EQ(csv_rows(folder.path() / "sensitivity_participants.csv").size(), 2u)
        << "a head, and the one participant with a validation trial";
}

TEST(WriteAnalysis, refuses_no_responses_and_an_unwritable_folder_in_one_line) {
    const TemporaryFolder folder;
    EXPECT_NE(message_of([&] { write_analysis({}, {}, folder.path()); }).find("no response to analyse"),
              std::string::npos);
    const auto file = folder.write("file", "in the way");
    const std::string message = message_of([&] { write_analysis(simulated_responses(3, 1), {}, file); });
    EXPECT_NE(message.find(file.string()), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace parafovea
