// The trial state machine, on a simulated clock.
#include "study/trial_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/study/fakes.h"

namespace parafovea {
namespace {

using test::FakeGaze;
using test::FakeParticipant;
using test::FakeStage;
using testing::ElementsAre;
using testing::IsEmpty;

struct Lab {
    explicit Lab(double refresh_hz = 100) : stage(clock, refresh_hz), gaze(clock), participant(clock, stage) {
        planned.scene = "one";
        planned.condition = 0;
        planned.second = protocol.conditions[0];
    }
    TrialRecord run(const TrialControl& control = {}) {
        return run_trial(planned, protocol, stage, gaze, participant, clock, control);
    }

    SimulatedClock clock;
    Protocol protocol = test::small_protocol();
    FakeStage stage;
    FakeGaze gaze;
    FakeParticipant participant;
    PlannedTrial planned;
};

const IntervalRecord& interval(const TrialRecord& record, Phase phase) {
    return record.intervals[static_cast<std::size_t>(phase)];
}

TEST(Frames, durations_are_the_nearest_whole_frames_with_halves_up) {
    EXPECT_EQ(frames_from_seconds(0.75, 90), 68);  // 67.5
    EXPECT_EQ(frames_from_seconds(2.5, 90), 225);
    EXPECT_EQ(frames_from_seconds(0.75, 72), 54);
    EXPECT_EQ(frames_from_seconds(0.75, 70), 53);  // 52.5
    EXPECT_EQ(frames_from_seconds(2.5, 70), 175);
    EXPECT_EQ(frames_from_seconds(2.5, 59.94), 150);  // 149.85
    EXPECT_EQ(frames_from_seconds(0.7, 90), 63);      // 62.99999999999999 in doubles
    EXPECT_EQ(frames_from_seconds(0, 90), 0);
    for (const double hz : {59.94, 70.0, 72.0, 89.53, 90.0, 120.0, 144.0})
        for (int frames = 0; frames < 1000; ++frames) EXPECT_EQ(frames_from_seconds(frames / hz, hz), frames);
}

TEST(TrialRunner, shows_lead_in_interval_gap_interval_question_in_whole_frames) {
    Lab lab;
    const TrialRecord record = lab.run();
    // 0.05, 0.2, 0.1 and 0.2 s at 100 Hz.
    std::vector<PictureKind> kinds;
    std::vector<int> lengths;
    for (const Picture& picture : lab.stage.pictures) {
        if (kinds.empty() || kinds.back() != picture.kind)
            kinds.push_back(picture.kind), lengths.push_back(0);
        ++lengths.back();
    }
    lengths.pop_back();
    EXPECT_THAT(kinds, ElementsAre(PictureKind::fixation, PictureKind::stimulus, PictureKind::black,
                                   PictureKind::stimulus, PictureKind::question));
    EXPECT_THAT(lengths, ElementsAre(5, 20, 10, 20));
    EXPECT_EQ(to_text(lab.stage.pictures[5].method), "full");
    EXPECT_EQ(lab.stage.pictures[35].method, lab.protocol.conditions[0]);
    EXPECT_EQ(lab.stage.pictures[5].scene, "one");
    EXPECT_EQ(lab.stage.pictures.back().text, "Same?");
}

class AtEveryRate : public testing::TestWithParam<double> {};

TEST_P(AtEveryRate, intervals_last_their_intended_frames_exactly) {
    Lab lab(GetParam());
    lab.protocol.timing.interval_s = 2.5;
    lab.protocol.timing.gap_s = 0.75;
    const TrialRecord record = lab.run();
    const double period_s = 1 / GetParam();
    for (const Phase phase : {Phase::first_interval, Phase::gap, Phase::second_interval}) {
        const IntervalRecord& shown = interval(record, phase);
        const double intended_s = phase == Phase::gap ? 0.75 : 2.5;
        EXPECT_EQ(shown.intended_frames, frames_from_seconds(intended_s, GetParam()));
        EXPECT_EQ(shown.presented_frames, shown.intended_frames);
        EXPECT_NEAR((shown.end - shown.first_display).seconds(), shown.intended_frames * period_s, 1e-8);
        EXPECT_LE(std::abs((shown.end - shown.first_display).seconds() - intended_s), period_s / 2 + 1e-8);
        EXPECT_EQ(shown.missed_vsyncs, 0);
        EXPECT_NEAR(shown.longest_frame.seconds(), period_s, 1e-8);
        EXPECT_EQ(shown.time_source, TimeSource::simulated);
    }
    EXPECT_EQ(interval(record, Phase::second_interval).first_display, interval(record, Phase::gap).end);
}

INSTANTIATE_TEST_SUITE_P(TrialRunner, AtEveryRate, testing::Values(59.94, 60, 70, 72, 90, 120, 144));

TEST(TrialRunner, a_missed_refresh_is_counted_for_the_frame_that_stayed_on_and_costs_a_frame_but_no_time) {
    Lab lab;
    // Frames 5..23 are the first interval. 10 is late: 9 stayed on, and the interval has a frame less. 24,
    // the first of the gap, is late: 23 stayed on, and it is too late to make up for it.
    lab.stage.late = {10, 24};
    const TrialRecord record = lab.run();
    const IntervalRecord& first = interval(record, Phase::first_interval);
    EXPECT_EQ(interval(record, Phase::lead_in).missed_vsyncs, 0);
    EXPECT_EQ(first.intended_frames, 20);
    EXPECT_EQ(first.missed_vsyncs, 2);
    EXPECT_EQ(first.presented_frames, 19);
    EXPECT_EQ(first.longest_frame.ms(), 20);
    EXPECT_EQ((first.end - first.first_display).ms(), 210);
    EXPECT_EQ(interval(record, Phase::gap).missed_vsyncs, 0);
    EXPECT_EQ(interval(record, Phase::gap).presented_frames, 10);
    EXPECT_EQ(interval(record, Phase::gap).longest_frame.ms(), 10);
}

TEST(TrialRunner, the_answer_is_the_first_key_after_the_question_with_its_reaction_time) {
    Lab lab;
    const TrialRecord record = lab.run();
    ASSERT_TRUE(record.answer);
    EXPECT_FALSE(record.answer->identical);
    EXPECT_EQ(record.answer->button, Button::b);
    EXPECT_EQ(record.answer->reaction, record.answer->time - interval(record, Phase::question).first_display);
    EXPECT_GE(record.answer->reaction.ns, 0);
    EXPECT_THAT(record.invalid, IsEmpty());

    lab.planned.second = lab.planned.first;
    EXPECT_TRUE(lab.run().answer->identical);
}

TEST(TrialRunner, presses_before_the_question_and_of_other_keys_are_events_but_no_answers) {
    Lab lab;
    lab.protocol.timing.response_window_s = 0.5;
    lab.participant.answers = false;
    const auto before_show = lab.stage.before_show;
    int frame = 0;
    lab.stage.before_show = [&](const Picture& picture) {
        before_show(picture);
        if (frame == 0 || frame == 30 || frame == 54)
            lab.participant.press(Button::b);               // lead-in, gap, second interval's last
        if (frame == 70) lab.participant.press(Button::x);  // during the question
        ++frame;
    };
    const TrialRecord record = lab.run();
    EXPECT_FALSE(record.answer);
    EXPECT_EQ(record.events.size(), 8u);
    EXPECT_THAT(record.invalid, ElementsAre("unanswered"));
    EXPECT_EQ(interval(record, Phase::question).presented_frames, 50);
}

TEST(TrialRunner, the_keys_are_the_protocols) {
    Lab lab;
    lab.protocol.keys = {Button::left_shoulder, Button::right_shoulder, Button::menu};
    FakeParticipant participant(lab.clock, lab.stage, lab.protocol.keys);
    const TrialRecord record =
        run_trial(lab.planned, lab.protocol, lab.stage, lab.gaze, participant, lab.clock);
    ASSERT_TRUE(record.answer);
    EXPECT_EQ(record.answer->button, Button::right_shoulder);
    EXPECT_FALSE(record.answer->identical);
}

TEST(TrialRunner, without_a_window_the_question_waits) {
    Lab lab;
    lab.participant.answers = false;
    const auto before_show = lab.stage.before_show;
    int questions = 0;
    lab.stage.before_show = [&](const Picture& picture) {
        before_show(picture);
        if (picture.kind == PictureKind::question && ++questions == 12345) lab.participant.press(Button::a);
    };
    const TrialRecord record = lab.run();
    ASSERT_TRUE(record.answer);
    EXPECT_TRUE(record.answer->identical);
    EXPECT_NEAR(record.answer->reaction.seconds(), 123.43, 0.02);
}

TEST(TrialRunner, foveation_at_the_centre_ignores_the_gaze) {
    Lab lab;
    lab.gaze.look(0, 10, DirectionDeg{12, -7});
    for (const FrameRecord& frame : lab.run().frames) {
        EXPECT_EQ(frame.fovea, (PointPx{640, 720}));
        EXPECT_FALSE(frame.fallback);
        EXPECT_FALSE(frame.gaze_sequence);
    }
}

TEST(TrialRunner, tracked_foveation_follows_the_latest_sample_that_has_arrived) {
    Lab lab;
    lab.protocol.foveation_gaze = GazePolicy::tracked;
    for (int i = 0; i < 100; ++i) lab.gaze.look(i * 0.01, i * 0.01 + 0.01, DirectionDeg{i * 0.1, -i * 0.05});
    const TrialRecord record = lab.run();
    int stimuli = 0;
    for (std::size_t i = 0; i < record.frames.size(); ++i) {
        const FrameRecord& frame = record.frames[i];
        if (frame.phase != Phase::first_interval && frame.phase != Phase::second_interval) continue;
        ++stimuli;
        // Frame i is prepared at i * 10 ms, when the sample seen at (i - 1) * 10 ms has just arrived, and
        // displayed at (i + 1) * 10 ms.
        ASSERT_TRUE(frame.gaze_sequence);
        EXPECT_EQ(*frame.gaze_sequence, static_cast<std::int64_t>(i) - 1);
        EXPECT_EQ(frame.gaze_age->ms(), 20);
        EXPECT_FALSE(frame.fallback);
        const double index = static_cast<double>(*frame.gaze_sequence);
        EXPECT_EQ(frame.fovea, lab.stage.view().point_from_direction({index * 0.1, -index * 0.05}));
        EXPECT_EQ(lab.stage.pictures[i].fovea, frame.fovea);
    }
    EXPECT_EQ(stimuli, 40);
}

TEST(TrialRunner, in_a_blink_the_last_gaze_stays_and_the_frames_are_flagged) {
    Lab lab;
    lab.protocol.foveation_gaze = GazePolicy::tracked;
    lab.gaze.look(0, 0.1, DirectionDeg{5, 3});
    lab.gaze.look(0.1, 0.15, std::nullopt);
    lab.gaze.look(0.15, 2, DirectionDeg{-5, 3});
    const PointPx before = lab.stage.view().point_from_direction({5, 3}),
                  after = lab.stage.view().point_from_direction({-5, 3});
    for (const FrameRecord& frame : lab.run().frames) {
        if (frame.phase != Phase::first_interval) continue;
        const std::int64_t i = frame.shown.index;
        EXPECT_EQ(frame.fovea, i < 16 ? before : after) << i;
        EXPECT_EQ(frame.fallback, i >= 11 && i < 16) << i;
    }
}

TEST(TrialRunner, without_any_gaze_tracked_foveation_falls_back_to_the_centre) {
    Lab lab;
    lab.protocol.foveation_gaze = GazePolicy::tracked;
    for (const FrameRecord& frame : lab.run().frames) {
        EXPECT_EQ(frame.fovea, (PointPx{640, 720}));
        EXPECT_EQ(frame.fallback,
                  frame.phase == Phase::first_interval || frame.phase == Phase::second_interval);
    }
}

TEST(TrialRunner, gaze_that_has_gone_stale_is_flagged) {
    Lab lab;
    lab.protocol.foveation_gaze = GazePolicy::tracked;
    lab.protocol.gaze_stale_after_ms = 100;
    lab.gaze.look(0, 0.11, DirectionDeg{1, 1});  // the last sample is seen at 100 ms
    for (const FrameRecord& frame : lab.run().frames) {
        if (frame.phase != Phase::first_interval && frame.phase != Phase::second_interval) continue;
        EXPECT_EQ(frame.fallback, frame.shown.display_time.ns > 200'000'000) << frame.shown.index;
        EXPECT_EQ(frame.fovea, lab.stage.view().point_from_direction({1, 1}));
    }
}

TEST(TrialRunner, every_gaze_sample_is_kept) {
    Lab lab;
    lab.gaze.look(0, 0.4, DirectionDeg{});
    lab.gaze.look(0.4, 0.5, std::nullopt);
    lab.gaze.look(0.5, 5, DirectionDeg{});
    const TrialRecord first = lab.run(), second = lab.run();
    std::int64_t expected = 0;
    for (const TrialRecord* record : {&first, &second})
        for (const GazeSample& sample : record->gaze) EXPECT_EQ(sample.sequence, expected++);
    EXPECT_GT(expected, 100);
}

TEST(TrialRunner, a_stop_ends_the_trial_as_interrupted_without_an_answer) {
    Lab lab;
    std::stop_source source;
    const auto before_show = lab.stage.before_show;
    lab.stage.before_show = [&](const Picture& picture) {
        before_show(picture);
        if (lab.stage.pictures.size() == 12) source.request_stop();
    };
    const TrialRecord record = lab.run({source.get_token(), nullptr});
    EXPECT_TRUE(record.interrupted);
    EXPECT_FALSE(record.answer);
    EXPECT_EQ(record.frames.size(), 13u);
}

TEST(TrialRunner, the_lead_in_goes_on_until_the_stimulus_may_come) {
    Lab lab;
    int asked = 0;
    const TrialRecord record = lab.run({{}, [&] { return ++asked > 7; }});
    EXPECT_EQ(interval(record, Phase::lead_in).intended_frames, 5);
    EXPECT_EQ(interval(record, Phase::lead_in).presented_frames, 12);
    EXPECT_EQ(interval(record, Phase::first_interval).presented_frames, 20);
}

TEST(TrialRunner, the_fovea_and_hash_of_every_stimulus_frame_are_kept) {
    Lab lab;
    for (const FrameRecord& frame : lab.run().frames)
        EXPECT_EQ(frame.shown.image_hash.has_value(),
                  frame.phase == Phase::first_interval || frame.phase == Phase::second_interval);
}

}  // namespace
}  // namespace parafovea
