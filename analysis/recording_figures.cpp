// Figures and a table of how well gaze and timing were recorded.
#include "analysis/recording_figures.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "analysis/csv_text.h"
#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

std::string heading(const std::string& text, const StudyDescription& study) {
    std::string title = "set title \"{/:Bold \"." + gnuplot_quoted(text) + ".\"}\"";
    if (!study.data_origin.empty()) title += ".\"\\nData: \"." + gnuplot_quoted(study.data_origin);
    return title + " left offset graph -0.5,character 0.3\n";
}

}  // namespace

std::string gaze_figure_script(const GazeHeatMap& gaze, const StudyDescription& study,
                               const std::filesystem::path& stem) {
    if (gaze.columns < 1 || gaze.rows < 1 || gaze.width_deg <= 0.0 || gaze.height_deg <= 0.0 ||
        gaze.counts.size() != static_cast<std::size_t>(gaze.columns) * static_cast<std::size_t>(gaze.rows))
        throw std::runtime_error("gaze heat map: " + std::to_string(gaze.counts.size()) + " counts for " +
                                 std::to_string(gaze.columns) + " x " + std::to_string(gaze.rows) + " cells");
    const double total = std::accumulate(gaze.counts.begin(), gaze.counts.end(), 0.0);
    const double cell_width = gaze.width_deg / gaze.columns, cell_height = gaze.height_deg / gaze.rows;
    std::string body = "$gaze << EOD\n";
    for (int y = gaze.rows - 1; y >= 0; --y) {
        for (int x = 0; x < gaze.columns; ++x) {
            const double count =
                gaze.counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(gaze.columns) +
                            static_cast<std::size_t>(x)];
            const double density = total > 0.0 ? 100.0 * count / (total * cell_width * cell_height) : 0.0;
            body += fixed_text(-gaze.width_deg / 2.0 + (x + 0.5) * cell_width, 3) + " " +
                    fixed_text(gaze.height_deg / 2.0 - (y + 0.5) * cell_height, 3) + " " +
                    general_text(density, 5) + "\n";
        }
        body += "\n";
    }
    body += "EOD\n" + heading("Where the participants looked", study);
    body += "set size ratio " + fixed_text(gaze.height_deg / gaze.width_deg, 4) + "\nset xrange [" +
            fixed_text(-gaze.width_deg / 2.0, 3) + ":" + fixed_text(gaze.width_deg / 2.0, 3) +
            "]\nset yrange [" + fixed_text(-gaze.height_deg / 2.0, 3) + ":" +
            fixed_text(gaze.height_deg / 2.0, 3) + "]\n";
    // Dark is much in print as on the screen; the steps of lightness are even (after the cividis map of Nunez
    // et al. 2018).
    body +=
        "set palette defined (0 '#FFFFFF', 1 '#FDEA9B', 2 '#C9B370', 3 '#8A8779', 4 '#535E71', 5 "
        "'#00224E')\nset cbrange [0:*]\n";
    body += "set xlabel \"azimuth (°, right positive)\"\nset ylabel \"elevation (°, up positive)\"\n";
    body +=
        "set cblabel \"% of samples per square degree\" offset 1.5,0\nset tics out nomirror scale 0.5\nunset "
        "key\nset "
        "tmargin 4\n";
    body += "plot $gaze using 1:2:3 with image\n";
    return figure_script(stem, {14.0, 11.0}, body);
}

std::string timing_figure_script(const FrameTimes& frames, const StudyDescription& study,
                                 const std::filesystem::path& stem) {
    std::string body = "$frames << EOD\n";
    double last = 0.0;
    for (std::size_t i = 0; i < frames.counts.size(); ++i) {
        if (frames.counts[i] == 0) continue;
        last = (static_cast<double>(i) + 1.0) * frames.bin_ms;
        body += fixed_text((static_cast<double>(i) + 0.5) * frames.bin_ms, 4) + " " +
                std::to_string(frames.counts[i]) + "\n";
    }
    body += "EOD\n" + heading("Time from one frame to the next", study);
    const double period = frames.refresh_hz > 0.0 ? 1000.0 / frames.refresh_hz : 0.0;
    // A single long halt must not squeeze all others into one line; what lies beyond is counted in words.
    const double shown = period > 0.0 ? std::min(last, 6.5 * period) : last;
    const double end = std::max(shown, 2.5 * period) * 1.05;
    std::int64_t all = 0, beyond = 0, missed = 0;
    for (std::size_t i = 0; i < frames.counts.size(); ++i) {
        const double middle = (static_cast<double>(i) + 0.5) * frames.bin_ms;
        all += frames.counts[i];
        if (middle > end) beyond += frames.counts[i];
        if (period > 0.0 && middle > 1.5 * period) missed += frames.counts[i];
    }
    body +=
        "set border 3 linewidth 0.8 linecolor rgb '#333333'\nset tics nomirror out scale 0.5\nset xrange "
        "[0:" +
        fixed_text(end > 0.0 ? end : 1.0, 3) + "]\nset logscale y\nset yrange [0.5:*]\nset boxwidth " +
        fixed_text(frames.bin_ms, 4) +
        "\nset style fill solid 1.0 border linecolor rgb '#0072B2'\nunset key\nset tmargin 4\n";
    body += "set xlabel \"interval (ms)\"\nset ylabel \"frames (logarithmic)\"\n";
    for (int k = 1; period > 0.0 && k * period < end && k <= 6; ++k)
        body += "set arrow from " + fixed_text(k * period, 4) + ",graph 0 to " + fixed_text(k * period, 4) +
                ",graph 1 nohead dashtype (4,4) linewidth 0.7 linecolor rgb '#777777'\nset label \"" +
                std::to_string(k) + (k == 1 ? " refresh" : " refreshes") + "\" at " +
                fixed_text(k * period, 4) + ",graph 1.02 center font ',8' textcolor rgb '#555555'\n";
    std::string note = std::to_string(all) + " frames";
    if (period > 0.0) note += ", " + std::to_string(missed) + " later than 1.5 refreshes";
    if (beyond > 0) note += ", " + std::to_string(beyond) + " beyond this axis";
    body += "set label \"" + note + "\" at graph 1,graph 1.13 right font ',9' textcolor rgb '#333333'\n";
    // A border keeps single bins visible in print.
    body += "plot $frames using 1:2 with boxes linecolor rgb '#0072B2' linewidth 1.5\n";
    return figure_script(stem, {15.0, 8.0}, body);
}

std::string quality_csv(const StudyRecordings& recordings) {
    std::string csv =
        "participant,session,accuracy_deg,precision_deg,gaze_loss,gaze_hz,gaze_age_ms,frames,missed\n";
    for (const SessionQuality& session : recordings.sessions)
        csv += csv_field(session.participant) + "," + std::to_string(session.session) + "," +
               csv_text(session.accuracy_deg, 6) + "," + csv_text(session.precision_deg, 6) + "," +
               csv_text(session.gaze_loss, 6) + "," + csv_text(session.gaze_hz, 6) + "," +
               csv_text(session.gaze_age_ms, 6) + "," + std::to_string(session.frames) + "," +
               std::to_string(session.missed) + "\n";
    return csv;
}

}  // namespace parafovea
