// Draws, times and judges the groups of a sweep.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/tradeoff_judgement.h"
#include "app/tradeoff_plan.h"
#include "app/tradeoff_views.h"
#include "renderer/frame_renderer.h"

namespace parafovea {

// What a measurement tells while it runs, from one thread at a time: work done, in the unit of work_of(), and
// a row as soon as it is complete.
struct TradeoffListener {
    std::function<void(int, const std::string&)> worked;
    std::function<void(const TradeoffRow&)> measured;
};

// How much work a group with so many methods is, in drawn frames or what takes about as long.
int work_of(const TradeoffPlan& plan, const TradeoffGroup& group, std::size_t methods);

class TradeoffMeasurement {
  public:
    // Borrows both for its lifetime.
    TradeoffMeasurement(Gpu& gpu, const TradeoffPlan& plan);
    ~TradeoffMeasurement();

    // Measures methods of one group in turns, frame by frame, always with full resolution, which is the first
    // of them. A frame's time is taken without the reading of its pixels, after one round that does not
    // count; before each timed frame of a still picture the gaze moves by a pixel, as a tracked gaze does.
    // Pictures are judged on all cores when all are drawn. Throws what FrameRenderer throws.
    void measure(const TradeoffGroup& group, const std::vector<TradeoffMethod>& methods,
                 const TradeoffListener& listener);

  private:
    struct Stage;

    Stage& stage_for(const TradeoffGroup& group);
    Image super_sampled(Stage& stage, const TradeoffGroup& group, const CameraView& view, int samples,
                        const TradeoffListener& listener);

    Gpu& gpu_;
    const TradeoffPlan& plan_;
    std::unique_ptr<Stage> stage_;
};

}  // namespace parafovea
