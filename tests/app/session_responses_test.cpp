// From session files to the analysis: every frame and every lost sample is counted, copies are found,
// sessions read together give what each gives alone.
#include "app/session_responses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "study/session_log_reader.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

// Two testing sessions of 6 trials of two pictures, 20 frames each at 100 Hz.
constexpr int kPictureFrames = 2 * 6 * 2 * 20;

void record(const std::filesystem::path& path, const std::string& participant,
            std::set<std::int64_t> late = {}, const std::string& design = "") {
    std::string text = test::small_protocol_text();
    if (!design.empty()) text.replace(text.find("[design]\n"), 9, "[design]\n" + design + "\n");
    const Protocol protocol = parse_protocol(text, "small.toml");
    SessionFacts facts = test::facts();
    facts.uuid = "u-" + participant;
    facts.participant = participant;
    SessionLog log = SessionLog::create(path, facts, protocol, make_plan(protocol, 0, 3),
                                        {{}, 1'000'000'000'000}, nullptr);
    test::ProgramRun run;
    run.stage.late = std::move(late);
    ASSERT_EQ(run.go(log), SessionEnd::finished);
}

std::int64_t all(const FrameTimes& frames) {
    return std::accumulate(frames.counts.begin(), frames.counts.end(), std::int64_t{0});
}

TEST(SessionResponses, every_frame_of_every_picture_is_in_the_histogram_of_frame_times) {
    const TemporaryFolder folder;
    record(folder / "a.sqlite", "P1");
    const StudyData data = read_study({(folder / "a.sqlite").string()}, [](const Response&) {});
    ASSERT_TRUE(data.recordings.frames);
    const FrameTimes& frames = *data.recordings.frames;
    EXPECT_EQ(frames.refresh_hz, 100);
    ASSERT_EQ(frames.counts.size(), 101u) << "10 ms is the beginning of the bin from 10.0 to 10.1 ms";
    EXPECT_EQ(frames.counts[100], kPictureFrames);
    EXPECT_EQ(all(frames), kPictureFrames);
}

TEST(SessionResponses, a_missed_refresh_is_one_frame_of_two_refreshes) {
    const TemporaryFolder folder;
    record(folder / "a.sqlite", "P1");
    // Which frame of the whole session to delay: the 10th of some testing trial's first picture.
    const SessionRows rows = read_session(folder / "a.sqlite");
    const TrialRow& trial = rows.trials.at(4);
    ASSERT_GT(trial.planned.session, 0);
    std::int64_t late = -1;
    for (const FrameRecord& frame : read_frames(folder / "a.sqlite", trial.planned.number, trial.attempt))
        if (frame.phase == Phase::first_interval && late < 0) late = frame.shown.index + 10;
    record(folder / "b.sqlite", "P2", {late});
    const StudyData data = read_study({(folder / "b.sqlite").string()}, [](const Response&) {});
    const FrameTimes& frames = *data.recordings.frames;
    ASSERT_EQ(frames.counts.size(), 201u);
    EXPECT_EQ(frames.counts[200], 1);
    std::int64_t missed = 0;
    for (const SessionQuality& quality : data.recordings.sessions) missed += quality.missed;
    EXPECT_EQ(missed, 1);
}

TEST(SessionResponses, each_trial_carries_its_share_of_lost_gaze_and_each_session_its_gaze) {
    const TemporaryFolder folder;
    record(folder / "a.sqlite", "P1");
    std::vector<Response> responses;
    const StudyData data = read_study({(folder / "a.sqlite").string()},
                                      [&](const Response& response) { responses.push_back(response); });
    EXPECT_EQ(responses.size(), 12u);
    for (const Response& response : responses) {
        ASSERT_TRUE(response.gaze_loss);
        EXPECT_EQ(*response.gaze_loss, 0) << "the fake tracker never loses the eye";
    }
    ASSERT_EQ(data.recordings.sessions.size(), 2u);
    for (const SessionQuality& quality : data.recordings.sessions) {
        EXPECT_EQ(quality.participant, "P1");
        EXPECT_EQ(quality.frames, kPictureFrames / 2);
        EXPECT_NEAR(*quality.gaze_hz, 100, 1);
    }
    const GazeHeatMap& map = *data.recordings.gaze;
    // The eye looks at (0.5, 0.25) degrees: one cell, column 31, the row just above the middle.
    EXPECT_EQ(map.counts[29 * 60 + 31], std::accumulate(map.counts.begin(), map.counts.end(), 0.0));
}

TEST(SessionResponses, sessions_read_together_give_in_the_order_of_the_files_what_each_gives_alone) {
    const TemporaryFolder folder;
    constexpr int kSessions = 5;
    std::vector<std::string> files;
    for (int i = 0; i < kSessions; ++i) {
        files.push_back((folder / (std::to_string(i) + ".sqlite")).string());
        record(files.back(), "P" + std::to_string(i), {100 + 7 * i, 300 + 11 * i});
    }
    const auto line = [](const Response& response) {
        return response.participant + " " + std::to_string(response.session) + " " +
               std::to_string(response.trial) + " " + std::to_string(response.identical) + " " +
               std::to_string(response.dropped_frames.value_or(-1)) + " " +
               std::to_string(response.gaze_loss.value_or(-1));
    };
    std::vector<std::string> alone, together;
    std::vector<std::int64_t> frames;
    std::vector<double> gaze(60 * 60);
    std::vector<std::string> sessions;
    for (const std::string& file : files) {
        const StudyData data =
            read_study({file}, [&](const Response& response) { alone.push_back(line(response)); });
        frames.resize(std::max(frames.size(), data.recordings.frames->counts.size()));
        for (std::size_t i = 0; i < data.recordings.frames->counts.size(); ++i)
            frames[i] += data.recordings.frames->counts[i];
        for (std::size_t i = 0; i < gaze.size(); ++i) gaze[i] += data.recordings.gaze->counts[i];
        for (const SessionQuality& quality : data.recordings.sessions)
            sessions.push_back(quality.participant + " " + std::to_string(quality.missed));
    }
    const StudyData data =
        read_study(files, [&](const Response& response) { together.push_back(line(response)); });
    EXPECT_EQ(alone.size(), kSessions * 12u);
    EXPECT_EQ(together, alone);
    EXPECT_EQ(data.recordings.frames->counts, frames);
    EXPECT_EQ(data.recordings.frames->refresh_hz, 100);
    EXPECT_EQ(data.recordings.gaze->counts, gaze);
    std::vector<std::string> of_all;
    for (const SessionQuality& quality : data.recordings.sessions)
        of_all.push_back(quality.participant + " " + std::to_string(quality.missed));
    EXPECT_EQ(of_all, sessions);
}

TEST(SessionResponses, a_copy_is_found_and_the_planned_number_of_participants_is_handed_on) {
    const TemporaryFolder folder;
    record(folder / "a.sqlite", "P1", {}, "participants = 7");
    record(folder / "b.sqlite", "P2", {}, "participants = 7");
    std::filesystem::copy_file(folder / "a.sqlite", folder / "copy.sqlite");
    int responses = 0;
    const StudyData data = read_study(
        {(folder / "a.sqlite").string(), (folder / "b.sqlite").string(), (folder / "copy.sqlite").string()},
        [&](const Response&) { ++responses; });
    EXPECT_EQ(responses, 24);
    EXPECT_EQ(data.description.planned_participants, 7);
    ASSERT_EQ(data.problems.size(), 1u);
    EXPECT_NE(data.problems[0].find("copy.sqlite"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
