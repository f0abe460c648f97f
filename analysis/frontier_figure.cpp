// Draws the frontier: letters for methods, so that it reads without colour.
#include <algorithm>
#include <map>
#include <optional>

#include "analysis/figure.h"
#include "analysis/frontier_report.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

// Families in the order of the rows; the n-th is drawn as the letter A + n.
std::vector<std::string> families_in(const std::vector<TradeoffRow>& rows) {
    std::vector<std::string> families;
    for (const TradeoffRow& row : rows)
        if (std::ranges::find(families, row.family) == families.end()) families.push_back(row.family);
    return families;
}

std::string letter_of(std::size_t n) {
    return n < 26 ? std::string(1, static_cast<char>('A' + n)) : "A" + letter_of(n - 26);
}

// The range of the axis: what is drawn and a margin.
struct Range {
    double low = 0, high = 1;
};

Range cost_range(const std::vector<TradeoffRow>& rows, Cost cost) {
    Range range{cost_of(rows.front(), cost), cost_of(rows.front(), cost)};
    for (const TradeoffRow& row : rows) {
        range.low = std::min(range.low, cost_of(row, cost));
        range.high = std::max(range.high, cost_of(row, cost));
    }
    return {range.low / 1.25, range.high * 1.25};
}

Range jod_range(const std::vector<TradeoffRow>& rows) {
    double low = 10;
    for (const TradeoffRow& row : rows) low = std::min(low, row.jod);
    const double margin = std::max(0.08 * (10 - low), 0.02);
    return {low - margin, 10 + margin};
}

std::string point_of(const TradeoffRow& row, Cost cost) {
    return general_text(cost_of(row, cost), 7) + " " + fixed_text(row.jod, 5);
}

std::string panel(const std::vector<TradeoffRow>& rows, const FrontierReport& report,
                  const std::vector<std::string>& families, Cost cost, const std::string& id) {
    // The frontier as a staircase from the cheapest to full resolution.
    std::string data = "$frontier" + id + " << EOD\n", plot = "plot ";
    double last_jod = 0;
    for (const std::size_t i : frontier(rows, cost, Quality::full_resolution)) {
        if (last_jod > 0)
            data += general_text(cost_of(rows[i], cost), 7) + " " + fixed_text(last_jod, 5) + "\n";
        data += point_of(rows[i], cost) + "\n";
        last_jod = rows[i].jod;
    }
    data += "EOD\n";
    plot += "$frontier" + id + " with lines linewidth 4 linecolor rgb '#D9D9D9' notitle";
    if (const auto jod = jod_at_share_identical(rows, report.criterion))
        plot += ", " + fixed_text(*jod, 5) +
                " with lines dashtype (8,5) linewidth 0.9 linecolor rgb '#333333' notitle";

    for (std::size_t f = 0; f < families.size(); ++f) {
        const std::string name = "$family" + id + "_" + std::to_string(f);
        std::vector<TradeoffRow> own;
        std::ranges::copy_if(rows, std::back_inserter(own),
                             [&](const TradeoffRow& row) { return row.family == families[f]; });
        if (own.empty()) continue;
        std::ranges::stable_sort(own, {}, [&](const TradeoffRow& row) { return cost_of(row, cost); });
        data += name + " << EOD\n";
        for (const TradeoffRow& row : own)
            data += point_of(row, cost) + " \"{/:Bold " + letter_of(f) + "}\"\n";
        data += "EOD\n";
        const std::string colour = series_style(f).colour;
        plot += ", " + name + " using 1:2 with lines linewidth 0.6 linecolor rgb '" + colour + "' notitle, " +
                name + " using 1:2:3 with labels font ',10' textcolor rgb '" + colour + "' notitle";
    }
    if (const TradeoffRow* anchor = anchor_row(rows, report.anchor)) {
        data += "$anchor" + id + " << EOD\n" + point_of(*anchor, cost) + "\nEOD\n";
        plot +=
            ", $anchor" + id +
            " using 1:2 with points pointtype 6 pointsize 2.4 linewidth 1.4 linecolor rgb '#000000' notitle";
    }
    return data + plot + "\n";
}

}  // namespace

std::string frontier_figure_script(const std::vector<TradeoffRow>& rows, const FrontierReport& report,
                                   const std::filesystem::path& stem) {
    const std::vector<std::vector<TradeoffRow>> groups = groups_of_rows(rows);
    const std::vector<std::string> families = families_in(rows);
    const TradeoffRow& first = rows.front();

    // The letters are explained below the panels, in columns.
    constexpr std::size_t kKeyColumns = 3;
    const std::size_t key_lines = (families.size() + 1 + kKeyColumns - 1) / kKeyColumns + 1;
    const double panel_cm = 6.3, key_cm = 0.55 * static_cast<double>(key_lines) + 0.2, title_cm = 1.3;
    const double height_cm = title_cm + panel_cm * static_cast<double>(groups.size()) + key_cm;

    std::string body = "set title ''\nset border 3 linewidth 0.8 linecolor rgb '#333333'\n";
    body += "set tics nomirror out scale 0.5\nset grid linetype 1 linewidth 0.3 linecolor rgb '#E3E3E3'\n";
    body += "unset key\nset logscale x\n";
    body += "set multiplot\n";
    const auto at_y = [&](double cm) { return fixed_text(cm / height_cm, 5); };
    std::size_t entry = 0;
    const auto explain = [&](const std::string& text, const std::string& colour) {
        const double x = 0.04 + 0.325 * static_cast<double>(entry % kKeyColumns);
        const double y = key_cm - 0.45 - 0.55 * static_cast<double>(entry / kKeyColumns);
        body += "set label " + std::to_string(10 + entry++) + " " + text + " at screen " + fixed_text(x, 4) +
                "," + at_y(y) + " textcolor rgb '" + colour + "' font ',9'\n";
    };
    body += "set label 1 " +
            gnuplot_quoted(display_title(first) + "; gaze: " + first.gaze + ", camera: " + first.motion) +
            " at screen 0.5," + at_y(height_cm - 0.55) + " center\n";
    for (std::size_t f = 0; f < families.size(); ++f)
        explain("\"{/:Bold " + letter_of(f) + "}  \"." + gnuplot_quoted(families[f]), series_style(f).colour);
    explain(gnuplot_quoted("○  published setting of KFR"), "#000000");
    explain(gnuplot_quoted("grey: the frontier"), "#000000");
    explain(gnuplot_quoted("dashed: " + general_text(100 * report.criterion, 4) +
                           " % predicted to see no difference"),
            "#000000");

    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double bottom = key_cm + panel_cm * static_cast<double>(groups.size() - 1 - g) + 1.25;
        const Range jod = jod_range(groups[g]);
        for (const Cost cost : {Cost::samples, Cost::time}) {
            const bool samples = cost == Cost::samples;
            const Range range = cost_range(groups[g], cost);
            body += "set lmargin at screen " + std::string(samples ? "0.09" : "0.58") +
                    "\nset rmargin at screen " + (samples ? "0.49" : "0.98") + "\nset bmargin at screen " +
                    at_y(bottom) + "\nset tmargin at screen " + at_y(bottom + panel_cm - 2.0) + "\n";
            body += "set xrange [" + general_text(range.low, 6) + ":" + general_text(range.high, 6) +
                    "]\nset yrange [" + fixed_text(jod.low, 5) + ":" + fixed_text(jod.high, 5) + "]\n";
            body += "set xtics (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2, 3, 5)\n";
            body += "set title " + gnuplot_quoted(scene_title(groups[g].front().scene)) + " offset 0,-0.6\n";
            body += samples
                        ? "set xlabel 'shaded samples / pixels' offset 0,0.5\nset ylabel 'JOD' offset 1,0\n"
                        : "set xlabel 'frame time / full resolution''s' offset 0,0.5\nset ylabel ''\n";
            body += panel(groups[g], report, families, cost, std::to_string(g) + (samples ? "s" : "t"));
            // Drawn once; they stand outside the panels.
            body += "unset label\n";
        }
    }
    body += "unset multiplot\nunset logscale\n";
    return figure_script(stem, {17.0, height_cm}, body);
}

}  // namespace parafovea
