// parafovea analyze: from session files or a responses CSV to the figure, the table and the report.
#include <cstdio>

#include "analysis/write_analysis.h"
#include "app/commands.h"
#include "app/session_responses.h"

namespace parafovea {

AnalyzeCommand::AnalyzeCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "analyze", "Make Figure 10, Table 1 and a report from session files or a responses CSV");
    command->footer("Example: parafovea analyze demo_study --out results");
    command->add_option("inputs", inputs_, "Session files, folders of them, or a responses CSV")->required();
    command->add_option("--out", out_, "Folder for the results")->required();
    command->add_flag(
        "--overdispersion", overdispersion_,
        "Psychometric fits allow answers to vary more than independent ones do (beta-binomial); credible "
        "intervals are then wider");
    command->callback([this] { run(); });
}

void AnalyzeCommand::run() const {
    analyze_and_print(inputs_, out_, overdispersion_);
}

void analyze_and_print(const std::vector<std::string>& inputs, const std::string& out, bool overdispersion) {
    StudyTally tally;
    StudyData data = read_study(inputs, [&](const Response& response) { tally.add(response); });
    for (const std::string& problem : data.problems) std::fprintf(stderr, "parafovea: %s\n", problem.c_str());
    data.description.overdispersion = overdispersion;
    const AnalysisFiles files = write_analysis(tally, data.description, data.recordings, out);
    std::printf("%s\nfigure  %s\ntable   %s\nreport  %s\n", files.table1.c_str(), files.figure.c_str(),
                files.table.c_str(), files.report.c_str());
}

}  // namespace parafovea
