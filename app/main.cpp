// The program: chooses a subcommand, and turns whatever cannot go on into one line and a non-zero exit.
#include <cstdio>
#include <exception>

#include "app/commands.h"

int main(int argc, char** argv) {
    CLI::App program("Parafovea: how much can a renderer save in the periphery before people see it?",
                     "parafovea");
    program.set_version_flag("--version", PARAFOVEA_VERSION);
    program.require_subcommand(1);

    const parafovea::RunCommand run(program);
    const parafovea::ReplayCommand replay(program);
    const parafovea::SimulateCommand simulate(program);
    const parafovea::AnalyzeCommand analyze(program);
    const parafovea::ExportCommand export_data(program);
    const parafovea::PowerCommand power(program);
    const parafovea::PlanCommand plan(program);
    const parafovea::CheckCommand check(program);
    const parafovea::RenderCommand render(program);
    const parafovea::FoveateCommand foveate(program);
    const parafovea::DevicesCommand devices(program);
    const parafovea::BenchCommand bench(program);
    const parafovea::TradeoffCommand tradeoff(program);
    const parafovea::ScenesCommand scenes(program);
    const parafovea::WithdrawCommand withdraw(program);

    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "parafovea: %s\n", error.what());
        return 1;
    }
    return 0;
}
