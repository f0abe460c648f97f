// The way in for programs: responses in, every figure, table and report file out.
#include "analysis/write_analysis.h"

#include <stdexcept>

#include "analysis/cochran_table.h"
#include "analysis/condition_figure.h"
#include "analysis/condition_table.h"
#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/report.h"
#include "analysis/tally.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

Tally tally_of(std::span<const Response> responses) {
    Tally tally;
    for (const Response& response : responses) tally.add(response);
    if (tally.counted() == 0)
        throw std::runtime_error("there is no response to analyse: " + std::to_string(responses.size()) +
                                 " rows, of which " + std::to_string(tally.excluded()) + " excluded and " +
                                 std::to_string(tally.validation_trials()) + " validation trials");
    return tally;
}

}  // namespace

AnalysisFiles write_analysis(std::span<const Response> responses, const StudyDescription& study,
                             const std::filesystem::path& out) {
    const Tally tally = tally_of(responses);
    const std::vector<ConditionRow> conditions = condition_rows(tally);
    const CochranTable cochran = cochran_table(tally, study.analysis_seed);

    make_output_folder(out);
    AnalysisFiles files;
    const auto write = [&](const std::string& name, const std::string& text) {
        write_text_file(out / name, text);
        files.written.push_back(out / name);
        return out / name;
    };

    // Draw the figure and keep its numbers beside it.
    const std::filesystem::path stem = out / (study.is_pilot ? "figure9" : "figure10");
    write(stem.filename().string() + ".csv", condition_csv(conditions));
    run_gnuplot(condition_figure_script(conditions, static_cast<std::int64_t>(tally.participants().size()),
                                        study, stem));
    for (const auto& file : figure_files(stem)) files.written.push_back(file);
    files.figure = figure_files(stem).front();

    // Write the tables and the report that holds them all.
    files.table = write("table1.csv", cochran_csv(cochran));
    write("table1.md", cochran_markdown(cochran, study.title, study.data_origin));
    const std::string svg =
        inline_svg(files.figure, "figure_", condition_figure_description(conditions, study));
    files.report = write("report.html", report_html({tally, study, conditions, cochran, svg}));
    return files;
}

std::string table1_text(std::span<const Response> responses, const StudyDescription& study) {
    return cochran_text(cochran_table(tally_of(responses), study.analysis_seed), study.title,
                        study.data_origin);
}

}  // namespace parafovea
