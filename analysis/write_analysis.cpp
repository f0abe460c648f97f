// The way in for programs: responses in, every figure, table and report file out.
#include "analysis/write_analysis.h"

#include <future>
#include <stdexcept>
#include <utility>

#include "analysis/condition_figure.h"
#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/parallel.h"
#include "analysis/psychometric_figure.h"
#include "analysis/recording_figures.h"
#include "analysis/report.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

void require_answers(const Tally& tally) {
    if (tally.counted() == 0)
        throw std::runtime_error("there is no response to analyse: " + std::to_string(tally.excluded()) +
                                 " trials excluded and " + std::to_string(tally.validation_trials()) +
                                 " validation trials, none left to count");
}

StudyTally tally_of(std::span<const Response> responses) {
    StudyTally tally;
    for (const Response& response : responses) tally.add(response);
    return tally;
}

struct Figure {
    std::string name;  // of its files
    std::string script;
    std::string description;  // for readers who cannot see it
};

std::vector<Figure> figures_of(const Tally& tally, const StudyDescription& study,
                               const StudyRecordings& recordings, const StudyResults& results,
                               const std::string& main_figure, const std::filesystem::path& out) {
    std::vector<Figure> figures;
    figures.push_back(
        {main_figure,
         condition_figure_script(results.conditions, static_cast<std::int64_t>(tally.participants().size()),
                                 study, out / main_figure),
         condition_figure_description(results.conditions, study)});
    figures.push_back({"psychometric",
                       psychometric_figure_script(results.psychometric, study, out / "psychometric"),
                       psychometric_figure_description(results.psychometric, study)});
    figures.push_back({"participants",
                       participants_figure_script(results.psychometric, study, out / "participants"),
                       "Fitted psychometric functions of every participant, one small panel each; the "
                       "numbers are in psychometric.csv."});
    if (recordings.gaze)
        figures.push_back({"gaze", gaze_figure_script(*recordings.gaze, study, out / "gaze"),
                           "Heat map of gaze direction while pictures were shown."});
    if (recordings.frames)
        figures.push_back({"timing", timing_figure_script(*recordings.frames, study, out / "timing"),
                           "Histogram of the time from one frame to the next."});
    std::erase_if(figures, [](const Figure& figure) { return figure.script.empty(); });
    return figures;
}

// File names and texts.
std::vector<std::pair<std::string, std::string>> tables_of(const StudyDescription& study,
                                                           const StudyRecordings& recordings,
                                                           const StudyResults& results,
                                                           const std::string& main_figure) {
    std::vector<std::pair<std::string, std::string>> tables{
        {main_figure + ".csv", condition_csv(results.conditions)},
        {"table1.csv", cochran_csv(results.cochran)},
        {"table1.md", cochran_markdown(results.cochran, study.title, study.data_origin)},
        {"pairwise.csv", pairwise_csv(results.effects)},
        {"psychometric.csv", psychometric_csv(results.psychometric)}};
    if (!results.sensitivity.empty())
        tables.emplace_back("sensitivity.csv", sensitivity_csv(results.sensitivity));
    if (!results.participant_sensitivity.empty())
        tables.emplace_back("sensitivity_participants.csv",
                            participant_sensitivity_csv(results.participant_sensitivity));
    if (!results.validation.empty())
        tables.emplace_back("validation.csv", validation_csv(results.validation));
    if (!results.response_times.empty())
        tables.emplace_back("response_times.csv", response_time_csv(results.response_times));
    if (!results.without_exclusions.empty())
        tables.emplace_back("exclusions.csv", exclusion_csv(results.conditions, results.without_exclusions));
    if (!recordings.sessions.empty()) tables.emplace_back("quality.csv", quality_csv(recordings));
    return tables;
}

}  // namespace

AnalysisFiles write_analysis(const StudyTally& tallies, const StudyDescription& study,
                             const StudyRecordings& recordings, const std::filesystem::path& out) {
    const Tally& tally = tallies.with_exclusions();
    require_answers(tally);
    make_output_folder(out);

    // Start on the figures, which take longest, as soon as their numbers stand.
    StudyResults results;
    results.conditions = condition_rows(tally);
    results.psychometric =
        psychometric_results(tally, study.identical_criterion, study.analysis_seed,
                             study.overdispersion ? Dispersion::fitted : Dispersion::binomial);
    const std::string main_figure = study.is_pilot ? "figure9" : "figure10";
    const std::vector<Figure> figures = figures_of(tally, study, recordings, results, main_figure, out);
    std::future<void> drawn = std::async(std::launch::async, [&] {
        // Two gnuplots, because the start of one costs as much as a small figure.
        std::string scripts[2];
        for (std::size_t i = 0; i < figures.size(); ++i) scripts[i < 2 ? 0 : 1] += figures[i].script;
        parallel_for(figures.size() > 2 ? 2 : 1, [&](std::size_t i) { run_gnuplot(scripts[i]); });
    });

    // Compute every other result meanwhile.
    results.cochran = cochran_table(tally, study.analysis_seed);
    results.decision =
        decide(tally, study.identical_criterion, study.non_inferiority_margin, 4000, study.analysis_seed);
    results.effects = sigma_effects(tally);
    results.sensitivity = sensitivity_rows(tally, results.conditions);
    results.participant_sensitivity = participant_sensitivity(tally);
    results.validation = validation_rows(tally);
    results.response_times = response_time_rows(tally, results.conditions);
    if (tally.excluded() > 0) results.without_exclusions = condition_rows(tallies.all_answers());
    results.warnings = find_warnings(tally, study, results.conditions, results.cochran, results.validation);

    AnalysisFiles files;
    files.table1 = cochran_text(results.cochran, study.title, study.data_origin);
    const auto write = [&](const std::string& name, const std::string& text) {
        write_text_file(out / name, text);
        files.written.push_back(out / name);
        return out / name;
    };
    for (const auto& [name, text] : tables_of(study, recordings, results, main_figure)) write(name, text);
    files.table = out / "table1.csv";

    // The report holds the figures.
    drawn.get();
    for (const Figure& figure : figures) {
        for (const auto& file : figure_files(out / figure.name)) files.written.push_back(file);
        results.figures.push_back({figure.name, inline_svg(figure_files(out / figure.name).front(),
                                                           figure.name + "_", figure.description)});
    }
    files.figure = figure_files(out / main_figure).front();
    files.report = write("report.html", report_html(tally, study, recordings, results));
    return files;
}

AnalysisFiles write_analysis(std::span<const Response> responses, const StudyDescription& study,
                             const std::filesystem::path& out) {
    return write_analysis(tally_of(responses), study, {}, out);
}

std::string table1_text(std::span<const Response> responses, const StudyDescription& study) {
    const StudyTally tally = tally_of(responses);
    require_answers(tally.with_exclusions());
    return cochran_text(cochran_table(tally.with_exclusions(), study.analysis_seed), study.title,
                        study.data_origin);
}

}  // namespace parafovea
