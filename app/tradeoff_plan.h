// What a trade-off sweep measures: scenes, displays, gazes, motions and methods, and how it is cut into
// shards.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/tradeoff_table.h"
#include "devices/geometry.h"
#include "renderer/methods/foveation_method.h"

namespace parafovea {

// A method at one setting; settings of one family lie on one curve of the figure.
struct TradeoffMethod {
    std::string family;
    RenderMethod method;

    bool operator==(const TradeoffMethod&) const = default;
};

struct TradeoffPlan {
    std::vector<std::string> scenes;  // built-in names or glTF files
    std::vector<ViewGeometry> views;
    std::vector<std::string> gazes{"centre", "quarter", "corner", "path"};
    std::vector<std::string> motions{"still", "path"};
    std::vector<TradeoffMethod> methods;  // full resolution is measured before them in any case
    double refresh_hz = 70;
    double peak_cd_m2 = 100;
    int rounds = 5;  // measured frames of a still picture
    int frames = 8;  // of what moves
    int taa = 0;     // anti-aliasing over time of every method, full resolution included: see FrameStages
    int reference_samples =
        16;                  // a pixel, of the super-sampled reference of a still; a quarter where it moves
    double gaze_age_ms = 0;  // how old the gaze is that a frame is drawn with
    std::string gaze_recording;  // a file; empty: the simulated eye
    std::uint64_t seed = 1;      // of the simulated eye
};

// What is measured together, all methods taking turns: the rows of a group are fair to each other.
struct TradeoffGroup {
    std::string scene;
    ViewGeometry view;
    std::string gaze, motion;

    bool moves() const { return gaze == "path" || motion == "path"; }
};

// Which part of a plan a run measures; counted from 1.
struct Shard {
    int index = 1;
    int count = 1;

    bool operator==(const Shard&) const = default;
};

// Full resolution, then the plan's methods.
std::vector<TradeoffMethod> methods_of(const TradeoffPlan& plan);

// "alpha=4 sigma=1.8".
std::string setting_text(const RenderMethod& method);

// Every group in the order of scenes, views, gazes and motions; of a shard, every count-th of them.
std::vector<TradeoffGroup> groups_of(const TradeoffPlan& plan, const Shard& shard = {});

// The row of one group and method with nothing measured yet.
TradeoffRow empty_row(const TradeoffPlan& plan, const TradeoffGroup& group, const TradeoffMethod& method);

// Throws std::runtime_error with one line where a method, a parameter, a gaze, a motion or a number makes no
// sense, or something is listed twice.
void check(const TradeoffPlan& plan);

// One line of JSON that says everything about a plan, and back. The second throws std::runtime_error that
// begins with `place`.
std::string plan_text(const TradeoffPlan& plan);
TradeoffPlan plan_from_text(const std::string& text, const std::string& place);

// "2/8"; throws std::runtime_error otherwise.
Shard parse_shard(const std::string& text);
std::string shard_text(const Shard& shard);

// The methods that are measured when none are named, and those of certain families. The second throws
// std::runtime_error with the names there are.
std::vector<TradeoffMethod> standard_tradeoff_methods();
std::vector<TradeoffMethod> tradeoff_methods_of(const std::vector<std::string>& families);

// "rings mar_slope=10 mar_start=0.05": a method and its parameters. Its family is the one that the standard
// list gives this setting, or else this method's defaults. Throws CLI::ValidationError or
// std::runtime_error with one line.
TradeoffMethod parse_tradeoff_method(const std::string& text);

}  // namespace parafovea
