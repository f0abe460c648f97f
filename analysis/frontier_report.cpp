// Writes what a sweep found.
#include "analysis/frontier_report.h"

#include <algorithm>
#include <cmath>

#include "analysis/csv_text.h"
#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

std::string percent(double share) {
    return fixed_text(100 * share, 1) + " %";
}

std::string ratio(double value, double reference) {
    return reference > 0 ? fixed_text(value / reference, 2) : "–";
}

std::string group_title(const TradeoffRow& row) {
    return scene_title(row.scene) + ", " + display_title(row) + ", gaze " + row.gaze + ", camera " +
           row.motion;
}

std::string origin(const FrontierReport& report) {
    return "Drawn by " + report.machine + ".\n\n    " + report.command + "\n\n";
}

constexpr const char* kModelsWord =
    "Visible differences and shares of people are predictions of a model (a foveated visible difference "
    "predictor, and simulated observers whose constants come from the literature); people may differ from "
    "it. A study decides.\n";

// One table for each group that has the anchor.
template <typename Write>
void for_each_anchored(const FrontierReport& report, Write&& write) {
    for (const std::vector<TradeoffRow>& group : groups_of_rows(report.rows))
        if (const TradeoffRow* anchor = anchor_row(group, report.anchor)) write(group, *anchor);
}

// What stands in a report that has nothing to compare with; empty otherwise.
std::string missing_anchor(const FrontierReport& report) {
    bool found = false;
    for_each_anchored(report, [&](const std::vector<TradeoffRow>&, const TradeoffRow&) { found = true; });
    return found ? ""
                 : "Nothing to compare with: " + report.anchor.family + " (" + report.anchor.setting +
                       ") was not measured; name it among the methods, or leave --methods out.\n\n";
}

std::string choice_markdown(const FamilyChoice& choice, const TradeoffRow& anchor, bool interpolated) {
    std::string line = "| " + choice.family + " | ";
    if (!choice.row) {
        line += "none reaches it | – | – | – | – | – | – | – |";
    } else {
        const TradeoffRow& row = *choice.row;
        line += row.setting + " | " + fixed_text(row.jod, 3) + " | " + fixed_text(row.jod_supersampled, 3) +
                " | " + percent(row.predicted_p_identical) + " | " + fixed_text(row.share_of_samples(), 4) +
                " | " + ratio(row.share_of_samples(), anchor.share_of_samples()) + " | " +
                fixed_text(row.frame_ms, 1) + " | " +
                ratio(cost_of(row, Cost::time), cost_of(anchor, Cost::time)) + " |";
    }
    if (interpolated)
        line +=
            " " +
            (choice.interpolated_cost ? ratio(*choice.interpolated_cost, anchor.share_of_samples()) : "–") +
            " |";
    return line + "\n";
}

constexpr const char* kChoiceHead =
    "| method | setting | JOD | JOD, super-sampled | predicted identical | samples / pixels | of published "
    "KFR's | frame, ms | of published KFR's |";

std::string choices_csv(const FrontierReport& report, bool equal_quality) {
    std::string csv =
        "scene,width,height,horizontal_fov_deg,gaze,motion,by,family,method,setting,jod,jod_supersampled,"
        "predicted_p_identical,samples_per_pixel,samples_ratio,frame_ms,time_ratio,interpolated_ratio\n";
    for_each_anchored(report, [&](const std::vector<TradeoffRow>& group, const TradeoffRow& anchor) {
        for (const bool second : {false, true}) {
            // At equal quality the second table judges against the super-sampled picture; at equal cost it
            // counts time.
            const Quality quality =
                equal_quality && second ? Quality::super_sampled : Quality::full_resolution;
            const Cost cost = !equal_quality && second ? Cost::time : Cost::samples;
            const char* by =
                equal_quality ? (second ? "jod_supersampled" : "jod") : (second ? "time" : "samples");
            const std::vector<FamilyChoice> choices = equal_quality
                                                          ? at_equal_quality(group, anchor, cost, quality)
                                                          : at_equal_cost(group, anchor, cost, quality);
            for (const FamilyChoice& choice : choices) {
                csv += csv_field(anchor.scene) + "," + std::to_string(anchor.width) + "," +
                       std::to_string(anchor.height) + "," + short_text(anchor.horizontal_fov_deg) + "," +
                       anchor.gaze + "," + anchor.motion + "," + by + "," + csv_field(choice.family) + ",";
                if (choice.row) {
                    const TradeoffRow& row = *choice.row;
                    csv += row.method + "," + csv_field(row.setting) + "," + fixed_text(row.jod, 4) + "," +
                           fixed_text(row.jod_supersampled, 4) + "," +
                           fixed_text(row.predicted_p_identical, 4) + "," +
                           fixed_text(row.share_of_samples(), 5) + "," +
                           fixed_text(row.share_of_samples() / anchor.share_of_samples(), 4) + "," +
                           fixed_text(row.frame_ms, 3) + "," +
                           fixed_text(cost_of(row, Cost::time) / cost_of(anchor, Cost::time), 4) + ",";
                } else {
                    csv += ",,,,,,,,,";
                }
                if (choice.interpolated_cost)
                    csv += fixed_text(*choice.interpolated_cost / cost_of(anchor, cost), 4);
                csv += "\n";
            }
        }
    });
    return csv;
}

bool saves_time(const SettingSummary& setting) {
    return setting.mean_time < 1;
}

std::string in_bold(const SettingSummary& setting) {
    return "**" + setting.family + "** (" + (setting.setting.empty() ? "its defaults" : setting.setting) +
           ")";
}

}  // namespace

std::string scene_title(const std::string& scene) {
    return std::filesystem::path(scene).stem().string();
}

std::string display_title(const TradeoffRow& row) {
    return std::to_string(row.width) + " x " + std::to_string(row.height) + " pixels, " +
           general_text(row.horizontal_fov_deg, 4) + "°, " + general_text(row.peak_cd_m2, 4) + " cd/m², " +
           general_text(row.refresh_hz, 4) + " Hz";
}

std::string equal_quality_csv(const FrontierReport& report) {
    return choices_csv(report, true);
}

std::string equal_cost_csv(const FrontierReport& report) {
    return choices_csv(report, false);
}

std::string equal_quality_markdown(const FrontierReport& report) {
    std::string text =
        "# At equal quality\n\nThe cheapest measured setting of each method whose JOD is at least "
        "that of " +
        report.anchor.family + " (" + report.anchor.setting +
        "), by shaded samples. Last column: its samples where the method's curve crosses that "
        "JOD, interpolated between two measured settings, over published KFR's.\n\n" +
        origin(report) + missing_anchor(report);
    for_each_anchored(report, [&](const std::vector<TradeoffRow>& group, const TradeoffRow& anchor) {
        for (const Quality quality : {Quality::full_resolution, Quality::super_sampled}) {
            text += "## " + group_title(anchor) + "\n\nJOD at least " +
                    fixed_text(quality_of(anchor, quality), 3) +
                    (quality == Quality::full_resolution ? ", against full resolution.\n\n"
                                                         : ", against the super-sampled picture.\n\n") +
                    kChoiceHead + " interpolated |\n|---|---|---|---|---|---|---|---|---|---|\n";
            for (const FamilyChoice& choice : at_equal_quality(group, anchor, Cost::samples, quality))
                text += choice_markdown(choice, anchor, true);
            text += "\n";
        }
    });
    return text + kModelsWord;
}

std::string equal_cost_markdown(const FrontierReport& report) {
    std::string text =
        "# At equal cost\n\nThe best measured setting of each method (JOD against full "
        "resolution) that costs at most what " +
        report.anchor.family + " (" + report.anchor.setting + ") costs.\n\n" + origin(report) +
        missing_anchor(report);
    for_each_anchored(report, [&](const std::vector<TradeoffRow>& group, const TradeoffRow& anchor) {
        for (const Cost cost : {Cost::samples, Cost::time}) {
            text +=
                "## " + group_title(anchor) + "\n\nAt most " +
                (cost == Cost::samples ? fixed_text(anchor.share_of_samples(), 4) + " samples a pixel.\n\n"
                                       : fixed_text(anchor.frame_ms, 1) + " ms a frame.\n\n") +
                kChoiceHead + "\n|---|---|---|---|---|---|---|---|---|\n";
            for (const FamilyChoice& choice : at_equal_cost(group, anchor, cost, Quality::full_resolution))
                text += choice_markdown(choice, anchor, false);
            text += "\n";
        }
    });
    return text + kModelsWord;
}

std::string recommendation_markdown(const FrontierReport& report) {
    std::string text = "# Recommendation\n\n" + origin(report);
    const std::string line = general_text(100 * report.criterion, 4) + " %";
    const std::string head =
        "| method | setting | least predicted identical | in | least JOD | samples / pixels | time / full "
        "resolution's |\n|---|---|---|---|---|---|---|\n";
    const auto row_of = [](const SettingSummary& setting) {
        return "| " + setting.family + " | " + setting.setting + " | " + percent(setting.least_p_identical) +
               " | " + setting.least_in + " | " + fixed_text(setting.least_jod, 3) + " | " +
               fixed_text(setting.mean_samples, 4) + " | " + fixed_text(setting.mean_time, 2) + " |\n";
    };
    for (const DisplayRecommendation& display : recommend(report.rows, report.criterion)) {
        TradeoffRow shown;
        shown.width = display.width;
        shown.height = display.height;
        shown.horizontal_fov_deg = display.horizontal_fov_deg;
        shown.peak_cd_m2 = display.peak_cd_m2;
        shown.refresh_hz = display.refresh_hz;
        text += "## " + display_title(shown) + "\n\n";
        const auto best = std::ranges::find_if(display.without_visible_loss, saves_time);
        if (best == display.without_visible_loss.end()) {
            text +=
                "On this display no measured setting saves time and loses nothing visible in all " +
                std::to_string(display.groups) +
                " combinations of scene, gaze and motion (predicted share of people who see no difference "
                "at least " +
                line + " in each): use full resolution, or accept a loss.\n\n";
        } else {
            const SettingSummary& fastest =
                *std::ranges::min_element(display.without_visible_loss, {}, &SettingSummary::mean_time);
            text += "On this display, at no visible loss (JOD no lower than " +
                    fixed_text(best->least_jod, 3) +
                    ", predicted share of people who see no difference at least " + line + ", in each of " +
                    std::to_string(display.groups) +
                    " combinations of scene, gaze and motion): " + in_bold(*best) + " with " +
                    percent(best->mean_samples) + " of the samples and " + percent(best->mean_time) +
                    " of the time of full resolution.";
            if (fastest.family != best->family || fastest.setting != best->setting)
                text +=
                    " Fastest: " + in_bold(fastest) + " with " + percent(fastest.mean_time) + " of the time.";
            text += "\n\n";
        }
        if (!display.without_visible_loss.empty()) {
            text += head;
            for (const SettingSummary& setting : display.without_visible_loss) text += row_of(setting);
            text += "\n";
        }
        if (!display.others.empty()) {
            text += "With a visible loss somewhere, the least first:\n\n" + head;
            for (const SettingSummary& setting : display.others) text += row_of(setting);
            text += "\n";
        }
    }
    return text + kModelsWord;
}

std::vector<std::filesystem::path> write_frontier(const FrontierReport& report,
                                                  const std::filesystem::path& out) {
    make_output_folder(out);
    std::vector<std::filesystem::path> files;
    const auto write = [&](const char* name, const std::string& text) {
        write_text_file(out / name, text);
        files.push_back(out / name);
    };
    write("tradeoff.csv", tradeoff_csv(report.rows));
    write("equal_quality.csv", equal_quality_csv(report));
    write("equal_quality.md", equal_quality_markdown(report));
    write("equal_cost.csv", equal_cost_csv(report));
    write("equal_cost.md", equal_cost_markdown(report));
    write("recommendation.md", recommendation_markdown(report));

    // One figure for each display, for what stands still and for what moves.
    std::vector<DisplayRecommendation> displays = recommend(report.rows, report.criterion);
    for (std::size_t d = 0; d < displays.size(); ++d)
        for (const bool moving : {false, true}) {
            std::vector<TradeoffRow> rows;
            for (const TradeoffRow& row : report.rows)
                if (row.width == displays[d].width && row.height == displays[d].height &&
                    row.horizontal_fov_deg == displays[d].horizontal_fov_deg && (row.frames > 1) == moving)
                    rows.push_back(row);
            if (rows.empty()) continue;
            // One gaze and motion of several: the centre, and the moving camera.
            const auto rank = [](const TradeoffRow& row) {
                return std::pair(row.motion != "path", row.gaze != "centre");
            };
            const TradeoffRow chosen = *std::ranges::min_element(rows, {}, rank);
            std::erase_if(rows, [&](const TradeoffRow& row) {
                return row.gaze != chosen.gaze || row.motion != chosen.motion;
            });
            std::string name = "frontier";
            if (d > 0)
                name += "_" + std::to_string(displays[d].width) + "x" + std::to_string(displays[d].height);
            if (moving && !(d == 0 && files.back().stem() != "frontier")) name += "_moving";
            run_gnuplot(frontier_figure_script(rows, report, out / name));
            for (const std::filesystem::path& file : figure_files(out / name)) files.push_back(file);
        }
    return files;
}

}  // namespace parafovea
