// The figures of gaze and timing drawn from known recordings, and those of power and of psychometric
// functions.
#include "analysis/recording_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/power.h"
#include "analysis/psychometric_figure.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

// People look at the middle and now and then up and to the right.
GazeHeatMap known_gaze() {
    GazeHeatMap gaze{48, 36, 48.0, 36.0, {}};
    for (int y = 0; y < gaze.rows; ++y)
        for (int x = 0; x < gaze.columns; ++x) {
            const double azimuth = x - 23.5, elevation = 17.5 - y;
            gaze.counts.push_back(std::round(
                1000.0 * std::exp(-(azimuth * azimuth + elevation * elevation) / 50.0) +
                300.0 * std::exp(-(std::pow(azimuth - 14.0, 2) + std::pow(elevation - 9.0, 2)) / 8.0)));
        }
    return gaze;
}

FrameTimes known_frames() {
    FrameTimes frames{0.1, std::vector<std::int64_t>(300, 0), 90.0};
    for (int i = 105; i < 118; ++i)
        frames.counts[static_cast<std::size_t>(i)] = 20'000 / (1 + std::abs(i - 111) * 3);
    frames.counts[222] = 7;
    return frames;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

void expect_three_files(const std::filesystem::path& stem) {
    const auto files = figure_files(stem);
    EXPECT_NE(text_of(files[0]).find("</svg>"), std::string::npos);
    EXPECT_TRUE(text_of(files[1]).starts_with("\x89PNG"));
    EXPECT_TRUE(text_of(files[2]).starts_with("%PDF"));
}

// Width of a PNG in pixels, from its header.
int png_width(const std::filesystem::path& path) {
    const std::string bytes = text_of(path);
    int width = 0;
    for (std::size_t i = 16; i < 20; ++i) width = width * 256 + static_cast<unsigned char>(bytes.at(i));
    return width;
}

TEST(GazeFigure, draws_the_heat_map_with_its_axes_and_scale) {
    const TemporaryFolder folder;
    StudyDescription study;
    study.data_origin = "simulated gaze";
    run_gnuplot(gaze_figure_script(known_gaze(), study, folder.path() / "gaze"));
    expect_three_files(folder.path() / "gaze");
    const std::string svg = text_of(folder.path() / "gaze.svg");
    for (const char* part : {"azimuth", "elevation", "samples per square degree", "simulated gaze", "<image"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_GE(png_width(folder.path() / "gaze.png"), static_cast<int>(14.0 / 2.54 * 200.0));
}

TEST(GazeFigure, of_no_sample_is_drawn_and_of_a_grid_not_filled_is_refused) {
    const TemporaryFolder folder;
    GazeHeatMap empty{4, 3, 8.0, 6.0, std::vector<double>(12, 0.0)};
    run_gnuplot(gaze_figure_script(empty, {}, folder.path() / "empty"));
    expect_three_files(folder.path() / "empty");
    empty.counts.pop_back();
    EXPECT_NE(
        message_of([&] { gaze_figure_script(empty, {}, folder.path() / "bad"); }).find("11 counts for 4 x 3"),
        std::string::npos);
}

TEST(TimingFigure, draws_one_bar_for_each_interval_that_occurred_and_names_the_refreshes) {
    const TemporaryFolder folder;
    const FrameTimes frames = known_frames();
    run_gnuplot(timing_figure_script(frames, {}, folder.path() / "timing"));
    expect_three_files(folder.path() / "timing");
    const std::string svg = text_of(folder.path() / "timing.svg");
    for (const char* part : {"interval (ms)", "1 refresh", "2 refreshes"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    const auto bars = std::count_if(frames.counts.begin(), frames.counts.end(), [](auto n) { return n > 0; });
    EXPECT_GE(count_of(svg, "<polygon"), static_cast<std::size_t>(bars));
}

TEST(TimingFigure, of_no_frame_is_no_crash) {
    const TemporaryFolder folder;
    const std::string script = timing_figure_script({}, {}, folder.path() / "none");
    EXPECT_EQ(script.find("nan"), std::string::npos);
}

TEST(PowerFigure, draws_one_curve_for_each_sigma) {
    const TemporaryFolder folder;
    PowerQuestion question;
    for (double sigma : {1.4, 1.8, 2.2})
        for (double alpha : {1.0, 4.0}) question.plan.push_back({{sigma, alpha}, 1});
    question.assumptions.functions = {{1.0, 3.1, 4.0}, {4.0, 5.2, 4.0}};
    question.participants = {6, 12, 24};
    question.studies = 60;
    question.permutations = 99;
    write_power(simulate_power(question), question, folder.path());
    expect_three_files(folder.path() / "power");
    const std::string svg = text_of(folder.path() / "power.svg");
    for (const char* part : {"participants", "1.4", "1.8", "2.2"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_GE(count_of(svg, "gnuplot_plot_"), 4u) << "the line at 80 % and three curves";
}

TEST(PowerFigure, shows_the_assumed_effect_where_several_were_simulated) {
    const TemporaryFolder folder;
    PowerQuestion question;
    PowerPoint point;
    point.participants = 18;
    point.sessions = 2;
    point.studies = 100;
    std::vector<PowerPoint> points;
    for (const double effect : {0.0, 1.0, 2.0}) {
        point.effect = effect;
        point.sigmas = {{}};
        point.sigmas[0].sigma = 1.8;
        point.sigmas[0].permutation = 0.3 * effect;
        points.push_back(point);
    }
    question.studies = 100;
    write_power(points, question, folder.path());
    const std::string svg = text_of(folder.path() / "power.svg");
    EXPECT_NE(svg.find("2 sessions each, effect 1, 100 studies"), std::string::npos);
}

TEST(PsychometricFigure, a_panel_whose_curve_never_meets_the_criterion_says_on_which_side_it_stays) {
    const TemporaryFolder folder;
    const auto title = [&](std::int64_t different) {
        PsychometricResults results;
        const std::vector<PsychometricLevel> levels{
            {2, 40, different}, {4, 40, different}, {6, 40, different}};
        PsychometricFitOptions options;
        options.draws = 100;
        results.pooled.push_back({std::nullopt, 4.0, *fit_psychometric(levels, options), std::nullopt});
        return psychometric_figure_script(results, {}, folder.path() / "psychometric");
    };
    EXPECT_NE(title(30).find("α = 4:  more than 20 % at every σ² shown"), std::string::npos);
    EXPECT_NE(title(0).find("α = 4:  fewer than 20 % at every σ² shown"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
