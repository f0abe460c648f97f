// The reader of response tables: what it takes, and the line it blames for what it does not.
#include "analysis/responses.h"

#include <gtest/gtest.h>

#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

TEST(ResponsesCsv, are_read_with_optional_columns_in_any_order) {
    const TemporaryFolder folder;
    const auto path = folder.write(
        "r.csv",
        "\xEF\xBB\xBF"
        "note,identical,alpha,sigma,session,participant,response_time_s,foveated_first,validation\r\n"
        "\"a, \"\"b\"\"\",1,4,1.8,2,P01,0.75,0,0\r\n"
        "\r\n"
        ",false,,,1, P02 ,,,true\r\n");
    const std::vector<Response> rows = read_responses_csv(path);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].participant, "P01");
    EXPECT_EQ(rows[0].session, 2);
    EXPECT_EQ(rows[0].sigma, 1.8);
    EXPECT_EQ(rows[0].alpha, 4.0);
    EXPECT_TRUE(rows[0].identical);
    EXPECT_EQ(rows[0].response_time_s, 0.75);
    EXPECT_EQ(rows[0].foveated_first, false);
    EXPECT_EQ(rows[1].participant, "P02");
    EXPECT_TRUE(rows[1].validation);
    EXPECT_FALSE(rows[1].identical);
    EXPECT_FALSE(rows[1].response_time_s);
}

TEST(ResponsesCsv, blame_the_line_that_cannot_be_read) {
    const TemporaryFolder folder;
    const std::string head = "participant,session,sigma,alpha,identical\nP1,1,1.2,1,0\n";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"P1,1,1.2,1,maybe\n", ":3: 'identical' is 'maybe'; expected 0 or 1"},
        {"P1,1,abc,1,0\n", ":3: 'sigma' is 'abc'"},
        {"\nP1,1,nan,1,0\n", ":4: 'sigma' is 'nan'"},
        {"P1,1,-1,1,0\n", ":3: 'sigma' is '-1'"},
        {"P1,1,1.2,0,0\n", ":3: 'alpha' is '0'"},
        {"P1,1.5,1.2,1,0\n", ":3: 'session' is '1.5'"},
        {"P1,1,1.2,1\n", ":3: 4 fields; expected 5"},
        {",1,1.2,1,0\n", ":3: 'participant' is empty"},
        {"\"P1,1,1.2,1,0\n", ":3: a quoted field does not end"}};
    for (const auto& [row, expected] : cases) {
        const auto path = folder.write("bad.csv", head + row);
        const std::string message = message_of([&] { read_responses_csv(path); });
        EXPECT_NE(message.find("bad.csv" + expected), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(ResponsesCsv, need_a_header_a_file_and_something_in_it) {
    const TemporaryFolder folder;
    EXPECT_NE(message_of([&] {
                  read_responses_csv(folder.write("a.csv", "participant,sigma,alpha,identical\n"));
              }).find(":1: no column 'session'"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] {
            read_responses_csv(folder.write("b.csv", "participant,session,sigma,sigma,alpha,identical\n"));
        }).find("appears twice"),
        std::string::npos);
    EXPECT_NE(message_of([&] { read_responses_csv(folder.write("c.csv", "")); }).find("is empty"),
              std::string::npos);
    EXPECT_NE(message_of([&] { read_responses_csv(folder.path() / "none.csv"); }).find("cannot be opened"),
              std::string::npos);
    EXPECT_NE(message_of([&] { read_responses_csv(folder.path()); }).find("cannot be opened"),
              std::string::npos);
}

}  // namespace
}  // namespace parafovea
