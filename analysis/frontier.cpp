// Compares settings.
#include "analysis/frontier.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace parafovea {
namespace {

constexpr const char* kFullMethod = "full";

// Equal up to rounding counts as reached.
constexpr double kTolerance = 1e-9;

std::vector<std::string> families_of(const std::vector<TradeoffRow>& group) {
    std::vector<std::string> families;
    for (const TradeoffRow& row : group)
        if (row.method != kFullMethod && std::ranges::find(families, row.family) == families.end())
            families.push_back(row.family);
    return families;
}

std::vector<TradeoffRow> rows_of(const std::vector<TradeoffRow>& group, const std::string& family) {
    std::vector<TradeoffRow> rows;
    std::ranges::copy_if(group, std::back_inserter(rows),
                         [&](const TradeoffRow& row) { return row.family == family; });
    return rows;
}

std::optional<double> crossing_cost(const std::vector<TradeoffRow>& rows, double wanted, Cost cost,
                                    Quality quality) {
    const std::vector<std::size_t> best = frontier(rows, cost, quality);
    for (std::size_t i = 0; i < best.size(); ++i) {
        const double high = quality_of(rows[best[i]], quality), at = cost_of(rows[best[i]], cost);
        if (std::abs(high - wanted) <= kTolerance) return at;
        if (high < wanted || i == 0) continue;
        const double low = quality_of(rows[best[i - 1]], quality);
        if (low > wanted) return std::nullopt;
        const double below = cost_of(rows[best[i - 1]], cost);
        const double t = (wanted - low) / (high - low);
        return std::exp(std::lerp(std::log(below), std::log(at), t));
    }
    return std::nullopt;
}

}  // namespace

double cost_of(const TradeoffRow& row, Cost cost) {
    return cost == Cost::samples ? row.share_of_samples() : row.frame_ms / row.full_frame_ms;
}

double quality_of(const TradeoffRow& row, Quality quality) {
    return quality == Quality::full_resolution ? row.jod : row.jod_supersampled;
}

std::vector<std::vector<TradeoffRow>> groups_of_rows(const std::vector<TradeoffRow>& rows) {
    const auto same = [](const TradeoffRow& a, const TradeoffRow& b) {
        return std::tie(a.scene, a.width, a.height, a.horizontal_fov_deg, a.peak_cd_m2, a.refresh_hz, a.gaze,
                        a.motion) == std::tie(b.scene, b.width, b.height, b.horizontal_fov_deg, b.peak_cd_m2,
                                              b.refresh_hz, b.gaze, b.motion);
    };
    std::vector<std::vector<TradeoffRow>> groups;
    for (const TradeoffRow& row : rows) {
        const auto group =
            std::ranges::find_if(groups, [&](const auto& other) { return same(other.front(), row); });
        if (group == groups.end())
            groups.push_back({row});
        else
            group->push_back(row);
    }
    return groups;
}

std::vector<std::size_t> frontier(const std::vector<TradeoffRow>& rows, Cost cost, Quality quality) {
    std::vector<std::size_t> order(rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        const double cost_a = cost_of(rows[a], cost), cost_b = cost_of(rows[b], cost);
        if (cost_a != cost_b) return cost_a < cost_b;
        return quality_of(rows[a], quality) > quality_of(rows[b], quality);
    });
    std::vector<std::size_t> best;
    for (const std::size_t i : order)
        if (best.empty() || quality_of(rows[i], quality) > quality_of(rows[best.back()], quality))
            best.push_back(i);
    return best;
}

const TradeoffRow* anchor_row(const std::vector<TradeoffRow>& group, const Anchor& anchor) {
    const auto found = std::ranges::find_if(group, [&](const TradeoffRow& row) {
        return row.family == anchor.family && row.setting == anchor.setting;
    });
    return found == group.end() ? nullptr : &*found;
}

std::vector<FamilyChoice> at_equal_quality(const std::vector<TradeoffRow>& group, const TradeoffRow& anchor,
                                           Cost cost, Quality quality) {
    const double wanted = quality_of(anchor, quality);
    std::vector<FamilyChoice> choices;
    for (const std::string& family : families_of(group)) {
        const std::vector<TradeoffRow> rows = rows_of(group, family);
        FamilyChoice choice{family, {}, crossing_cost(rows, wanted, cost, quality)};
        for (const TradeoffRow& row : rows)
            if (quality_of(row, quality) >= wanted - kTolerance &&
                (!choice.row || cost_of(row, cost) < cost_of(*choice.row, cost)))
                choice.row = row;
        choices.push_back(choice);
    }
    return choices;
}

std::vector<FamilyChoice> at_equal_cost(const std::vector<TradeoffRow>& group, const TradeoffRow& anchor,
                                        Cost cost, Quality quality) {
    const double allowed = cost_of(anchor, cost) * (1 + kTolerance);
    std::vector<FamilyChoice> choices;
    for (const std::string& family : families_of(group)) {
        FamilyChoice choice{family, {}, {}};
        for (const TradeoffRow& row : rows_of(group, family))
            if (cost_of(row, cost) <= allowed &&
                (!choice.row || quality_of(row, quality) > quality_of(*choice.row, quality)))
                choice.row = row;
        choices.push_back(choice);
    }
    return choices;
}

std::optional<double> jod_at_share_identical(const std::vector<TradeoffRow>& rows, double share) {
    // The best row that falls short, and the worst that does not.
    const TradeoffRow *below = nullptr, *above = nullptr;
    for (const TradeoffRow& row : rows) {
        const TradeoffRow*& side = row.predicted_p_identical < share ? below : above;
        const bool closer = !side || (row.predicted_p_identical < share
                                          ? row.predicted_p_identical > side->predicted_p_identical
                                          : row.predicted_p_identical < side->predicted_p_identical);
        if (closer) side = &row;
    }
    if (!below || !above) return std::nullopt;
    const double t = (share - below->predicted_p_identical) /
                     (above->predicted_p_identical - below->predicted_p_identical);
    return std::lerp(below->jod, above->jod, t);
}

std::vector<DisplayRecommendation> recommend(const std::vector<TradeoffRow>& rows, double criterion) {
    std::vector<DisplayRecommendation> displays;
    std::vector<std::vector<SettingSummary>> summaries;
    for (const std::vector<TradeoffRow>& group : groups_of_rows(rows)) {
        const TradeoffRow& first = group.front();
        std::size_t d = 0;
        while (d < displays.size() &&
               std::tie(displays[d].width, displays[d].height, displays[d].horizontal_fov_deg,
                        displays[d].peak_cd_m2, displays[d].refresh_hz) !=
                   std::tie(first.width, first.height, first.horizontal_fov_deg, first.peak_cd_m2,
                            first.refresh_hz))
            ++d;
        if (d == displays.size()) {
            displays.push_back({first.width,
                                first.height,
                                first.horizontal_fov_deg,
                                first.peak_cd_m2,
                                first.refresh_hz,
                                0,
                                {},
                                {}});
            summaries.emplace_back();
        }
        ++displays[d].groups;
        for (const TradeoffRow& row : group) {
            if (row.method == kFullMethod) continue;
            auto summary = std::ranges::find_if(summaries[d], [&](const SettingSummary& known) {
                return known.family == row.family && known.method == row.method &&
                       known.setting == row.setting;
            });
            if (summary == summaries[d].end()) {
                SettingSummary fresh;
                fresh.family = row.family;
                fresh.method = row.method;
                fresh.setting = row.setting;
                summary = summaries[d].insert(summaries[d].end(), fresh);
            }
            if (summary->groups == 0 || row.predicted_p_identical < summary->least_p_identical) {
                summary->least_p_identical = row.predicted_p_identical;
                summary->least_in = row.scene + ", gaze " + row.gaze + ", camera " + row.motion;
            }
            summary->least_jod = std::min(summary->least_jod, row.jod);
            ++summary->groups;
            summary->mean_samples += (row.share_of_samples() - summary->mean_samples) / summary->groups;
            summary->mean_time += (cost_of(row, Cost::time) - summary->mean_time) / summary->groups;
        }
    }
    for (std::size_t d = 0; d < displays.size(); ++d) {
        for (const SettingSummary& summary : summaries[d]) {
            const bool invisible =
                summary.least_p_identical >= criterion && summary.groups == displays[d].groups;
            (invisible ? displays[d].without_visible_loss : displays[d].others).push_back(summary);
        }
        std::ranges::stable_sort(displays[d].without_visible_loss, {}, &SettingSummary::mean_samples);
        std::ranges::stable_sort(displays[d].others, std::ranges::greater{},
                                 &SettingSummary::least_p_identical);
    }
    return displays;
}

}  // namespace parafovea
