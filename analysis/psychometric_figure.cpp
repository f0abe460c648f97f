// Plots of psychometric functions: one panel per alpha for everybody, one per participant.
#include "analysis/psychometric_figure.h"

#include <algorithm>
#include <cmath>

#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

struct XRange {
    double low = 0.0, high = 1.0;
};

XRange x_range(const std::vector<StudyFit>& fits) {
    XRange range{fits.front().fit.levels.front().x, fits.front().fit.levels.back().x};
    for (const StudyFit& fit : fits) {
        range.low = std::min(range.low, fit.fit.levels.front().x);
        range.high = std::max(range.high, fit.fit.levels.back().x);
    }
    const double margin = std::max(0.06 * (range.high - range.low), 0.1);
    return {range.low - margin, range.high + margin};
}

// Points of the fitted function in percent, as a gnuplot data block.
std::string curve_block(const std::string& name, const PsychometricFit& fit, const XRange& range,
                        int points) {
    std::string block = name + " << EOD\n";
    for (int i = 0; i <= points; ++i) {
        const double x = range.low + (range.high - range.low) * i / points;
        if (fit.model.sigmoid == Sigmoid::weibull && x <= 0.0) continue;
        block +=
            fixed_text(x, 4) + " " + fixed_text(100.0 * psychometric_value(fit.model, fit.best, x), 3) + "\n";
    }
    return block + "EOD\n";
}

std::string level_block(const std::string& name, const PsychometricFit& fit) {
    std::string block = name + " << EOD\n";
    for (const PsychometricLevel& level : fit.levels) {
        const Proportion p = proportion(level.different, level.n);
        block += fixed_text(level.x, 4) + " " + fixed_text(100.0 * *p.p, 3) + " " +
                 fixed_text(100.0 * p.wilson->low, 3) + " " + fixed_text(100.0 * p.wilson->high, 3) + "\n";
    }
    return block + "EOD\n";
}

std::string title_text(const std::string& heading, const StudyDescription& study) {
    std::string title = "\"{/:Bold \"." + gnuplot_quoted(heading) + ".\"}\"";
    title += study.data_origin.empty() ? ".\"\\n \""
                                       : ".\"\\nData: \"." + gnuplot_quoted(study.data_origin) + ".\"\\n \"";
    return title;
}

std::string panel_settings(const XRange& range, const StudyDescription& study) {
    const double share = 100.0 * (1.0 - study.identical_criterion);
    return "set border 3 linewidth 0.7 linecolor rgb '#333333'\nset tics nomirror out scale 0.5\nset xrange "
           "[" +
           fixed_text(range.low, 4) + ":" + fixed_text(range.high, 4) +
           "]\nset yrange [0:100]\nset ytics 0,20,100\nset xtics 1\n" +
           "set grid ytics linetype 1 linewidth 0.3 linecolor rgb '#E3E3E3'\n" +
           "criterion_share = " + fixed_text(share, 4) + "\n";
}

}  // namespace

std::string psychometric_figure_script(const PsychometricResults& results, const StudyDescription& study,
                                       const std::filesystem::path& stem) {
    const auto& fits = results.pooled;
    if (fits.empty()) return {};
    const XRange range = x_range(fits);
    const std::size_t columns = fits.size() > 1 ? 2 : 1, rows = (fits.size() + columns - 1) / columns;
    std::string body = panel_settings(range, study);
    body += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + " title " +
            title_text("Answers “different” against σ², all participants", study) + " offset 0,-0.3\n";
    body += "unset key\nset lmargin 8\nset rmargin 2\nset bmargin 3.4\nset tmargin 2.2\n";
    for (std::size_t i = 0; i < fits.size(); ++i) {
        const PsychometricFit& fit = fits[i].fit;
        const std::string id = std::to_string(i);
        body += curve_block("$curve" + id, fit, range, 120) + level_block("$level" + id, fit);
        const CriterionThreshold& at = fits[i].reported();
        std::string note = "α = " + short_text(fits[i].alpha);
        body += "unset arrow\nunset label\n";
        if (at.value && *at.value > range.low && *at.value < range.high) {
            note += ":  σ² = " + fixed_text(*at.value, 2);
            note += "  [" + (at.low ? fixed_text(*at.low, 2) : "below") + ", " +
                    (at.high ? fixed_text(*at.high, 2) : "above") + "]";
            const double low = std::max(at.low.value_or(range.low), range.low),
                         high = std::min(at.high.value_or(range.high), range.high);
            body += "set arrow 1 from " + fixed_text(low, 4) + ",criterion_share to " + fixed_text(high, 4) +
                    ",criterion_share nohead front linewidth 4 linecolor rgb '#BB" +
                    (std::string(series_style(i).colour).substr(1)) + "'\n";
            body += "set arrow 2 from " + fixed_text(*at.value, 4) + ",0 to " + fixed_text(*at.value, 4) +
                    ",criterion_share nohead dashtype (4,4) linewidth 1 linecolor rgb '#333333'\n";
        } else {
            const double share = 1.0 - study.identical_criterion;
            const bool above = psychometric_value(fit.model, fit.best, range.low) > share;
            note += std::string(above ? ":  more" : ":  fewer") + " than " + general_text(100.0 * share, 3) +
                    " % at every σ² shown";
        }
        body += "set title \"" + note + "\" offset 0,-0.5\n";
        body += std::string("set xlabel ") +
                (i + columns >= fits.size() ? "\"Buffer reduction σ²\" offset 0,0.4\n" : "\"\"\n");
        body += std::string("set ylabel ") + (i % columns == 0 ? "\"answered “different” (%)\"\n" : "\"\"\n");
        const FigureStyle style = series_style(i);
        body +=
            "plot criterion_share with lines dashtype (8,5) linewidth 0.9 linecolor rgb '#333333', $curve" +
            id + " using 1:2 with lines linetype 1 linewidth 1.8 linecolor rgb '" + style.colour +
            "', $level" + id + " using 1:2:3:4 with yerrorbars linetype 1 linewidth 1 linecolor rgb '" +
            style.colour + "' pointtype " + std::to_string(style.point) + " pointsize 0.8\n";
    }
    body += "unset multiplot\n";
    return figure_script(stem, {17.0, 1.8 + 6.2 * static_cast<double>(rows)}, body);
}

std::string participants_figure_script(const PsychometricResults& results, const StudyDescription& study,
                                       const std::filesystem::path& stem) {
    if (results.individual.empty()) return {};
    const XRange range = x_range(results.individual);
    const std::size_t people = results.participants.size();
    const std::size_t columns = std::min<std::size_t>(people, 6), rows = (people + columns - 1) / columns;
    std::string body = panel_settings(range, study);
    body += "set ytics 0,50,100\nset xtics 2\nset multiplot layout " + std::to_string(rows) + "," +
            std::to_string(columns) + " title " +
            title_text("Answers “different” (%) against σ², each participant", study) + " offset 0,-0.3\n";
    body +=
        "unset key\nset lmargin 4.5\nset rmargin 1\nset bmargin 1.8\nset tmargin 1.6\nset tics font ',8'\n";
    for (std::size_t person = 0; person < people; ++person) {
        std::string plot =
            "plot criterion_share with lines dashtype (8,5) linewidth 0.6 linecolor rgb '#333333' notitle";
        std::size_t series = 0;
        for (const StudyFit& fit : results.individual) {
            if (fit.participant != person) continue;
            // The series is the alpha's, also where a participant lacks another one.
            series = 0;
            for (const StudyFit& pooled : results.pooled) series += pooled.alpha < fit.alpha ? 1 : 0;
            const std::string id = std::to_string(person) + "_" + std::to_string(series);
            body += curve_block("$c" + id, fit.fit, range, 40) + level_block("$l" + id, fit.fit);
            const FigureStyle style = series_style(series);
            const std::string colour = std::string(" linecolor rgb '") + style.colour + "'";
            plot += ", $c" + id + " using 1:2 with lines linetype 1 linewidth 1.2" + colour +
                    " title \"α = " + short_text(fit.alpha) + "\", $l" + id +
                    " using 1:2 with points linewidth 0.8" + colour + " pointtype " +
                    std::to_string(style.point) + " pointsize 0.4 notitle";
        }
        body += "set title " + gnuplot_quoted(results.participants[person]) + " font ',9' offset 0,-0.8\n";
        body += person == 0 ? "set key top left font ',7' samplen 1 spacing 0.8\n" : "unset key\n";
        body += plot + "\n";
    }
    body += "unset multiplot\n";
    return figure_script(
        stem, {std::max(8.0, 3.6 * static_cast<double>(columns)), 1.6 + 3.1 * static_cast<double>(rows)},
        body);
}

std::string psychometric_figure_description(const PsychometricResults& results,
                                            const StudyDescription& study) {
    std::string text =
        "Fitted psychometric functions: share of answers different against sigma squared, one panel per "
        "alpha";
    if (!study.data_origin.empty()) text += " (data: " + study.data_origin + ")";
    text += ". Sigma squared at which " + general_text(100.0 * study.identical_criterion, 4) +
            " percent are answered identical:";
    for (const StudyFit& fit : results.pooled) {
        const CriterionThreshold& at = fit.reported();
        text += " alpha " + short_text(fit.alpha) + ": " +
                (at.value ? fixed_text(*at.value, 2) : "outside the function");
        if (at.low && at.high)
            text += ", between " + fixed_text(*at.low, 2) + " and " + fixed_text(*at.high, 2);
        text += ".";
    }
    return text;
}

}  // namespace parafovea
