// What of the time between the eye and the picture is ours: from a gaze sample's arrival to the numbers that
// the next frame is foveated by, for both eyes of a headset. Nothing is drawn.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "app/eye_pictures.h"
#include "devices/gazepoint/gazepoint_gaze.h"
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

// A tracker's server sends samples over TCP, 200 a second; its client's thread reads, decodes and maps them
// to the host's clock; the frame loop's side looks for them without a pause, chooses the foveation point,
// turns it into each eye's own, and writes the kernel map that the shaders read. The time is from just before
// the server sends until both maps are written. Counters: that time; the part of it after the client has
// stamped the sample's arrival; and the part after drain() has handed it over.
void gaze_sample_to_uniform(benchmark::State& state) {
    const Eyes eyes = two_eyes();
    Protocol protocol;
    protocol.foveation_gaze = GazePolicy::tracked;
    FoveationPoint foveation(protocol, eyes.view());
    Gpu gpu;
    KfrTargets targets(gpu, {}, {}, kEyePicture);
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
        foveation.take(samples);
        const FoveationPoint::Choice choice = foveation.choose();
        for (std::size_t eye = 0; eye < eyes.views.size(); ++eye) {
            targets.set_gaze(eyes.seen_at(eye, choice.point));
            benchmark::ClobberMemory();
        }
        const HostTime written = clock.now();

        if (choice.gaze_sequence != samples.back().sequence ||
            std::memcmp(targets.map.mapped(), &targets.block, sizeof targets.block) != 0) {
            state.SkipWithError("the sample did not reach the map");
            break;
        }
        const GazeSample& sample = samples.back();
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
BENCHMARK(gaze_sample_to_uniform)->UseManualTime()->Iterations(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace parafovea
