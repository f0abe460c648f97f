// Whole sessions on the simulated headset, stereo, with gaze from a recording, under both validation layers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "app/openxr_stage.h"
#include "app/picture_pair_judge.h"
#include "app/simulated_person.h"
#include "devices/gaze_recording.h"
#include "devices/openxr/openxr_gaze.h"
#include "study/session_log_reader.h"
#include "study/session_runner.h"
#include "tests/app/child_process.h"
#include "tests/app/short_study.h"
#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

constexpr const char* kView = "width_px = 80\nheight_px = 90\nhorizontal_fov_deg = 100";

// Six trials.
const ShortStudy kStudy{.view = kView,
                        .gaze = "tracked",
                        .interval_s = 0.6,
                        .gap_s = 0.1,
                        .sigmas = "1.2, 1.8, 2.4",
                        .training_trials = 0,
                        .sessions = 1,
                        .validation_share = 0,
                        .tables = "[validity]\ngaze_lost_share = 0.3\nmissed_frames = 2\n"};

// Eyes that wander slowly; the same in every round.
void write_recording(const std::filesystem::path& path) {
    std::vector<GazeSample> samples;
    for (int i = 0; i < 600; ++i) {
        GazeSample sample;
        sample.sequence = i;
        sample.host_time = sample.arrival_time = {i * std::int64_t{8'333'333}};
        sample.status = GazeStatus::tracked;
        sample.direction = DirectionDeg{4 * std::sin(i * 0.02), 3 * std::cos(i * 0.013)};
        samples.push_back(sample);
    }
    std::ofstream file(path);
    write_gaze_csv(file, samples);
}

// Calls a function before the first stimulus frame of each showing of a trial.
class StageWithCue final : public Stage {
  public:
    StageWithCue(Stage& stage, std::function<void()> cue) : stage_(stage), cue_(std::move(cue)) {}

    ShownFrame show(const Picture& picture) override {
        if (picture.kind == PictureKind::stimulus && armed) {
            armed = false;
            cue_();
        }
        return stage_.show(picture);
    }
    double refresh_hz() const override { return stage_.refresh_hz(); }
    ViewGeometry view() const override { return stage_.view(); }

    bool armed = false;

  private:
    Stage& stage_;
    std::function<void()> cue_;
};

class HeadsetSession : public testing::Test {
  protected:
    void SetUp() override { write_recording(folder_ / "gaze.csv"); }

    // Runs to the end, or as far as the headset lets it. `faults` happen one a showing, in order.
    SessionEnd run(bool resume, std::vector<std::string> faults = {}) {
        const ValidationLayers layers;
        layers.use("pacing=simulated;shrink=16;gaze=" + (folder_ / "gaze.csv").string());
        SimulatedClock clock;
        SessionEnd end = SessionEnd::stopped;
        {
            const Protocol protocol = parse_protocol(short_study_toml(kStudy), "short.toml");
            PicturePairJudge judge(display_model(protocol.display.view, 100));
            SimulatedPerson person(protocol, clock, judge, {.seed = 3});
            OpenXrStageOptions options;
            options.audience = &person;
            options.hash_pictures = true;
            options.validation = true;
            OpenXrStage stage(clock, options);
            OpenXrGaze gaze(stage.session(), OpenXrGaze::Looks::at_drain);
            SessionLog log = resume ? SessionLog::open_to_resume(file(), {clock.now(), 1})
                                    : SessionLog::create(file(), facts(stage, gaze, person), protocol,
                                                         make_plan(protocol, 0, 3), {clock.now(), 0});
            std::size_t next_fault = 0;
            StageWithCue cued(stage, [&] {
                if (next_fault < faults.size()) layers.happen(faults[next_fault++]);
            });
            SessionHooks hooks;
            hooks.on_progress = [&](const SessionProgress& progress) {
                if (!progress.next || progress.state != "trial") return;
                const auto shown =
                    std::ranges::count(log.shown(), progress.next->number, &ShownTrial::number);
                person.begin_trial(progress.next->number, static_cast<int>(shown));
                cued.armed = true;
            };
            try {
                end = run_session(log, cued, gaze, person.hand(), clock, hooks);
            } catch (const std::runtime_error& error) {
                failure_ = error.what();
            }
            EXPECT_THAT(stage.gpu().validation_messages(), testing::IsEmpty());
        }
        layers.expect_silence();
        frames_log_ = text_of(layers.frames());
        return end;
    }

    std::filesystem::path file() const { return folder_ / "session.sqlite"; }

    static SessionFacts facts(const OpenXrStage& stage, const OpenXrGaze& gaze, SimulatedPerson& person) {
        SessionFacts facts;
        facts.uuid = make_uuid();
        facts.participant = "P01";
        facts.program_version = "test";
        facts.display = stage.instance().headset_name();
        facts.gaze_source = gaze.description();
        facts.controller = person.hand().description();
        facts.device = stage.gpu().device_name();
        facts.driver = stage.gpu().driver_name();
        facts.refresh_hz = stage.refresh_hz();
        facts.view = stage.view();
        facts.simulated_people = true;
        return facts;
    }

    TemporaryFolder folder_;
    std::string failure_, frames_log_;
};

// Every planned trial has exactly one showing that counts.
void expect_all_trials_count(const SessionRows& rows) {
    std::map<int, int> counting;
    for (const TrialRow& row : rows.trials) counting[row.planned.number] += row.counts();
    EXPECT_EQ(counting.size(), rows.plan.trials.size());
    for (const auto& [number, count] : counting) EXPECT_EQ(count, 1) << "trial " << number;
}

TEST_F(HeadsetSession, RunsToItsEndInStereoWithGazeFromARecording) {
    EXPECT_EQ(run(false), SessionEnd::finished);
    EXPECT_EQ(failure_, "");
    const SessionRows rows = read_session(file());
    EXPECT_TRUE(rows.finished);
    EXPECT_EQ(rows.trials.size(), 6u);
    expect_all_trials_count(rows);
    EXPECT_EQ(rows.facts.display, "Simulated FOVE-like headset");
    EXPECT_EQ(rows.facts.gaze_source,
              "OpenXR eye tracker of Simulated FOVE-like headset, Parafovea simulated headset 1.0.0");

    std::set<std::int64_t> sequences;
    for (const TrialRow& row : rows.trials) {
        const std::vector<FrameRecord> frames = read_frames(file(), row.planned.number, row.attempt);
        std::set<std::uint64_t> hashes;
        int tracked = 0, stimuli = 0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            EXPECT_EQ(frames[i].shown.fault, "");
            EXPECT_EQ(frames[i].shown.missed_vsyncs, 0);
            EXPECT_EQ(frames[i].shown.index, frames[0].shown.index + static_cast<std::int64_t>(i));
            if (frames[i].phase != Phase::first_interval && frames[i].phase != Phase::second_interval)
                continue;
            ++stimuli;
            tracked += frames[i].gaze_sequence.has_value();
            ASSERT_TRUE(frames[i].shown.image_hash);
            hashes.insert(*frames[i].shown.image_hash);
        }
        EXPECT_EQ(stimuli, 2 * 42) << "0.6 s at 70 Hz";
        EXPECT_EQ(tracked, stimuli) << "every stimulus is foveated where the eye looked";
        EXPECT_GT(hashes.size(), 10u) << "and follows it";
        for (const GazeSample& sample : read_gaze(file(), row.planned.number, row.attempt))
            EXPECT_TRUE(sequences.insert(sample.sequence).second) << "no sample is stored twice";
    }
    for (const GazeBetween& between : read_gaze_between(file()))
        EXPECT_TRUE(sequences.insert(between.sample.sequence).second) << "no sample is stored twice";
    // One look comes before the session's start, and is nobody's.
    EXPECT_EQ(*sequences.begin(), 1);
    EXPECT_EQ(*sequences.rbegin(), static_cast<std::int64_t>(sequences.size()))
        << "no sample is lost between trials either";
    // The runtime counted a picture for each eye in every frame that it was asked to show.
    EXPECT_THAT(frames_log_, testing::HasSubstr(",2\n"));
}

TEST_F(HeadsetSession, EveryFaultFlagsItsTrialAndNothingIsLost) {
    const std::vector<std::string> faults{"negative_time", "backwards_time:2", "late:5",
                                          "session_lost",  "stopping",         "gaze_missing:60"};
    const std::vector<std::string> rules{"display_time_not_positive",
                                         "display_time_backwards",
                                         "missed_frames",
                                         "session_lost",
                                         "headset_off",
                                         "gaze_lost"};
    EXPECT_EQ(run(false, faults), SessionEnd::finished);
    EXPECT_EQ(failure_, "");
    const SessionRows rows = read_session(file());
    EXPECT_TRUE(rows.finished);
    expect_all_trials_count(rows);
    ASSERT_EQ(rows.trials.size(), 12u) << "each was shown again at the end";
    std::int64_t last_frame = -1;
    HostTime last_time;
    for (std::size_t i = 0; i < rows.trials.size(); ++i) {
        const TrialRow& row = rows.trials[i];
        if (i < faults.size()) {
            EXPECT_THAT(row.invalid, testing::Contains(rules[i])) << faults[i];
        } else {
            EXPECT_THAT(row.invalid, testing::IsEmpty());
        }
        EXPECT_TRUE(row.answer) << "answers are kept all the same";
        const std::vector<FrameRecord> frames = read_frames(file(), row.planned.number, row.attempt);
        for (std::size_t f = 0; f < frames.size(); ++f) {
            EXPECT_GT(frames[f].shown.index, last_frame);
            EXPECT_GT(frames[f].shown.display_time, last_time);
            last_frame = frames[f].shown.index;
            last_time = frames[f].shown.display_time;
        }
        for (const Phase phase : {Phase::first_interval, Phase::second_interval}) {
            const IntervalRecord& stimulus = row.intervals[static_cast<std::size_t>(phase)];
            EXPECT_EQ(stimulus.presented_frames + stimulus.missed_vsyncs, 42)
                << "it lasted as long as it should";
        }
    }
}

TEST_F(HeadsetSession, AParticipantWhoQuitsInTheHeadsetCanResume) {
    EXPECT_EQ(run(false, {"", "", "exiting"}), SessionEnd::stopped);
    EXPECT_THAT(failure_, testing::HasSubstr("ended in the headset"));
    const std::size_t answered = read_session(file()).trials.size();
    EXPECT_GE(answered, 2u) << "what was answered is on the disk";
    failure_.clear();
    EXPECT_EQ(run(true), SessionEnd::finished);
    EXPECT_EQ(failure_, "");
    expect_all_trials_count(read_session(file()));
}

// The program itself, in real time, its eye tracker on a thread of its own.
TEST_F(HeadsetSession, TheProgramRunsItFromTheCommandLineAndVerifiesIt) {
    ShortStudy study = kStudy;
    study.sigmas = "1.2, 2.4";
    study.alphas = "4";
    study.tables = "";  // how fast the machine is must not decide
    folder_.write("short.toml", short_study_toml(study));
    const ValidationLayers layers;
    layers.use("shrink=16;gaze=" + (folder_ / "gaze.csv").string());
    const auto run_validated = [&](const std::string& arguments) {
        return run_program(folder_, arguments, "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation");
    };
    const ProgramOutput ran = run_validated(
        "run short.toml --participant P03 --display openxr --hash-pictures --controller simulated --seed 3 "
        "--data data");
    ASSERT_EQ(ran.exit_code, 0) << ran.errors;
    layers.expect_silence();

    const std::filesystem::path session = short_session(folder_, "data");
    const SessionRows rows = read_session(session);
    EXPECT_TRUE(rows.finished);
    expect_all_trials_count(rows);
    EXPECT_THAT(rows.facts.display,
                testing::StartsWith("Simulated FOVE-like headset on Parafovea simulated"));
    EXPECT_EQ(rows.facts.view.size, (SizePx{80, 90}));
    int stimulus_frames = 0;
    for (const TrialRow& row : rows.trials) {
        EXPECT_FALSE(read_gaze(session, row.planned.number).empty());
        for (const Phase phase : {Phase::first_interval, Phase::second_interval})
            stimulus_frames += row.intervals[static_cast<std::size_t>(phase)].presented_frames;
    }

    const ProgramOutput replayed = run_validated("replay --verify '" + session.string() + "'");
    ASSERT_EQ(replayed.exit_code, 0) << replayed.errors;
    const std::string said = ran.out + ran.errors + replayed.out + replayed.errors;
    EXPECT_THAT(said,
                testing::HasSubstr(std::to_string(stimulus_frames) + " pictures rendered and compared"));
    for (const char* const complaint : {"VUID", "UNASSIGNED", "SYNC-HAZARD", "Validation Error"})
        EXPECT_THAT(said, testing::Not(testing::HasSubstr(complaint)));
}

}  // namespace
}  // namespace parafovea
