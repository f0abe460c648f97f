// report.html: what the study found, in words, figures and tables, with what a reviewer asks for.
#include "analysis/report.h"

#include <algorithm>
#include <cmath>

#include "analysis/html_text.h"
#include "analysis/number_text.h"
#include "analysis/report_page.h"

namespace parafovea {
namespace {

constexpr const char* kDash = "\xE2\x80\x93";

using Rows = std::vector<std::vector<std::string>>;

std::string percent(const std::optional<double>& share, int digits = 1) {
    return share ? fixed_text(100.0 * *share, digits) : kDash;
}

std::string percent_range(const std::optional<Interval>& interval) {
    return interval ? percent(interval->low) + " to " + percent(interval->high) : kDash;
}

std::string number(const std::optional<double>& value, int digits) {
    return value ? fixed_text(*value, digits) : kDash;
}

std::string html_figure(const StudyResults& results, const std::string& name, const std::string& caption) {
    for (const auto& [figure, svg] : results.figures)
        if (figure == name)
            return "<figure>" + svg + "<figcaption>" + html_escaped(caption) + "</figcaption></figure>\n";
    return {};
}

std::string folded(const std::string& summary, const std::string& html, bool open = false) {
    return std::string("<details") + (open ? " open" : "") + "><summary>" + html_escaped(summary) +
           "</summary>\n" + html + "</details>\n";
}

std::string data_note(const StudyDescription& study) {
    return study.data_origin.empty() ? "" : " Data: " + study.data_origin + ".";
}

ReportSection results_section(const StudyResults& results) {
    std::string html = html_paragraph(decision_text(results.decision));
    std::string significant, within;
    for (const CochranRow& row : results.cochran.rows) {
        if (row.q.p_chi2 && *row.q.p_chi2 < 0.05)
            significant += (significant.empty() ? "" : ", ") + short_text(row.sigma);
        if (row.permutation.p && *row.permutation.p < 0.05)
            within += (within.empty() ? "" : ", ") + short_text(row.sigma);
    }
    html += html_paragraph(
        (significant.empty()
             ? "Cochran's Q finds no σ at which P_I differs between the values of α at p < 0.05."
             : "Cochran's Q finds P_I to differ between the values of α (p < 0.05) at σ = " + significant +
                   ".") +
        (within.empty() ? " With whole participants as units none is significant."
                        : " With whole participants as units this holds at σ = " + within + "."));
    if (results.decision.highest_sigma.size() > 1) {
        Rows rows{{"Highest accepted σ", "Share of resamples %"}};
        for (const SigmaShare& share : results.decision.highest_sigma)
            rows.push_back({share.sigma ? short_text(*share.sigma) : "none", percent(share.share)});
        html += folded("How often each σ would be the highest accepted one",
                       html_table("Highest accepted σ when participants are drawn anew.", rows));
    }
    return {"results", "Results in brief", html};
}

ReportSection warnings_section(const StudyResults& results) {
    std::string html;
    if (results.warnings.empty()) html = html_paragraph("None of the automatic checks found anything.");
    for (const ReportWarning& warning : results.warnings)
        html += "<div class=\"warning\"><strong>" + html_escaped(warning.subject) + ".</strong> " +
                html_escaped(warning.text) + "</div>\n";
    return {"warnings", "What to be careful about", html};
}

ReportSection figure_section(const StudyDescription& study, const StudyResults& results) {
    std::string html = html_figure(
        results, study.is_pilot ? "figure9" : "figure10",
        std::string("Figure ") + (study.is_pilot ? "9" : "10") +
            ". P_I, the share of trials in which the foveated and the full-resolution picture were called "
            "identical, against σ², one series per α; error bars are one standard error over trials." +
            data_note(study));
    Rows rows{{"σ", "σ²", "α", "n", "identical", "P_I %", "SE", "clustered SE", "Wilson 95 %",
               "Clopper-Pearson 95 %"}};
    for (const ConditionRow& row : results.conditions)
        rows.push_back({short_text(row.sigma), fixed_text(row.sigma * row.sigma, 2), short_text(row.alpha),
                        std::to_string(row.identical.n), std::to_string(row.identical.successes),
                        percent(row.identical.p), percent(row.identical.standard_error),
                        percent(row.clustered_se), percent_range(row.identical.wilson),
                        percent_range(row.identical.clopper_pearson)});
    html += folded("The numbers behind the figure",
                   html_table("P_I per condition. SE: over trials, as in the paper. Clustered SE: with whole "
                              "participants as units.",
                              rows),
                   true);
    return {"conditions", "P_I per condition", html};
}

ReportSection cochran_section(const StudyResults& results) {
    Rows rows{{"σ", "σ²", "informative blocks", "Q", "df", "critical Q", "p χ²", "p exact", "mid-p",
               "p within participants", "η² = W", "Berry R", "Q, participants as blocks", "its exact p"}};
    for (const CochranRow& row : results.cochran.rows) {
        EffectSize effect;
        for (const SigmaEffects& sigma : results.effects)
            if (sigma.sigma == row.sigma) effect = sigma.effect;
        rows.push_back({short_text(row.sigma), fixed_text(row.sigma * row.sigma, 2),
                        std::to_string(row.q.informative_rows) + " of " + std::to_string(row.q.rows),
                        row.q.q ? fixed_text(*row.q.q, 2) : "n/a", std::to_string(row.q.df),
                        fixed_text(chi_square_critical_value(row.q.df, 0.05), 2),
                        p_text(row.q.p_chi2, row.q.log10_p), p_text(row.q.p_exact), p_text(row.q.p_mid),
                        p_text(row.permutation.p), number(effect.eta2_q, 3), number(effect.berry_r, 3),
                        row.by_participant.q ? fixed_text(*row.by_participant.q, 2) : "n/a",
                        p_text(row.by_participant.p_exact)});
    }
    std::string html = html_table("Table 1. Cochran's Q across α for every σ.", rows);
    html += html_paragraph(
        block_statement(results.cochran) +
        " With participants as blocks, a participant counts as identical when more than half of the "
        "condition's trials were answered so; ties count as different. “n/a”: no block tells the conditions "
        "apart, so Q is undefined and the exact p is 1. The p within participants shuffles the condition "
        "labels of "
        "whole participants and is the one to trust when people differ in which condition they notice. η² "
        "counts "
        "every block, uniform ones too, and equals Kendall's W.");
    Rows pairs{{"σ", "α pair", "first only", "second only", "p exact", "mid-p", "Holm exact", "Holm mid-p",
                "difference (95 %)"}};
    for (const SigmaEffects& sigma : results.effects)
        for (const PairwiseRow& row : sigma.pairs)
            pairs.push_back(
                {short_text(sigma.sigma),
                 short_text(sigma.alphas[row.first]) + " and " + short_text(sigma.alphas[row.second]),
                 std::to_string(row.counts.first_only), std::to_string(row.counts.second_only),
                 p_text(row.test.p_exact), p_text(row.test.p_mid), p_text(row.holm_exact),
                 p_text(row.holm_mid),
                 row.difference
                     ? percent(row.difference->difference) + " [" + percent(row.difference->interval.low) +
                           ", " + percent(row.difference->interval.high) + "]"
                     : kDash});
    html += folded(
        "Pairs of α",
        html_table("McNemar's test of every pair of α, adjusted within each σ after Holm; the difference of "
                   "P_I in points with Newcombe's interval for pairs. Not gated on Q.",
                   pairs));
    return {"cochran", "Table 1: differences between α", html};
}

ReportSection psychometric_section(const StudyDescription& study, const StudyResults& results) {
    const PsychometricResults& fits = results.psychometric;
    const std::string criterion = general_text(100.0 * study.identical_criterion, 4) + " % identical";
    std::string html = html_figure(
        results, "psychometric",
        "Answers “different” against σ² with the fitted logistic function, one panel per α. The dashed line "
        "is the "
        "criterion; the bar on it is the 95 % interval of the threshold, over participants drawn anew (of "
        "one participant: "
        "credible). Error bars: Wilson 95 %." +
            data_note(study));
    Rows rows{{"α", "function", "σ² at " + criterion, "95 % over people", "95 % credible", "σ there",
               "threshold (half way)", "width", "lapse rate", "guess rate", "overdispersion η",
               "−log posterior"}};
    for (const auto* list : {&fits.pooled, &fits.other_sigmoids}) {
        for (const StudyFit& fit : *list) {
            const CriterionThreshold& at = fit.fit.at_criterion;
            const auto ends = [](const CriterionThreshold& threshold) {
                return (threshold.low ? fixed_text(*threshold.low, 2) : "below") + " to " +
                       (threshold.high ? fixed_text(*threshold.high, 2) : "above");
            };
            const Sigmoid sigmoid = fit.fit.model.sigmoid;
            const PsychometricParameters& best = fit.fit.best;
            rows.push_back({short_text(fit.alpha),
                            sigmoid == Sigmoid::logistic ? "logistic"
                            : sigmoid == Sigmoid::normal ? "normal"
                                                         : "Weibull",
                            number(at.value, 2), fit.over_people ? ends(*fit.over_people) : kDash, ends(at),
                            at.value && *at.value >= 0.0 ? fixed_text(std::sqrt(*at.value), 2) : kDash,
                            fixed_text(best.threshold, 2), fixed_text(best.width, 2),
                            fixed_text(best.lambda, 3), fixed_text(best.gamma, 3), fixed_text(best.eta, 3),
                            fixed_text(fit.fit.negative_log_posterior, 2)});
        }
    }
    html += html_table(
        "Fits to all participants together. Over people: had other participants been drawn; this is the "
        "interval "
        "to report of a group. Credible: for answers like these from these very people. The width of the "
        "Weibull is in units of ln σ².",
        rows);
    html += html_figure(
        results, "participants",
        "The same for every participant; curves with few trials lean on the priors." + data_note(study));
    if (!fits.individual.empty()) {
        // What is typical of people is in the spread of their thresholds, not in the pooled curve.
        Rows people{{"α", "participants with a threshold", "lowest σ²", "median σ²", "highest σ²"}};
        for (const StudyFit& pooled : fits.pooled) {
            std::vector<double> thresholds;
            std::size_t all = 0;
            for (const StudyFit& fit : fits.individual) {
                if (fit.alpha != pooled.alpha) continue;
                ++all;
                if (fit.fit.at_criterion.value) thresholds.push_back(*fit.fit.at_criterion.value);
            }
            std::sort(thresholds.begin(), thresholds.end());
            const std::string share = std::to_string(thresholds.size()) + " of " + std::to_string(all);
            if (thresholds.empty()) {
                people.push_back({short_text(pooled.alpha), share, kDash, kDash, kDash});
            } else {
                const std::size_t n = thresholds.size();
                people.push_back({short_text(pooled.alpha), share, fixed_text(thresholds.front(), 2),
                                  fixed_text(0.5 * (thresholds[(n - 1) / 2] + thresholds[n / 2]), 2),
                                  fixed_text(thresholds.back(), 2)});
            }
        }
        html += html_table("σ² at " + criterion + " from each participant's own fit.", people);
    }
    if (fits.individuals_left_out)
        html += html_paragraph("Participants are too many to be fitted one by one here.");
    return {"psychometric", "Psychometric functions", html};
}

ReportSection sensitivity_section(const StudyResults& results) {
    Rows rows{{"σ", "α", "“different” to foveated %", "“different” to identical %", "d′ differencing",
               "d′ independent observation", "z(H) − z(F)", "criterion"}};
    for (const SensitivityRow& row : results.sensitivity)
        rows.push_back({short_text(row.condition.sigma), short_text(row.condition.alpha),
                        percent(row.rates.hit), percent(row.rates.false_alarm),
                        fixed_text(row.d_differencing, 2), fixed_text(row.d_independent, 2),
                        fixed_text(row.d_yes_no, 2), fixed_text(row.criterion, 2)});
    std::string html = html_table(
        "Signal detection with the validation pairs as false alarms (log-linear correction, all participants "
        "together). A "
        "positive criterion is a leaning to “identical”.",
        rows);
    Rows people{{"participant", "foveated trials", "identical trials", "“different” to foveated %",
                 "“different” to identical %", "d′ differencing", "z(H) − z(F)", "criterion"}};
    for (const ParticipantSensitivity& row : results.participant_sensitivity)
        people.push_back({row.participant, std::to_string(row.different_trials),
                          std::to_string(row.same_trials), percent(row.rates.hit),
                          percent(row.rates.false_alarm), fixed_text(row.d_differencing, 2),
                          fixed_text(row.d_yes_no, 2), fixed_text(row.criterion, 2)});
    if (people.size() > 1)
        html += folded(
            "Every participant",
            html_table(
                "The same for every participant over all conditions, each with their own false alarms. "
                "Comparable between participants who saw the same conditions.",
                people),
            people.size() <= 41);
    return {"sensitivity", "Sensitivity and bias", html};
}

ReportSection validation_section(const StudyResults& results) {
    Rows rows{
        {"participant", "trials", "right", "pass rate %", "P(guesser as high)", "P(95 % attentive as low)"}};
    for (const ValidationRow& row : results.validation)
        rows.push_back({row.participant, std::to_string(row.trials), std::to_string(row.right),
                        percent(static_cast<double>(row.right) / static_cast<double>(row.trials)),
                        p_text(row.p_guesser), p_text(row.p_attentive)});
    return {
        "validation", "Validation trials",
        folded("Every participant", html_table("Pairs of identical pictures: right is “identical”.", rows),
               rows.size() <= 40)};
}

ReportSection times_section(const StudyResults& results) {
    Rows rows{{"σ", "α", "n", "median s", "quartiles s", "mean s"}};
    for (const ResponseTimeRow& row : results.response_times)
        rows.push_back({short_text(row.condition.sigma), short_text(row.condition.alpha),
                        std::to_string(row.n), fixed_text(row.median_s, 2),
                        fixed_text(row.lower_quartile_s, 2) + " to " + fixed_text(row.upper_quartile_s, 2),
                        fixed_text(row.mean_s, 2)});
    return {"times", "Response times",
            folded("Every condition", html_table("Time from the question to the answer.", rows))};
}

ReportSection exclusions_section(const StudyDescription& study, const Tally& tally,
                                 const StudyResults& results) {
    std::string html = html_paragraph(
        (study.exclusion_rules.empty() ? "The exclusion rules are not stored with the study."
                                       : "Rules stored before the first session: " + study.exclusion_rules) +
        (study.exclusion_rules_hash.empty() ? "" : " (hash " + study.exclusion_rules_hash + ")"));
    Rows reasons{{"reason", "trials"}};
    for (const auto& [reason, count] : tally.exclusions()) reasons.push_back({reason, std::to_string(count)});
    html += html_table("Excluded trials.", reasons, 1);
    Rows rows{
        {"σ", "α", "n with exclusions", "P_I % with exclusions", "n of all answers", "P_I % of all answers"}};
    for (const ConditionRow& all : results.without_exclusions)
        for (const ConditionRow& kept : results.conditions)
            if (kept.sigma == all.sigma && kept.alpha == all.alpha)
                rows.push_back({short_text(all.sigma), short_text(all.alpha),
                                std::to_string(kept.identical.n), percent(kept.identical.p),
                                std::to_string(all.identical.n), percent(all.identical.p)});
    html += folded("Results with and without exclusions",
                   html_table("P_I with and without the exclusions.", rows), true);
    return {"exclusions", "Exclusions", html};
}

ReportSection recordings_section(const StudyDescription& study, const StudyRecordings& recordings,
                                 const StudyResults& results) {
    std::string html =
        html_figure(results, "gaze",
                    "Where the participants looked while pictures were shown." + data_note(study)) +
        html_figure(results, "timing",
                    "Time from one frame to the next; dashed lines are whole refreshes." + data_note(study));
    Rows rows{{"participant", "session", "accuracy °", "precision °", "gaze loss %", "gaze Hz",
               "gaze age ms (95th)", "frames", "missed"}};
    for (const SessionQuality& session : recordings.sessions)
        rows.push_back({session.participant, std::to_string(session.session), number(session.accuracy_deg, 2),
                        number(session.precision_deg, 3), percent(session.gaze_loss),
                        number(session.gaze_hz, 1), number(session.gaze_age_ms, 1),
                        std::to_string(session.frames), std::to_string(session.missed)});
    if (rows.size() > 1)
        html +=
            folded("Every session", html_table("Gaze and timing of every session.", rows), rows.size() <= 40);
    return {"recordings", "Gaze and timing", html};
}

ReportSection methods_section(const Tally& tally, const StudyDescription& study,
                              const StudyResults& results) {
    std::string text = std::to_string(tally.participants().size()) + " participants gave " +
                       std::to_string(tally.counted()) + " answers in " + std::to_string(tally.sessions()) +
                       " sessions under " + std::to_string(results.conditions.size()) + " conditions (" +
                       std::to_string(tally.sigmas().size()) + " values of σ, " +
                       std::to_string(tally.alphas().size()) + " of α)";
    text += tally.validation_trials() > 0 ? ", and " + std::to_string(tally.validation_trials()) +
                                                " answers to validation trials with two identical pictures."
                                          : ".";
    text += " " + std::to_string(tally.excluded()) + " trials were excluded";
    text += tally.excluded() > 0 ? " by rules stored before the first session." : ".";
    text +=
        " P_I, the share of answers “identical”, is reported with its standard error over trials, its "
        "standard error with participants as "
        "clusters, and Wilson (1927) and Clopper-Pearson (1934) 95 % intervals. Differences between the "
        "values of α were tested for every σ "
        "with Cochran's Q (1950); its p value is given from the chi-square distribution, from all "
        "arrangements of the answers within blocks "
        "(Patil 1975), and from permutations of condition labels within whole participants. Pairs of α were "
        "compared with McNemar's exact and "
        "mid-p tests, adjusted after Holm (1979). The probability of “different” was fitted against σ² for "
        "every α with a logistic function "
        "with lapse rate and guess rate" +
        std::string(study.overdispersion ? " and beta-binomial overdispersion" : "") +
        " under the priors of Schütt et al. (2016); thresholds are posterior modes. A participant's "
        "threshold has an "
        "equal-tailed 95 % credible interval" +
        (study.overdispersion ? "" : " for binomial answers") +
        ", that of all together the same interval widened to the spread of 400 resamples of whole "
        "participants and by Student's t. The decision takes the highest σ whose "
        "P_I reaches " +
        general_text(100.0 * study.identical_criterion, 4) + " %, with a bootstrap of " +
        std::to_string(results.decision.resamples) +
        " resamples of whole participants. The level of tests is 0.05.";
    std::string html = html_paragraph(text);
    Rows rows{{"What", "Value"}};
    const auto add = [&](const std::string& label, const std::string& value) {
        if (!value.empty()) rows.push_back({label, value});
    };
    add("Data", study.data_origin.empty() ? "recorded from people" : study.data_origin);
    add("Protocol", study.protocol_name);
    add("Protocol hash", study.protocol_hash);
    add("Program version", study.program_version);
    add("Seed of the analysis", std::to_string(study.analysis_seed));
    if (study.planned_participants > 0)
        add("Planned participants", std::to_string(study.planned_participants));
    for (const auto& [label, value] : study.provenance) add(label, value);
    html += html_table("Where the numbers come from.", rows, 2);
    return {"methods", "Methods and provenance", html};
}

}  // namespace

std::string report_html(const Tally& tally, const StudyDescription& study, const StudyRecordings& recordings,
                        const StudyResults& results) {
    std::vector<ReportSection> sections{results_section(results), warnings_section(results),
                                        figure_section(study, results)};
    if (!results.cochran.rows.empty()) sections.push_back(cochran_section(results));
    if (!results.psychometric.pooled.empty()) sections.push_back(psychometric_section(study, results));
    if (!results.sensitivity.empty()) sections.push_back(sensitivity_section(results));
    if (!results.validation.empty()) sections.push_back(validation_section(results));
    if (!results.response_times.empty()) sections.push_back(times_section(results));
    if (tally.excluded() > 0) sections.push_back(exclusions_section(study, tally, results));
    if (recordings.gaze || recordings.frames || !recordings.sessions.empty())
        sections.push_back(recordings_section(study, recordings, results));
    sections.push_back(methods_section(tally, study, results));
    return html_page(study.title, study.data_origin.empty() ? "" : "Data: " + study.data_origin + ".",
                     sections);
}

}  // namespace parafovea
