// Speed of the analysis: exact Q, a whole study to all outputs, a million trials, a power curve of ten
// thousand studies.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "analysis/cochran_q.h"
#include "analysis/power.h"
#include "analysis/random_draw.h"
#include "analysis/write_analysis.h"

namespace parafovea {
namespace {

Response random_response(std::mt19937_64& generator, int participant, int session, double sigma,
                         double alpha) {
    Response response;
    response.participant = "P" + std::to_string(participant);
    response.session = session;
    response.sigma = sigma;
    response.alpha = alpha;
    response.identical =
        draw_unit(generator) > 1.0 / (1.0 + std::exp(1.3 * (2.3 + 0.55 * alpha - sigma * sigma)));
    response.response_time_s = 0.4 + draw_unit(generator);
    response.foveated_first = draw_below(generator, 2) == 0;
    return response;
}

template <typename Use>
void each_trial(int participants, int sessions, int repetitions, Use&& use) {
    std::mt19937_64 generator(5);
    for (int p = 0; p < participants; ++p)
        for (int s = 1; s <= sessions; ++s)
            for (int r = 0; r < repetitions; ++r)
                for (int i = 0; i < 7; ++i)
                    for (int a = 1; a <= 4; ++a) use(random_response(generator, p, s, 1.2 + 0.2 * i, a));
}

std::filesystem::path scratch_folder() {
    return std::filesystem::temp_directory_path() / ("parafovea_benchmark_" + std::to_string(getpid()));
}

void exact_q(benchmark::State& state) {
    std::mt19937_64 generator(3);
    BinaryTable table{4, {}};
    for (int i = 0; i < 54 * 4; ++i)
        table.values.push_back(static_cast<std::uint8_t>(draw_below(generator, 2)));
    for (auto _ : state) benchmark::DoNotOptimize(cochran_q(table).p_exact);
}
BENCHMARK(exact_q)->Name("exact_q_54_by_4")->Unit(benchmark::kMicrosecond);

void study_to_all_outputs(benchmark::State& state) {
    std::vector<Response> responses;
    each_trial(18, 2, 1, [&](const Response& response) { responses.push_back(response); });
    for (auto _ : state)
        benchmark::DoNotOptimize(write_analysis(responses, {}, scratch_folder()).written.size());
    std::filesystem::remove_all(scratch_folder());
}
BENCHMARK(study_to_all_outputs)
    ->Name("18_participants_to_all_outputs")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void million_trials(benchmark::State& state) {
    StudyTally tally;
    each_trial(446, 4, 20, [&](const Response& response) { tally.add(response); });
    for (auto _ : state)
        benchmark::DoNotOptimize(write_analysis(tally, {}, {}, scratch_folder()).written.size());
    std::filesystem::remove_all(scratch_folder());
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    state.counters["trials"] = static_cast<double>(tally.with_exclusions().counted());
    state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}
BENCHMARK(million_trials)->Name("million_trials_after_reading")->Unit(benchmark::kMillisecond)->UseRealTime();

void power_curve(benchmark::State& state) {
    PowerQuestion question;
    for (int i = 0; i < 7; ++i)
        for (int a = 1; a <= 4; ++a) question.plan.push_back({{1.2 + 0.2 * i, static_cast<double>(a)}, 1});
    for (int a = 1; a <= 4; ++a)
        question.assumptions.functions.push_back({static_cast<double>(a), 2.4 + 0.7 * a, 4.5});
    question.participants = {6, 12, 18, 24, 36};
    question.studies = 2000;
    for (auto _ : state) benchmark::DoNotOptimize(simulate_power(question).size());
}
BENCHMARK(power_curve)
    ->Name("power_curve_of_10000_studies")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1);

}  // namespace
}  // namespace parafovea
