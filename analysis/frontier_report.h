// The files of a sweep: its table, the figure of the frontier, comparisons at equal quality and equal cost,
// and the recommendation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/frontier.h"

namespace parafovea {

struct FrontierReport {
    std::vector<TradeoffRow> rows;
    Anchor anchor;           // published kernel foveated rendering
    double criterion = 0.8;  // share of "identical" answers that the study accepts
    std::string machine;     // what drew the pictures
    std::string command;     // that made the report
};

// The scene's built-in name or its file's name without the folder and ending.
std::string scene_title(const std::string& scene);

// "1280 x 1440 pixels, 76.7 degrees, 100 cd/m2, 70 Hz".
std::string display_title(const TradeoffRow& row);

std::string equal_quality_csv(const FrontierReport& report);
std::string equal_quality_markdown(const FrontierReport& report);
std::string equal_cost_csv(const FrontierReport& report);
std::string equal_cost_markdown(const FrontierReport& report);
std::string recommendation_markdown(const FrontierReport& report);

// A gnuplot script of one display's figure: a row of panels for each scene, JOD against samples and against
// time, for one gaze and motion.
std::string frontier_figure_script(const std::vector<TradeoffRow>& rows, const FrontierReport& report,
                                   const std::filesystem::path& stem);

// Writes tradeoff.csv, equal_quality.{csv,md}, equal_cost.{csv,md}, recommendation.md and
// frontier.{svg,png,pdf} into a folder; gives their paths. The figure shows the centre gaze and a still
// camera where they were measured; what moves, and further displays, have figures of their own:
// frontier_moving, frontier_1280x1440, ... Throws std::runtime_error where a file cannot be written or
// gnuplot is missing.
std::vector<std::filesystem::path> write_frontier(const FrontierReport& report,
                                                  const std::filesystem::path& out);

}  // namespace parafovea
