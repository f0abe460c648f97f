// Figures 9 and 10: P_I against sigma^2, one series per alpha.
#include "analysis/condition_figure.h"

#include <algorithm>

#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

std::vector<double> distinct(const std::vector<ConditionRow>& rows, double ConditionRow::*member) {
    std::vector<double> values;
    for (const ConditionRow& row : rows) values.push_back(row.*member);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

}  // namespace

std::string condition_figure_script(const std::vector<ConditionRow>& rows, std::int64_t participants,
                                    const StudyDescription& study, const std::filesystem::path& stem) {
    const std::vector<double> sigmas = distinct(rows, &ConditionRow::sigma);
    const std::vector<double> alphas = distinct(rows, &ConditionRow::alpha);
    const double count = static_cast<double>(sigmas.size());

    // One data block per alpha; groups stand at 0, 1, 2 ... and series beside each other within a group.
    std::string body;
    const double spacing = 0.68 / static_cast<double>(std::max<std::size_t>(alphas.size(), 2));
    std::int64_t fewest = INT64_MAX, most = 0;
    for (std::size_t j = 0; j < alphas.size(); ++j) {
        const double offset =
            (static_cast<double>(j) - (static_cast<double>(alphas.size()) - 1.0) / 2.0) * spacing;
        body += "$series" + std::to_string(j) + " << EOD\n";
        for (const ConditionRow& row : rows) {
            fewest = std::min(fewest, row.identical.n);
            most = std::max(most, row.identical.n);
            if (row.alpha != alphas[j] || !row.identical.p) continue;
            const auto group = std::lower_bound(sigmas.begin(), sigmas.end(), row.sigma) - sigmas.begin();
            const double p = *row.identical.p, se = *row.identical.standard_error;
            body += fixed_text(static_cast<double>(group) + offset, 4) + " " + fixed_text(100.0 * p, 4) +
                    " " + fixed_text(100.0 * std::max(0.0, p - se), 4) + " " +
                    fixed_text(100.0 * std::min(1.0, p + se), 4) + "\n";
        }
        body += "EOD\n";
    }

    // Name what is shown, and in the same breath where the data come from.
    const std::string trials =
        fewest == most ? std::to_string(most) : std::to_string(fewest) + "–" + std::to_string(most);
    std::string subtitle = std::to_string(participants) +
                           (participants == 1 ? " participant, " : " participants, ") + trials +
                           " trials per condition; bars: ±1 standard error";
    std::string title = "\"{/=13 {/:Bold \".";
    title += gnuplot_quoted(study.title) + ".\"}}\\n{/=10.5 \"." + gnuplot_quoted(subtitle) + ".\"}\"";
    if (!study.data_origin.empty())
        title += ".\"\\n{/=10.5 {/:Bold Data: \"." + gnuplot_quoted(study.data_origin) + ".\"}}\"";
    body += "set title " + title + " left offset graph -0.5,character 1.2\n";

    // Shade every second group, so that a marker is never ascribed to the wrong sigma.
    for (std::size_t i = 1; i < sigmas.size(); i += 2)
        body += "set object rectangle from " + fixed_text(static_cast<double>(i) - 0.5, 1) + ",graph 0 to " +
                fixed_text(static_cast<double>(i) + 0.5, 1) +
                ",graph 1 behind fillcolor rgb '#F3F3F3' fillstyle solid noborder\n";
    body += "set xrange [-0.5:" + fixed_text(count - 0.5, 1) + "]\nset yrange [0:103]\n";
    body += "set ytics 0,20,100 nomirror out scale 0.6\nset xtics nomirror out scale 0 (";
    for (std::size_t i = 0; i < sigmas.size(); ++i)
        body += std::string(i ? ", " : "") + "\"" + fixed_text(sigmas[i] * sigmas[i], 2) + "\\n{/=9 (σ " +
                fixed_text(sigmas[i], 1) + ")}\" " + std::to_string(i);
    body += ")\nset border 3 linewidth 0.8 linecolor rgb '#333333'\n";
    body += "set grid ytics linetype 1 linewidth 0.4 linecolor rgb '#DDDDDD'\n";
    body += "set xlabel \"Buffer reduction σ²  (full-resolution pixels per shaded sample)\" offset 0,-0.9\n";
    body += "set ylabel \"{/:Italic P}_I: answered “identical” (% of trials)\"\n";
    const double criterion = 100.0 * study.identical_criterion;
    body += "set label 1 \"" + general_text(criterion, 4) + " %\" at graph 1.008,first " +
            fixed_text(criterion, 2) + " left font ',10' textcolor rgb '#333333'\n";
    // The key has its own line between the title and the plot.
    body +=
        "set key at graph 0,graph 1.035 left bottom horizontal Left reverse samplen 1.4 width 0.6 maxrows "
        "1\n";
    body += "set bars 0.45\nset lmargin 8.5\nset rmargin 6\nset tmargin " +
            std::string(study.data_origin.empty() ? "5.2" : "6.4") + "\nset bmargin 4.9\n";
    body += "plot " + fixed_text(criterion, 4) +
            " with lines dashtype (8,5) linewidth 1.1 linecolor rgb '#333333' notitle";
    for (std::size_t j = 0; j < alphas.size(); ++j) {
        const FigureStyle style = series_style(j);
        body += ", $series" + std::to_string(j) +
                " using 1:2:3:4 with yerrorbars linetype 1 linewidth 1.1 linecolor rgb '" + style.colour +
                "' pointtype " + std::to_string(style.point) +
                " pointsize 0.9 title \"α = " + short_text(alphas[j]) + "\"";
    }
    const double width = std::clamp(2.6 + 2.05 * count, 12.0, 27.0);
    return figure_script(stem, {width, 10.0}, body);
}

std::string condition_figure_description(const std::vector<ConditionRow>& rows,
                                         const StudyDescription& study) {
    const std::vector<double> sigmas = distinct(rows, &ConditionRow::sigma);
    std::string text =
        "Share of trials answered identical, in percent, against sigma squared, with one standard error";
    if (!study.data_origin.empty()) text += " (data: " + study.data_origin + ")";
    text += ".";
    for (double sigma : sigmas) {
        text += " Sigma squared " + fixed_text(sigma * sigma, 2) + ":";
        bool first = true;
        for (const ConditionRow& row : rows) {
            if (row.sigma != sigma || !row.identical.p) continue;
            text += std::string(first ? "" : ",") + " alpha " + short_text(row.alpha) + " " +
                    fixed_text(100.0 * *row.identical.p, 0);
            first = false;
        }
        text += ".";
    }
    text += " A dashed line marks the criterion of " + general_text(100.0 * study.identical_criterion, 4) +
            " percent.";
    return text;
}

}  // namespace parafovea
