// What of the time between the eye and the picture is ours: from a gaze sample's arrival to the numbers that
// the next frame is foveated by, for both eyes of a headset. Nothing is drawn.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/eye_pictures.h"
#include "devices/gazepoint/gazepoint_gaze.h"
#include "devices/simulated/simulated_gaze.h"
#include "renderer/methods/kfr_targets.h"
#include "study/foveation_point.h"
#include "tests/devices/fake_gazepoint.h"

namespace parafovea {
namespace {

constexpr SizePx kEyePicture{1280, 1440};

// A headset like the FOVE 0.
Eyes two_eyes() {
    Eyes eyes;
    for (const int side : {-1, 1}) {
        const auto outer = static_cast<float>(rad_from_deg(52)), inner = static_cast<float>(rad_from_deg(48));
        XrView view{XR_TYPE_VIEW, nullptr, {}, {}};
        view.pose.orientation.w = 1;
        view.pose.position.x = 0.0315f * static_cast<float>(side);
        view.fov = {side < 0 ? -outer : -inner, side < 0 ? inner : outer, inner, -inner};
        eyes.views.push_back(view);
        eyes.sizes.push_back(kEyePicture);
    }
    return eyes;
}

double quantile(std::vector<double> values, double share) {
    const auto place = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

void report(benchmark::State& state, const std::string& name, const std::vector<double>& values_us) {
    state.counters[name + "_median_us"] = quantile(values_us, 0.5);
    state.counters[name + "_p99_us"] = quantile(values_us, 0.99);
}

// What the frame loop does with samples, up to the kernel maps that the shaders read.
class FoveatedEyes {
  public:
    FoveatedEyes()
        : foveation_(tracked(), eyes_.view()),
          targets_(gpu_, {}, list_maker_, ShadedThing::meshes, {}, kEyePicture) {}

    // Chooses the foveation point, turns it into each eye's own, and writes the maps.
    void take(std::span<const GazeSample> samples) {
        foveation_.take(samples);
        choice_ = foveation_.choose();
        for (std::size_t eye = 0; eye < eyes_.views.size(); ++eye) {
            targets_.set_gaze(eyes_.seen_at(eye, choice_.point));
            benchmark::ClobberMemory();
        }
    }

    // Whether the shaders would see this sample.
    bool shows(const GazeSample& sample) const {
        return choice_.gaze_sequence == sample.sequence &&
               std::memcmp(targets_.map.mapped(), &targets_.block, sizeof targets_.block) == 0;
    }

  private:
    static Protocol tracked() {
        Protocol protocol;
        protocol.foveation_gaze = GazePolicy::tracked;
        return protocol;
    }

    const Eyes eyes_ = two_eyes();
    FoveationPoint foveation_;
    FoveationPoint::Choice choice_;
    Gpu gpu_;
    TexelList::Maker list_maker_{gpu_};
    KfrTargets targets_;
};

// A tracker's server sends samples over TCP, 200 a second; its client's thread reads, decodes and maps them
// to the host's clock; the frame loop's side looks for them without a pause. The time is from just before the
// server sends until both maps are written. Counters: that time; the part of it after the client has stamped
// the sample's arrival; and the part after drain() has handed it over. Two threads wait for their turn on the
// processor in it, so it says nothing of ours on a busy machine.
void gaze_sample_to_uniform_over_tcp(benchmark::State& state) {
    FoveatedEyes eyes;
    FakeGazepoint server;
    SteadyClock clock;
    GazepointGaze gaze(clock, {.port = server.port()});
    std::vector<double> from_sent_us, from_arrival_us, from_drain_us;
    std::vector<GazeSample> samples;
    for (auto _ : state) {
        samples.clear();
        HostTime drained;
        while (samples.empty() || !samples.back().direction) {
            std::this_thread::yield();
            samples.clear();
            gaze.drain(samples);
            drained = clock.now();
        }
        eyes.take(samples);
        const HostTime written = clock.now();

        const GazeSample& sample = samples.back();
        if (!eyes.shows(sample)) {
            state.SkipWithError("the sample did not reach the map");
            break;
        }
        const Duration whole = written - server.sent_at(sample.device_time);
        from_sent_us.push_back(whole.ms() * 1e3);
        from_arrival_us.push_back((written - sample.arrival_time).ms() * 1e3);
        from_drain_us.push_back((written - drained).ms() * 1e3);
        state.SetIterationTime(whole.seconds());
    }
    if (from_sent_us.empty()) return;
    report(state, "sent", from_sent_us);
    report(state, "arrived", from_arrival_us);
    report(state, "drained", from_drain_us);
}
BENCHMARK(gaze_sample_to_uniform_over_tcp)->UseManualTime()->Iterations(1000)->Unit(benchmark::kMicrosecond);

// The same work in one thread, so that nothing waits: from the moment a simulated tracker's sample is there,
// through the mapping of its clock and drain(), until both maps are written. Moving the simulated eye is in
// it.
void gaze_sample_to_uniform_alone(benchmark::State& state) {
    FoveatedEyes eyes;
    SimulatedClock simulated;
    SimulatedGazeSettings settings;
    settings.drop_probability = settings.loss_rate_hz = 0;
    SimulatedGaze gaze(simulated, settings);
    SteadyClock clock;
    std::vector<double> whole_us;
    std::vector<GazeSample> samples;
    for (auto _ : state) {
        Duration whole;
        // Blinks have no direction; as soon as there is one again, its sample counts.
        do {
            samples.clear();
            simulated.wait_until(simulated.now() + Duration::from_seconds(1.0 / settings.rate_hz));
            const HostTime began = clock.now();
            gaze.drain(samples);
            eyes.take(samples);
            whole = clock.now() - began;
        } while (samples.empty() || !samples.back().direction);
        if (!eyes.shows(samples.back())) {
            state.SkipWithError("the sample did not reach the map");
            break;
        }
        whole_us.push_back(whole.ms() * 1e3);
        state.SetIterationTime(whole.seconds());
    }
    if (!whole_us.empty()) report(state, "whole", whole_us);
}
BENCHMARK(gaze_sample_to_uniform_alone)->UseManualTime()->Iterations(20000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace parafovea
