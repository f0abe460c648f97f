// Which settings are worth their cost: the frontier of quality against cost, comparisons at equal quality and
// at equal cost, and the cheapest setting without visible loss on a display.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/tradeoff_table.h"

namespace parafovea {

// What is paid: shaded samples for each pixel of the display, or frame time over full resolution's, measured
// in turns.
enum class Cost { samples, time };

// What is got, in JOD: against full resolution, or against the super-sampled picture.
enum class Quality { full_resolution, super_sampled };

double cost_of(const TradeoffRow& row, Cost cost);
double quality_of(const TradeoffRow& row, Quality quality);

// The rows that were measured together: of one scene, display, gaze and motion; in the order of the rows, all
// within `rows`.
std::vector<std::vector<TradeoffRow>> groups_of_rows(const std::vector<TradeoffRow>& rows);

// The rows that no other beats: indices by rising cost, and rising quality. Of equals, the first is kept.
std::vector<std::size_t> frontier(const std::vector<TradeoffRow>& rows, Cost cost, Quality quality);

// The setting that others are compared with.
struct Anchor {
    std::string family, setting;
};

// In a group; null if it was not measured.
const TradeoffRow* anchor_row(const std::vector<TradeoffRow>& group, const Anchor& anchor);

// One family's answer to another setting's quality or cost.
struct FamilyChoice {
    std::string family;
    // The cheapest measured setting of at least that quality, or the best of at most that cost; absent if
    // there is none. A copy.
    std::optional<TradeoffRow> row;
    // At equal quality: where the family's curve crosses it, by linear interpolation of JOD over the
    // logarithm of the cost between two neighbouring settings of its frontier; absent where it does not.
    std::optional<double> interpolated_cost;
};

// Families in the order of the rows, the anchor's own among them, full resolution left out. The rows are of
// one group.
std::vector<FamilyChoice> at_equal_quality(const std::vector<TradeoffRow>& group, const TradeoffRow& anchor,
                                           Cost cost, Quality quality);
std::vector<FamilyChoice> at_equal_cost(const std::vector<TradeoffRow>& group, const TradeoffRow& anchor,
                                        Cost cost, Quality quality);

// The JOD at which the predicted share of people who call the pictures identical crosses `share`,
// interpolated between the rows just below and above it; absent where all rows lie on one side.
std::optional<double> jod_at_share_identical(const std::vector<TradeoffRow>& rows, double share);

// One setting over everything measured on one display.
struct SettingSummary {
    std::string family, method, setting;
    int groups = 0;
    double least_p_identical = 1;
    double least_jod = 10;
    double mean_samples = 0;  // shaded samples for each pixel of the display
    double mean_time = 0;     // of full resolution's
    std::string least_in;     // the scene, gaze and motion of least_p_identical
};

struct DisplayRecommendation {
    int width = 0, height = 0;
    double horizontal_fov_deg = 0, peak_cd_m2 = 0, refresh_hz = 0;
    int groups = 0;
    // Settings, except full resolution, that were measured in all groups and lose nothing visible in any:
    // predicted share at least `criterion` everywhere. By rising mean samples.
    std::vector<SettingSummary> without_visible_loss;
    // All others, by falling least_p_identical.
    std::vector<SettingSummary> others;
};

std::vector<DisplayRecommendation> recommend(const std::vector<TradeoffRow>& rows, double criterion);

}  // namespace parafovea
