// Measures methods against full resolution: every method of a scene and size takes its turn in every round of
// one run, and faster ones draw several frames in theirs, so that a machine whose speed drifts is fair to
// all. Meng et al. 2018, Tables 2 and 3.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "renderer/frame_renderer.h"

namespace parafovea {

struct BenchmarkMethod {
    std::string label;  // how tables call it
    RenderMethod method;
};

struct BenchmarkPlan {
    std::vector<std::string> scenes;  // names or glTF paths
    std::vector<SizePx> sizes;
    std::vector<BenchmarkMethod> methods;  // full resolution is measured before them in any case
    int warm_up_rounds = 1;                // at least 1: the first round builds pipelines
    int rounds = 5;
    bool moving_gaze = false;  // the gaze moves before every frame, so that nothing that hangs on it is kept
    // As in the paper every frame draws its geometry, as if the camera moved; with keep_geometry a still
    // view's is kept.
    ScenePassOptions options{.keep_geometry = false};
};

// Full resolution and what the paper and its successors add to it, as far as it is built: the paper's setting
// without and with culling, and the faster settings.
std::vector<BenchmarkMethod> standard_benchmark_methods();

struct BenchmarkRow {
    std::string scene;
    SizePx size;
    BenchmarkMethod method;
    double frame_ms = 0;      // median of the time from the call to the finished picture, not read back
    double frame_ms_low = 0;  // its quartiles
    double frame_ms_high = 0;
    double shading_ms = 0;  // median of pass_1
    // Full resolution's frame time over this one's: the median of the rounds, in each of which both met the
    // same machine.
    double speedup = 1;
    std::uint64_t shaded_samples = 0;
    std::vector<PassTimer::Pass> passes;    // medians of device time
    std::uint64_t device_memory_bytes = 0;  // allocated with every method of this size resident
};

// Rows in the order of scenes, sizes, methods, full resolution first. `progress` (may be empty) hears what
// share of the frames is drawn, in [0, 1], and what comes next. Throws what FrameRenderer throws.
std::vector<BenchmarkRow> run_benchmark(Gpu& gpu, const BenchmarkPlan& plan,
                                        const std::function<void(double, const std::string&)>& progress);

// What building only what a scene needs saves.
struct NeedsRow {
    std::string scene;
    SizePx size;
    double forced_ms = 0;  // median frame at full resolution with everything built
    double needed_ms = 0;  // and with only what the scene needs
    double still_ms = 0;   // and while view and scene stay as they are
    std::vector<FeatureNote> left_out;
};

// One row for each scene, at the first size. Throws what FrameRenderer throws.
std::vector<NeedsRow> measure_needs(Gpu& gpu, const BenchmarkPlan& plan,
                                    const std::function<void(double, const std::string&)>& progress);

}  // namespace parafovea
