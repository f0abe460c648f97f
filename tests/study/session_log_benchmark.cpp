// What logging costs the frame loop, and how much memory a long session takes.
#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

#include "tests/study/lab.h"

namespace parafovea {
namespace {

// Resident memory of this process, bytes.
double resident_bytes() {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) * 1024;
    return 0;
}

// 120 Hz gaze for ever, without keeping it.
class EndlessGaze final : public GazeSource {
  public:
    explicit EndlessGaze(SimulatedClock& clock) : clock_(clock) {}
    void drain(std::vector<GazeSample>& samples) override {
        for (; next_ * 8'333'333 <= clock_.now().ns; ++next_) {
            GazeSample sample;
            sample.sequence = next_;
            sample.host_time = sample.arrival_time = {next_ * 8'333'333};
            sample.status = GazeStatus::tracked;
            sample.direction = DirectionDeg{0.1, 0.2};
            sample.left = sample.right = EyeSample{sample.direction, 3.0};
            samples.push_back(sample);
        }
    }
    std::string description() const override { return "endless"; }

  private:
    SimulatedClock& clock_;
    std::int64_t next_ = 0;
};

Protocol long_protocol() {
    std::string text = test::small_protocol_text();
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("refresh_hz = 100", "refresh_hz = 90");
    replace("interval_s = 0.2", "interval_s = 2.5");
    replace("gap_s = 0.1", "gap_s = 0.75");
    replace("sessions = 2", "sessions = 1\nrepetitions = 367");
    Protocol protocol = parse_protocol(text, "long.toml");
    return protocol;
}

// A session of a million frames at 90 Hz. Counters: the share of the frame time that one frame's recording
// and logging takes of the processor, all threads together; the memory the second half added.
void million_frames(benchmark::State& state) {
    for (auto _ : state) {
        TemporaryFolder folder;
        const Protocol protocol = long_protocol();
        SimulatedClock clock;
        test::FakeStage stage(clock, 90);
        stage.keep_last = 2;
        EndlessGaze gaze(clock);
        test::FakeParticipant participant(clock, stage);
        SessionLog log = SessionLog::create(folder / "s.sqlite", test::facts(), protocol,
                                            make_plan(protocol, 0, 1), {{}, 1});
        std::int64_t frames = 0;
        double memory_at_half = 0;
        SessionHooks hooks;
        hooks.on_trial = [&](const TrialRecord& record) {
            frames += static_cast<std::int64_t>(record.frames.size());
            if (memory_at_half == 0 && frames > 500'000) memory_at_half = resident_bytes();
        };
        const std::clock_t before = std::clock();
        run_session(log, stage, gaze, participant, clock, hooks);
        const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
        state.counters["frames"] = static_cast<double>(frames);
        state.counters["us_per_frame"] = seconds / static_cast<double>(frames) * 1e6;
        state.counters["percent_of_frame_time"] = seconds / static_cast<double>(frames) * 90 * 100;
        state.counters["MiB_added_by_second_half"] = (resident_bytes() - memory_at_half) / (1 << 20);
        state.counters["MiB_on_disk"] =
            static_cast<double>(std::filesystem::file_size(folder / "s.sqlite")) / (1 << 20);
    }
}
BENCHMARK(million_frames)->Iterations(1)->Unit(benchmark::kSecond);

// The part the frame loop waits for: handing a finished trial to the writer.
void append_a_trial(benchmark::State& state) {
    TemporaryFolder folder;
    test::ProgramRun run;
    const Protocol protocol = test::small_protocol();
    const TrialPlan plan = make_plan(protocol, 0, 1);
    SessionLog log = SessionLog::create(folder / "s.sqlite", test::facts(), protocol, plan, {{}, 1});
    TrialRecord record;
    record.planned = plan.trials.front();
    for (std::size_t i = 0; i < record.intervals.size(); ++i)
        record.intervals[i].phase = static_cast<Phase>(i);
    record.frames.resize(540);
    for (std::size_t i = 0; i < record.frames.size(); ++i)
        record.frames[i].shown.index = static_cast<std::int64_t>(i);
    record.gaze.resize(720);
    int attempt = 0;
    for (auto _ : state) {
        state.PauseTiming();
        log.wait_until_durable();
        TrialRecord next = record;
        next.attempt = attempt++;
        state.ResumeTiming();
        log.append(std::move(next));
    }
}
BENCHMARK(append_a_trial)->Iterations(200)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace parafovea
