// The plan of a sweep, its shards, and the journal that survives being killed.
#include "app/tradeoff_journal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "app/tradeoff_views.h"
#include "renderer/scene_catalog.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

TradeoffPlan small_plan() {
    TradeoffPlan plan;
    plan.scenes = {"primitives", "a,b.glb"};
    plan.views = {{{64, 48}, 76.7}};
    plan.gazes = {"centre", "corner"};
    plan.motions = {"still", "path"};
    plan.methods = {{"KFR", {"kfr", {{"sigma", 1.8}, {"alpha", 4}}, {}}},
                    {"KFR", {"kfr", {{"sigma", 2.4}, {"alpha", 4}}, {{"kernel", "power"}}}}};
    return plan;
}

std::vector<TradeoffRow> all_rows(const TradeoffPlan& plan, const Shard& shard = {}) {
    std::vector<TradeoffRow> rows;
    for (const TradeoffGroup& group : groups_of(plan, shard))
        for (const TradeoffMethod& method : methods_of(plan)) rows.push_back(empty_row(plan, group, method));
    return rows;
}

std::filesystem::path write_shard(const TradeoffPlan& plan, const Shard& shard, const TemporaryFolder& folder,
                                  const std::string& name, std::size_t rows = 1000) {
    const std::filesystem::path path = folder.path() / name;
    TradeoffJournal journal(path, plan, shard, "a device");
    std::vector<TradeoffRow> all = all_rows(plan, shard);
    all.resize(std::min(all.size(), rows));
    for (const TradeoffRow& row : all) journal.append(row);
    return path;
}

TEST(TradeoffPlan, ReadsBackFromItsText) {
    const TradeoffPlan plan = small_plan();
    EXPECT_EQ(plan_text(plan_from_text(plan_text(plan), "here")), plan_text(plan));
    EXPECT_EQ(plan_from_text(plan_text(plan), "here").methods, plan.methods);
    EXPECT_NE(message_of([] { plan_from_text("{\"scenes\": 3}", "here"); }).find("here: "),
              std::string::npos);
}

TEST(TradeoffPlan, ShardsAreDisjointCompleteAndKeepGroupsWhole) {
    const TradeoffPlan plan = small_plan();
    for (const int count : {1, 2, 3, 5, 20}) {
        std::multiset<std::string> keys;
        std::size_t most = 0, least = 1000;
        for (int index = 1; index <= count; ++index) {
            const std::vector<TradeoffRow> rows = all_rows(plan, {index, count});
            for (const TradeoffRow& row : rows) keys.insert(key_of(row));
            EXPECT_EQ(rows.size() % methods_of(plan).size(), 0u);
            most = std::max(most, rows.size());
            least = std::min(least, rows.size());
        }
        std::multiset<std::string> expected;
        for (const TradeoffRow& row : all_rows(plan)) expected.insert(key_of(row));
        EXPECT_EQ(keys, expected) << count;
        EXPECT_LE(most - least, methods_of(plan).size()) << count;
    }
}

TEST(TradeoffPlan, EverySettingThatIsMeasuredByDefaultIsValid) {
    TradeoffPlan plan = small_plan();
    plan.methods = standard_tradeoff_methods();
    EXPECT_NO_THROW(check(plan));
}

TEST(TradeoffPlan, RefusesWhatMakesNoSenseInOneLine) {
    const auto message = [](auto&& change) {
        TradeoffPlan plan = small_plan();
        change(plan);
        return message_of([&] { check(plan); });
    };
    EXPECT_EQ(message([](TradeoffPlan& plan) { plan.gazes = {"middle"}; }),
              "tradeoff: no gaze 'middle'; there are: centre, quarter, corner, path");
    EXPECT_EQ(message([](TradeoffPlan& plan) {
                  plan.scenes = {"atrium", "atrium"};
              }),
              "tradeoff: the scene 'atrium' is listed twice");
    EXPECT_EQ(message([](TradeoffPlan& plan) { plan.frames = 1; }),
              "tradeoff: the number of frames is from 2 to 10000, found 1");
    EXPECT_EQ(message([](TradeoffPlan& plan) { plan.methods.push_back(plan.methods.front()); }),
              "tradeoff: 'KFR' (alpha=4 sigma=1.8) is listed twice");
    for (const char* text : {"0/3", "4/3", "1", "1/", "a/b", "1/2/3", "-1/2"})
        EXPECT_NE(message_of([&] { parse_shard(text); }).find(text), std::string::npos);
    EXPECT_EQ(parse_shard("2/8"), (Shard{2, 8}));
    EXPECT_NE(message_of([] { tradeoff_methods_of({"magic"}); }).find("no method 'magic'; there are: full, "),
              std::string::npos);
}

TEST(TradeoffJournal, GoesOnAfterBeingCutOffAnywhere) {
    const TradeoffPlan plan = small_plan();
    const TemporaryFolder folder;
    const std::vector<TradeoffRow> rows = all_rows(plan);
    const std::string whole = text_of(write_shard(plan, {}, folder, "whole") / kTradeoffJournalName);
    // A run that was killed leaves any beginning of the file.
    for (std::size_t length = 0; length <= whole.size(); length += length < 400 ? 41 : 701) {
        folder.write("cut/tradeoff.journal", whole.substr(0, length));
        TradeoffJournal journal(folder.path() / "cut", plan, {}, "a device");
        const std::size_t known = journal.rows().size();
        for (std::size_t i = known; i < rows.size(); ++i) journal.append(rows[i]);
        ASSERT_EQ(text_of(folder.path() / "cut" / kTradeoffJournalName), whole) << length;
    }
}

TEST(TradeoffJournal, RefusesAnotherPlanShardDeviceOrADamagedFile) {
    const TradeoffPlan plan = small_plan();
    const TemporaryFolder folder;
    const std::filesystem::path path = write_shard(plan, {1, 2}, folder, "one");
    const auto message = [&](const TradeoffPlan& other, const Shard& shard, const std::string& device) {
        const std::string text = message_of([&] { TradeoffJournal(path, other, shard, device); });
        EXPECT_EQ(text.find('\n'), std::string::npos);
        return text;
    };
    TradeoffPlan other = plan;
    other.scenes.pop_back();
    EXPECT_NE(message(other, {1, 2}, "a device").find("was begun with other scenes; choose another folder"),
              std::string::npos);
    other = plan;
    other.methods.pop_back();
    EXPECT_NE(message(other, {1, 2}, "a device").find("other methods or settings"), std::string::npos);
    EXPECT_NE(message(plan, {2, 2}, "a device").find("is of shard 1/2, not of 2/2"), std::string::npos);
    EXPECT_NE(message(plan, {1, 2}, "another").find("was begun on 'a device'"), std::string::npos);
    {
        const TradeoffJournal held(path, plan, {1, 2}, "a device");
        EXPECT_NE(message(plan, {1, 2}, "a device").find("another run is writing it"), std::string::npos);
    }

    std::string text = text_of(path / kTradeoffJournalName);
    folder.write("one/tradeoff.journal", text + all_rows(plan).front().scene + ",broken\n");
    EXPECT_NE(message(plan, {1, 2}, "a device").find("fields; expected"), std::string::npos);
    folder.write("one/tradeoff.journal", text + tradeoff_csv_line(all_rows(plan).front()));
    EXPECT_NE(message(plan, {1, 2}, "a device").find("the row is there twice"), std::string::npos);
    folder.write("one/tradeoff.journal", "notes of mine\n");
    EXPECT_NE(message(plan, {1, 2}, "a device").find("is no journal of a sweep"), std::string::npos);
}

TEST(TradeoffMerge, PutsShardsIntoTheOrderOfThePlan) {
    const TradeoffPlan plan = small_plan();
    const TemporaryFolder folder;
    std::vector<std::filesystem::path> folders;
    for (const int index : {3, 1, 2})
        folders.push_back(write_shard(plan, {index, 3}, folder, std::to_string(index)));
    const MergedTradeoff merged = merge_tradeoff(folders);
    EXPECT_EQ(merged.rows, all_rows(plan));
    EXPECT_EQ(merged.devices, std::vector<std::string>{"a device"});
}

TEST(TradeoffMerge, SaysWhatIsMissingGivenTwiceUnfinishedOrOfAnotherPlan) {
    const TradeoffPlan plan = small_plan();
    TradeoffPlan other = plan;
    other.rounds = 9;
    const TemporaryFolder folder;
    const auto one = write_shard(plan, {1, 2}, folder, "one"), two = write_shard(plan, {2, 2}, folder, "two"),
               unfinished = write_shard(plan, {2, 2}, folder, "unfinished", 2),
               of_three = write_shard(plan, {2, 3}, folder, "of_three"),
               foreign = write_shard(other, {2, 2}, folder, "foreign");
    const auto message = [](const std::vector<std::filesystem::path>& folders) {
        const std::string text = message_of([&] { merge_tradeoff(folders); });
        EXPECT_EQ(text.find('\n'), std::string::npos);
        return text;
    };
    EXPECT_NO_THROW(merge_tradeoff({one, two}));
    EXPECT_NE(message({one}).find("shard 2/2 is missing"), std::string::npos);
    EXPECT_NE(message({one, two, two}).find("is shard 2/2, and so is"), std::string::npos);
    EXPECT_NE(message({one, unfinished}).find("10 of 12 rows are not measured yet"), std::string::npos)
        << message({one, unfinished});
    EXPECT_NE(message({one, of_three}).find("is shard 2/3 where the others are one of 2"), std::string::npos);
    EXPECT_NE(message({one, foreign}).find("(another number of rounds or frames)"), std::string::npos);
    EXPECT_NE(message({folder.path() / "nowhere"}).find("cannot be read"), std::string::npos);
}

TEST(TradeoffViews, AGazePathHoldsASaccadeAndACameraPathMoves) {
    TradeoffPlan plan = small_plan();
    plan.frames = 12;
    const Scene scene = load_scene("primitives");
    const TradeoffGroup group{"primitives", plan.views.front(), "path", "path"};
    const std::vector<TradeoffFrame> frames = frames_of(plan, group, scene);
    ASSERT_EQ(frames.size(), 12u);
    double fastest = 0;
    for (std::size_t f = 1; f < frames.size(); ++f) {
        fastest = std::max(fastest, angle_between_deg(group.view.direction_from_point(frames[f - 1].gaze),
                                                      group.view.direction_from_point(frames[f].gaze)));
        EXPECT_NE(frames[f].view.world_from_eye, frames[f - 1].view.world_from_eye);
    }
    EXPECT_GT(fastest * plan.refresh_hz, 100);  // degrees a second: no fixation is that fast
    EXPECT_EQ(frames.front().gaze, frames.front().drawn_gaze);

    // Twice the same is the same; an old gaze trails behind the eye.
    plan.gaze_age_ms = 2000 / plan.refresh_hz;
    const std::vector<TradeoffFrame> late = frames_of(plan, group, scene);
    for (std::size_t f = 2; f < late.size(); ++f)
        EXPECT_NEAR(late[f].drawn_gaze.x, late[f - 2].gaze.x, 0.5) << f;
    const std::vector<TradeoffFrame> still =
        frames_of(plan, {"primitives", plan.views.front(), "quarter", "still"}, scene);
    ASSERT_EQ(still.size(), 1u);
    EXPECT_EQ(still.front().gaze, (PointPx{16, 12}));
}

TEST(TradeoffPlan, TakesASingleSettingByItsWords) {
    const TradeoffMethod rings = parse_tradeoff_method("rings mar_slope=7 mar_start=0.05");
    EXPECT_EQ(rings.family, "rings");
    EXPECT_EQ(rings.method, (RenderMethod{"rings", {{"mar_slope", 7}, {"mar_start", 0.05}}, {}}));
    // A setting of the standard list stays in its family.
    for (const TradeoffMethod& known : standard_tradeoff_methods())
        EXPECT_EQ(parse_tradeoff_method(known.method.name + " " + setting_text(known.method)).family,
                  known.family);
    EXPECT_NE(message_of([] { parse_tradeoff_method("rings mar_slpe=7"); }).find("\"mar_slpe\""),
              std::string::npos);
    EXPECT_NE(message_of([] { parse_tradeoff_method(""); }).find("unknown method \"\""), std::string::npos);
}

TEST(TradeoffViews, ARecordingWithoutASaccadeIsRefused) {
    const TemporaryFolder folder;
    std::string csv =
        "sequence,device_time_ns,host_time_ns,host_time_error_ns,arrival_time_ns,status,azimuth_deg,"
        "elevation_deg,left_azimuth_deg,left_elevation_deg,left_pupil_mm,right_azimuth_deg,"
        "right_elevation_deg,right_pupil_mm\n";
    const auto with_azimuth = [&](double late_deg) {
        std::string text = csv;
        for (int i = 0; i < 100; ++i) {
            const std::string time = std::to_string(i * 10'000'000LL);
            text += std::to_string(i) + "," + time + "," + time + ",0," + time + ",tracked," +
                    (i < 50 ? "0" : std::to_string(late_deg)) + ",0,,,,,,\n";
        }
        return text;
    };
    TradeoffPlan plan = small_plan();
    plan.frames = 6;
    const Scene scene = load_scene("primitives");
    const TradeoffGroup group{"primitives", plan.views.front(), "path", "still"};
    plan.gaze_recording = folder.write("still.csv", with_azimuth(1));
    EXPECT_NE(message_of([&] { frames_of(plan, group, scene); }).find("no saccade of 5 degrees"),
              std::string::npos);
    plan.gaze_recording = folder.write("jump.csv", with_azimuth(10));
    const std::vector<TradeoffFrame> frames = frames_of(plan, group, scene);
    EXPECT_EQ(frames.front().gaze.x, 32);
    EXPECT_NEAR(frames.back().gaze.x, group.view.point_from_direction({10, 0}).x, 1e-9);
}

}  // namespace
}  // namespace parafovea
