// report.html: what the study found, in words, figures and tables, with what a reviewer asks for.
#include "analysis/report.h"

#include "analysis/html_text.h"
#include "analysis/number_text.h"
#include "analysis/report_page.h"

namespace parafovea {
namespace {

std::string percent(const std::optional<double>& share, int digits = 1) {
    return share ? fixed_text(100.0 * *share, digits) : "\xE2\x80\x93";
}

std::string percent_range(const std::optional<Interval>& interval) {
    return interval ? percent(interval->low) + " to " + percent(interval->high) : "\xE2\x80\x93";
}

std::string setting_text(double sigma, double alpha) {
    return "σ " + short_text(sigma) + " (σ² " + fixed_text(sigma * sigma, 2) + "), α " + short_text(alpha);
}

// The paper's rule: of the settings that reach the criterion, the highest sigma, and there the highest P_I.
const ConditionRow* highest_accepted(const std::vector<ConditionRow>& rows, double criterion) {
    const ConditionRow* best = nullptr;
    for (const ConditionRow& row : rows) {
        if (!row.identical.p || *row.identical.p < criterion) continue;
        if (!best || row.sigma > best->sigma ||
            (row.sigma == best->sigma && *row.identical.p > *best->identical.p))
            best = &row;
    }
    return best;
}

ReportSection results_section(const ReportInputs& in) {
    std::string html;
    const std::string criterion = general_text(100.0 * in.study.identical_criterion, 4) + " %";
    if (const ConditionRow* best = highest_accepted(in.conditions, in.study.identical_criterion))
        html +=
            html_paragraph("The highest σ with a setting that reaches " + criterion + " is " +
                           setting_text(best->sigma, best->alpha) + ": P_I = " + percent(best->identical.p) +
                           " % (95 % Wilson interval " + percent_range(best->identical.wilson) + ").");
    else
        html += html_paragraph("No setting reaches the criterion of " + criterion + ".");
    std::string significant;
    for (const CochranRow& row : in.cochran.rows)
        if (row.q.p_chi2 && *row.q.p_chi2 < 0.05)
            significant += (significant.empty() ? "" : ", ") + short_text(row.sigma);
    html += html_paragraph(
        significant.empty()
            ? "Cochran's Q finds no σ at which P_I differs between the values of α at p < 0.05."
            : "Cochran's Q finds P_I to differ between the values of α (p < 0.05) at σ = " + significant +
                  ".");
    return {"results", "Results in brief", html};
}

ReportSection figure_section(const ReportInputs& in) {
    const char* number = in.study.is_pilot ? "9" : "10";
    std::string html =
        "<figure>" + in.figure_svg + "<figcaption>Figure " + number +
        ". P_I, the share of trials in which the foveated and the full-resolution picture were called "
        "identical, against σ², one series per α; error bars are one standard error over trials.";
    if (!in.study.data_origin.empty()) html += " Data: " + html_escaped(in.study.data_origin) + ".";
    html += "</figcaption></figure>\n";
    std::vector<std::vector<std::string>> rows{{"σ", "σ²", "α", "n", "identical", "P_I %", "SE",
                                                "clustered SE", "Wilson 95 %", "Clopper-Pearson 95 %"}};
    for (const ConditionRow& row : in.conditions)
        rows.push_back({short_text(row.sigma), fixed_text(row.sigma * row.sigma, 2), short_text(row.alpha),
                        std::to_string(row.identical.n), std::to_string(row.identical.successes),
                        percent(row.identical.p), percent(row.identical.standard_error),
                        percent(row.clustered_se), percent_range(row.identical.wilson),
                        percent_range(row.identical.clopper_pearson)});
    html += "<details open><summary>The numbers behind the figure</summary>\n" +
            html_table(
                "P_I per condition. SE: over trials, as the paper's. Clustered SE: with whole participants "
                "as units.",
                rows) +
            "</details>\n";
    return {"conditions", "P_I per condition", html};
}

ReportSection cochran_section(const ReportInputs& in) {
    std::vector<std::vector<std::string>> rows{
        {"σ", "σ²", "informative blocks", "Q", "df", "critical Q", "p χ²", "p exact", "mid-p",
         "p within participants", "Q, participants as blocks", "p exact, participants as blocks"}};
    for (const CochranRow& row : in.cochran.rows)
        rows.push_back({short_text(row.sigma), fixed_text(row.sigma * row.sigma, 2),
                        std::to_string(row.q.informative_rows) + " of " + std::to_string(row.q.rows),
                        row.q.q ? fixed_text(*row.q.q, 2) : "n/a", std::to_string(row.q.df),
                        fixed_text(chi_square_critical_value(row.q.df, 0.05), 2),
                        p_text(row.q.p_chi2, row.q.log10_p), p_text(row.q.p_exact), p_text(row.q.p_mid),
                        p_text(row.permutation.p),
                        row.by_participant.q ? fixed_text(*row.by_participant.q, 2) : "n/a",
                        p_text(row.by_participant.p_exact)});
    std::string html = html_table("Table 1. Cochran's Q across α for every σ.", rows);
    html += html_paragraph(
        block_statement(in.cochran) +
        " With participants as blocks, a participant counts as identical when more than half of the "
        "condition's trials were answered so; ties count as different. “n/a”: no block tells the conditions "
        "apart, so Q is undefined and the exact p is 1. The p within participants shuffles the condition "
        "labels of "
        "whole participants and is the one to trust when people differ in which condition they notice.");
    return {"cochran", "Table 1: differences between α", html};
}

ReportSection methods_section(const ReportInputs& in) {
    const Tally& tally = in.tally;
    std::string text = std::to_string(tally.participants().size()) + " participants gave " +
                       std::to_string(tally.counted()) + " answers in " + std::to_string(tally.sessions()) +
                       " sessions under " + std::to_string(in.conditions.size()) + " conditions (" +
                       std::to_string(tally.sigmas().size()) + " values of σ, " +
                       std::to_string(tally.alphas().size()) + " of α)";
    text += tally.validation_trials() > 0 ? ", and " + std::to_string(tally.validation_trials()) +
                                                " answers to validation trials with two identical pictures."
                                          : ".";
    text += " " + std::to_string(tally.excluded()) + " trials were excluded";
    if (tally.excluded() > 0) {
        text += " (";
        bool first = true;
        for (const auto& [reason, count] : tally.exclusions()) {
            text += std::string(first ? "" : ", ") + reason + ": " + std::to_string(count);
            first = false;
        }
        text += ")";
    }
    text +=
        ". P_I is reported with its standard error over trials, its standard error with participants as "
        "clusters, and Wilson "
        "and Clopper-Pearson 95 % intervals. Differences between the values of α were tested for every σ "
        "with Cochran's Q; its "
        "p value is given from the chi-square distribution, from all arrangements of the answers within "
        "blocks (exact), and from "
        "permutations of condition labels within whole participants. The level is 0.05.";
    std::string html = html_paragraph(text);
    std::vector<std::vector<std::string>> rows{{"What", "Value"}};
    const auto add = [&](const std::string& label, const std::string& value) {
        if (!value.empty()) rows.push_back({label, value});
    };
    add("Data", in.study.data_origin.empty() ? "recorded from people" : in.study.data_origin);
    add("Protocol", in.study.protocol_name);
    add("Protocol hash", in.study.protocol_hash);
    add("Program version", in.study.program_version);
    add("Seed of the analysis", std::to_string(in.study.analysis_seed));
    for (const auto& [label, value] : in.study.provenance) add(label, value);
    html += html_table("Where the numbers come from.", rows, 2);
    return {"methods", "Methods and provenance", html};
}

}  // namespace

std::string report_html(const ReportInputs& in) {
    const std::string banner = in.study.data_origin.empty() ? "" : "Data: " + in.study.data_origin + ".";
    return html_page(in.study.title, banner,
                     {results_section(in), figure_section(in), cochran_section(in), methods_section(in)});
}

}  // namespace parafovea
