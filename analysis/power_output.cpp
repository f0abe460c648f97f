// Reads what a power simulation assumes and writes what it found.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"
#include "analysis/power.h"
#include "analysis/text_file.h"

namespace parafovea {

PowerAssumptions read_power_assumptions(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error(path.string() +
                                 ": cannot be opened; expected a psychometric.csv written by analyze");
    PowerAssumptions assumptions;
    std::vector<std::string> head;
    std::string line;
    double lapse = 0.0, guess = 0.0;
    for (int number = 1; std::getline(file, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        std::vector<std::string> fields;
        std::istringstream stream(line);
        for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
        if (head.empty()) {
            head = fields;
            continue;
        }
        const auto field = [&](const char* name) -> const std::string& {
            for (std::size_t i = 0; i < head.size() && i < fields.size(); ++i)
                if (head[i] == name) return fields[i];
            throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": no column '" + name +
                                     "'; expected a psychometric.csv written by analyze");
        };
        const auto value = [&](const char* name) {
            const std::string& text = field(name);
            double result = 0.0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
            if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(result))
                throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": '" + name +
                                         "' is '" + text + "'; expected a number");
            return result;
        };
        if (field("participant") != "all" || field("sigmoid") != "logistic") continue;
        assumptions.functions.push_back({value("alpha"), value("threshold"), value("width")});
        lapse += value("lambda");
        guess += value("gamma");
    }
    if (assumptions.functions.empty())
        throw std::runtime_error(path.string() +
                                 ": no row of all participants with the logistic function; expected a "
                                 "psychometric.csv written by analyze");
    assumptions.lapse_rate = lapse / static_cast<double>(assumptions.functions.size());
    assumptions.guess_rate = guess / static_cast<double>(assumptions.functions.size());
    return assumptions;
}

std::string power_csv(const std::vector<PowerPoint>& points) {
    std::string csv =
        "participants,sessions,effect,studies,sigma,power_cochran,power_permutation,se_permutation,undefined,"
        "any_holm,wilson_width,"
        "clustered_width,decided_share\n";
    for (const PowerPoint& point : points) {
        for (const SigmaPower& sigma : point.sigmas) {
            double decided = 0.0;
            for (const auto& [value, share] : point.decided_sigma)
                if (value == sigma.sigma) decided = share;
            csv += std::to_string(point.participants) + "," + std::to_string(point.sessions) + "," +
                   short_text(point.effect) + "," + std::to_string(point.studies) + "," +
                   short_text(sigma.sigma);
            for (double value :
                 {sigma.cochran, sigma.permutation, monte_carlo_error(sigma.permutation, point.studies),
                  sigma.undefined, point.any_holm, point.wilson_width, point.clustered_width, decided})
                csv += "," + general_text(value, 6);
            csv += "\n";
        }
    }
    return csv;
}

std::string power_markdown(const std::vector<PowerPoint>& points, const PowerQuestion& question) {
    const PowerAssumptions& assumed = question.assumptions;
    std::string text =
        "# Power of the planned study\n\nSimulated participants with assumed psychometric functions; every "
        "share comes from " +
        std::to_string(question.studies) + " simulated studies (Monte-Carlo standard error at most " +
        fixed_text(50.0 / std::sqrt(static_cast<double>(question.studies)), 1) +
        " points). Test: permutation within participants (" + std::to_string(question.permutations) +
        " permutations) at " + general_text(question.level, 3) + ".\n\nAssumed:";
    for (const AssumedFunction& function : assumed.functions)
        text += " alpha " + short_text(function.alpha) + ": half way at sigma^2 " +
                fixed_text(function.threshold, 2) + ", width " + fixed_text(function.width, 2) + ";";
    text += " lapse rate " + fixed_text(assumed.lapse_rate, 3) + ", guess rate " +
            fixed_text(assumed.guess_rate, 3) + "; SD between people " +
            fixed_text(assumed.participant_sd, 2) + " logit, by condition " +
            fixed_text(assumed.condition_sd, 2) + " logit.\n\n";
    if (points.empty()) return text;
    text += "| participants | sessions | effect |";
    for (const SigmaPower& sigma : points[0].sigmas) text += " sigma " + short_text(sigma.sigma) + " |";
    text += " any sigma (Holm) | Wilson width | clustered width |\n|---:|---:|---:|";
    for (std::size_t i = 0; i < points[0].sigmas.size() + 3; ++i) text += "---:|";
    text += "\n";
    for (const PowerPoint& point : points) {
        text += "| " + std::to_string(point.participants) + " | " + std::to_string(point.sessions) + " | " +
                short_text(point.effect) + " |";
        for (const SigmaPower& sigma : point.sigmas) text += " " + fixed_text(sigma.permutation, 3) + " |";
        text += " " + fixed_text(point.any_holm, 3) + " | " + fixed_text(point.wilson_width, 3) + " | " +
                fixed_text(point.clustered_width, 3) + " |\n";
    }
    return text;
}

std::vector<std::filesystem::path> write_power(const std::vector<PowerPoint>& points,
                                               const PowerQuestion& question,
                                               const std::filesystem::path& out) {
    make_output_folder(out);
    write_text_file(out / "power.csv", power_csv(points));
    write_text_file(out / "power.md", power_markdown(points, question));
    std::vector<std::filesystem::path> files{out / "power.csv", out / "power.md"};
    if (points.empty() || points[0].sigmas.empty()) return files;

    // One curve per sigma for the first number of sessions and the effect nearest to the assumed one, with
    // Monte-Carlo error bars.
    double effect = points[0].effect;
    for (const PowerPoint& point : points)
        if (std::abs(point.effect - 1.0) < std::abs(effect - 1.0)) effect = point.effect;
    std::string body;
    double most = 0.0;
    for (std::size_t s = 0; s < points[0].sigmas.size(); ++s) {
        body += "$sigma" + std::to_string(s) + " << EOD\n";
        for (const PowerPoint& point : points) {
            if (point.sessions != points[0].sessions || point.effect != effect) continue;
            most = std::max(most, static_cast<double>(point.participants));
            const double power = 100.0 * point.sigmas[s].permutation;
            body += std::to_string(point.participants) + " " + fixed_text(power, 3) + " " +
                    fixed_text(100.0 * monte_carlo_error(point.sigmas[s].permutation, point.studies), 3) +
                    "\n";
        }
        body += "EOD\n";
    }
    body += "set title \"{/:Bold Power with simulated participants}\\n" + std::to_string(points[0].sessions) +
            " sessions each, effect " + short_text(effect) + ", " + std::to_string(question.studies) +
            " studies per point; bars: Monte-Carlo standard error\" left offset graph -0.5,character 0.2\n";
    body +=
        "set border 3 linewidth 0.8 linecolor rgb '#333333'\nset tics nomirror out scale 0.5\nset yrange "
        "[0:100]\nset xrange [0:" +
        fixed_text(1.08 * most, 2) + "]\nset grid ytics linetype 1 linewidth 0.4 linecolor rgb '#DDDDDD'\n";
    body += "set xlabel \"participants\"\nset ylabel \"power: p within participants ≤ " +
            general_text(question.level, 3) + " (%)\"\n";
    body +=
        "set key outside right center Left reverse samplen 2\nset tmargin 4\nplot 80 with lines dashtype "
        "(8,5) linewidth 0.9 linecolor rgb '#333333' notitle";
    for (std::size_t s = 0; s < points[0].sigmas.size(); ++s) {
        const FigureStyle style = series_style(s);
        body += ", $sigma" + std::to_string(s) +
                " using 1:2:3 with yerrorlines linetype 1 linewidth 1.3 linecolor rgb '" + style.colour +
                "' pointtype " + std::to_string(style.point) +
                " pointsize 0.8 title \"σ = " + short_text(points[0].sigmas[s].sigma) + "\"";
    }
    run_gnuplot(figure_script(out / "power", {16.0, 9.0}, body));
    for (const auto& file : figure_files(out / "power")) files.push_back(file);
    return files;
}

}  // namespace parafovea
