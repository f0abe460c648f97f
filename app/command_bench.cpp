// parafovea bench: the paper's Tables 2 and 3, every method taking turns in one run.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "analysis/figure.h"
#include "analysis/gnuplot.h"
#include "analysis/text_file.h"
#include "app/commands.h"
#include "app/options.h"
#include "app/progress.h"
#include "renderer/benchmark_run.h"

namespace parafovea {

namespace {

// A method's name on the command line: its label in lower case with underscores.
std::string key_of(const std::string& label) {
    std::string key = label;
    std::ranges::transform(key, key.begin(), [](unsigned char c) {
        return c == ' ' ? '_' : static_cast<char>(std::tolower(c));
    });
    return key;
}

std::string setting_text(const RenderMethod& method) {
    std::ostringstream text;
    const char* separator = "";
    for (const auto& [name, value] : method.numbers) {
        text << separator << name << '=' << value;
        separator = " ";
    }
    for (const auto& [name, value] : method.words) text << separator << name << '=' << value;
    return text.str();
}

// Meng et al. 2018, Table 2: milliseconds at 1920x1080 on a GTX 1080. Pass I stands in the row "shading /
// pass 1".
struct PublishedPass {
    const char* name;
    double full_ms, kfr_ms;  // 0: not in the table
};
constexpr std::array<PublishedPass, 8> kPublishedPasses = {{{"depth", 0.327, 0.309},
                                                            {"shadow", 3.744, 4.503},
                                                            {"defer", 2.985, 3.034},
                                                            {"sky_box", 0.039, 0.039},
                                                            {"pass_1", 22.043, 6.674},
                                                            {"pass_2", 0, 0.090},
                                                            {"post", 0, 0},
                                                            {"total", 29.138, 14.649}}};

double pass_ms(const BenchmarkRow& row, const std::string& name) {
    for (const PassTimer::Pass& pass : row.passes)
        if (pass.name == name) return pass.ms;
    return 0;
}

std::string fixed(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string ratio(double full, double kfr) {
    return full > 0 && kfr > 0 ? fixed(kfr / full, 3) : "";
}

// Both tables' machine in words, so that a number is never read without it.
std::string machine(const Gpu& gpu) {
    return gpu.device_name() + ", " + gpu.driver_name();
}

void write_table_2(const std::filesystem::path& out, const BenchmarkRow& full, const BenchmarkRow& kfr,
                   const std::string& device) {
    std::string csv = "pass,full_ms,kfr_ms\n";
    std::string markdown =
        "# Table 2. Time of each pass\n\n" + full.scene + ", " + std::to_string(full.size.width) + " x " +
        std::to_string(full.size.height) + ", " + kfr.method.label + " (" + setting_text(kfr.method.method) +
        "); " + device +
        "\n\n| pass | full, ms | KFR, ms | KFR / full | published KFR / full |\n|---|---|---|---|---|\n";
    for (const PublishedPass& published : kPublishedPasses) {
        const double full_ms = pass_ms(full, published.name), kfr_ms = pass_ms(kfr, published.name);
        if (full_ms == 0 && kfr_ms == 0) continue;
        const std::string full_text = full_ms > 0 ? fixed(full_ms, 3) : "",
                          kfr_text = kfr_ms > 0 ? fixed(kfr_ms, 3) : "";
        csv += std::string(published.name) + "," + full_text + "," + kfr_text + "\n";
        markdown += "| " + std::string(published.name) + " | " + full_text + " | " + kfr_text + " | " +
                    ratio(full_ms, kfr_ms) + " | " + ratio(published.full_ms, published.kfr_ms) + " |\n";
    }
    write_text_file(out / "table2.csv", csv);
    write_text_file(out / "table2.md", markdown);
}

void write_table_3(const std::filesystem::path& out, const std::vector<BenchmarkRow>& rows,
                   const std::string& device, const std::string& conditions) {
    std::string csv =
        "scene,width,height,method,setting,frame_ms,frame_ms_low,frame_ms_high,shading_ms,shaded_samples,"
        "speedup,device_memory_bytes\n";
    std::string markdown =
        "# Table 3. Frame time and speed-up\n\n" + device + ". " + conditions +
        " Medians over rounds in which all methods took turns, with quartiles; the speed-up is the median of "
        "the "
        "rounds' own. Frames are not read back. Memory is the device's with all methods of a size "
        "resident.\n\n"
        "| scene | size | method | frame, ms | shading, ms | samples / pixels | memory, MiB | speed-up "
        "|\n|---|---|---|---|---|---|---|---|\n";
    for (const BenchmarkRow& row : rows) {
        const std::string size = std::to_string(row.size.width) + "," + std::to_string(row.size.height);
        csv += row.scene + "," + size + "," + row.method.label + "," + setting_text(row.method.method) + "," +
               fixed(row.frame_ms, 3) + "," + fixed(row.frame_ms_low, 3) + "," + fixed(row.frame_ms_high, 3) +
               "," + fixed(row.shading_ms, 3) + "," + std::to_string(row.shaded_samples) + "," +
               fixed(row.speedup, 3) + "," + std::to_string(row.device_memory_bytes) + "\n";
        const double pixels = static_cast<double>(row.size.width) * row.size.height;
        markdown += "| " + row.scene + " | " + std::to_string(row.size.width) + " x " +
                    std::to_string(row.size.height) + " | " + row.method.label + " | " +
                    fixed(row.frame_ms, 1) + " (" + fixed(row.frame_ms_low, 1) + " to " +
                    fixed(row.frame_ms_high, 1) + ") | " + fixed(row.shading_ms, 1) + " | " +
                    fixed(static_cast<double>(row.shaded_samples) / pixels, 4) + " | " +
                    fixed(static_cast<double>(row.device_memory_bytes) / (1 << 20), 0) + " | " +
                    fixed(row.speedup, 2) + " |\n";
    }
    write_text_file(out / "table3.csv", csv);
    write_text_file(out / "table3.md", markdown);
}

std::string joined_names(const std::vector<FeatureNote>& notes, const char* separator) {
    std::string text;
    for (const FeatureNote& note : notes) text += (text.empty() ? "" : separator) + note.name;
    return text;
}

void write_needs(const std::filesystem::path& out, const std::vector<NeedsRow>& rows,
                 const std::string& device) {
    std::string csv = "scene,width,height,forced_ms,needed_ms,still_ms,left_out\n";
    std::string markdown = "# Everything built against only what a scene needs\n\nFull resolution; " +
                           device +
                           ". Still: neither the scene nor the view changes from frame to frame.\n\n"
                           "| scene | size | everything, ms | what it needs, ms | still, ms | left out "
                           "|\n|---|---|---|---|---|---|\n";
    for (const NeedsRow& row : rows) {
        csv += row.scene + "," + std::to_string(row.size.width) + "," + std::to_string(row.size.height) +
               "," + fixed(row.forced_ms, 3) + "," + fixed(row.needed_ms, 3) + "," + fixed(row.still_ms, 3) +
               "," + joined_names(row.left_out, "; ") + "\n";
        markdown += "| " + row.scene + " | " + std::to_string(row.size.width) + " x " +
                    std::to_string(row.size.height) + " | " + fixed(row.forced_ms, 1) + " | " +
                    fixed(row.needed_ms, 1) + " | " + fixed(row.still_ms, 1) + " | " +
                    joined_names(row.left_out, ", ") + " |\n";
    }
    write_text_file(out / "needs.csv", csv);
    write_text_file(out / "needs.md", markdown);
}

// One group of bars for each scene and size, one bar for each method.
void draw_table_3(const std::filesystem::path& out, const std::vector<BenchmarkRow>& rows,
                  std::size_t methods, const std::string& device) {
    std::string body =
        "set title " + gnuplot_quoted("Speed-up over full resolution\n" + device) +
        "\nset style data histograms\nset style histogram clustered gap 1\nset style fill solid 0.85 border "
        "lc rgb '#202020'\nset boxwidth 0.9\nset yrange [0:*]\nset ylabel 'Speed-up'\nset grid ytics\n"
        "set key outside below\nset xtics nomirror\n$rows << EOD\n";
    for (std::size_t group = 0; group * methods < rows.size(); ++group) {
        const BenchmarkRow& first = rows[group * methods];
        body += "\"" + std::filesystem::path(first.scene).stem().string() + " " +
                std::to_string(first.size.height) + "p\"";
        for (std::size_t i = 1; i < methods; ++i) body += " " + fixed(rows[group * methods + i].speedup, 4);
        body += "\n";
    }
    body += "EOD\nplot ";
    for (std::size_t i = 1; i < methods; ++i) {
        body += std::string(i > 1 ? ", " : "") + "$rows using " + std::to_string(i + 1) + ":xtic(1) title " +
                gnuplot_quoted(rows[i].method.label) + " lc rgb '" + series_style(i - 1).colour + "'";
    }
    run_gnuplot(figure_script(out / "table3", {17, 10}, body + "\n"));
}

}  // namespace

BenchCommand::BenchCommand(CLI::App& program) {
    std::string methods;
    for (const BenchmarkMethod& method : standard_benchmark_methods())
        methods += (methods.empty() ? "" : ", ") + key_of(method.label);
    CLI::App* command =
        program.add_subcommand("bench", "Measure every method's speed: the paper's Tables 2 and 3");
    command->footer("Example: parafovea bench --scenes atrium,primitives --sizes 1920x1080 --out bench");
    command->add_option("--scenes", scenes_, "Scenes, the first of them for Table 2")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--sizes", sizes_, "WIDTHxHEIGHT, the first of them for Table 2")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--methods", methods_, "All when absent: " + methods)->delimiter(',');
    command->add_option("--rounds", rounds_, "Measured rounds")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    command->add_flag("--moving-gaze", moving_gaze_, "Move the gaze before every frame");
    command->add_flag("--still", still_,
                      "Keep the geometry of the view, which stays as it is; else it is drawn anew");
    command->add_option("--samples", samples_, "Ray-marched scenes: rays for each sample (the paper's: 16)")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    command
        ->add_option(
            "--shading", shading_,
            "How methods that can do both shade their samples: auto (fragments on a software device, "
            "compute shaders on others), fragments or compute")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "fragments", "compute"}));
    command->add_flag("--no-needs", no_needs_, "Without the table of what leaving things out saves");
    command->add_option("--out", out_, "Folder for the results")->required();
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] { run(); });
}

void BenchCommand::run() const {
    BenchmarkPlan plan;
    plan.scenes = scenes_;
    for (const std::string& size : sizes_) plan.sizes.push_back(parse_size(size));
    const std::vector<BenchmarkMethod> all = standard_benchmark_methods();
    for (const std::string& wanted : methods_) {
        const auto found =
            std::ranges::find_if(all, [&](const BenchmarkMethod& m) { return key_of(m.label) == wanted; });
        if (found == all.end())
            throw std::runtime_error("bench: no method '" + wanted +
                                     "'; see parafovea bench --help for their names");
        plan.methods.push_back(*found);
    }
    if (methods_.empty()) plan.methods = all;
    plan.rounds = rounds_;
    plan.moving_gaze = moving_gaze_;
    plan.options.keep_geometry = still_;
    plan.options.samples_per_sample = static_cast<std::uint32_t>(samples_);
    if (shading_ != "auto") plan.options.shade_in_compute = shading_ == "compute";
    make_output_folder(out_);

    Gpu gpu;
    std::vector<BenchmarkRow> rows;
    {
        Progress progress("bench", 1000, quiet_);
        rows = run_benchmark(gpu, plan, [&](double share, const std::string& next) {
            progress.update(static_cast<int>(std::lround(share * 1000)), next);
        });
    }
    // Table 2 compares with the setting of the paper; its picture is the same with culling and without.
    const auto published =
        std::ranges::find_if(rows, [](const BenchmarkRow& row) { return row.method.label == "KFR"; });
    write_table_2(out_, rows.front(), published == rows.end() ? rows.at(1) : *published, machine(gpu));
    write_table_3(
        out_, rows, machine(gpu),
        std::string(still_ ? "The view is still: its geometry is kept." : "Every frame draws its geometry.") +
            (samples_ > 1 ? " Ray-marched scenes: " + std::to_string(samples_) + " rays a sample." : ""));
    draw_table_3(out_, rows, plan.methods.size() + 1, machine(gpu));
    for (const BenchmarkRow& row : rows)
        std::printf("%-12s %4d x %-4d  %-28s %9.1f ms  %6.2fx\n",
                    std::filesystem::path(row.scene).stem().c_str(), row.size.width, row.size.height,
                    row.method.label.c_str(), row.frame_ms, row.speedup);
    if (!no_needs_) {
        Progress progress("needs", 1000, quiet_);
        write_needs(out_,
                    measure_needs(gpu, plan,
                                  [&](double share, const std::string& next) {
                                      progress.update(static_cast<int>(std::lround(share * 1000)), next);
                                  }),
                    machine(gpu));
    }
    std::printf("\n%s\n", (std::filesystem::path(out_) / "table3.md").c_str());
}

}  // namespace parafovea
