// parafovea tradeoff: speed against accuracy of every method and setting.
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "analysis/frontier_report.h"
#include "analysis/number_text.h"
#include "analysis/text_file.h"
#include "app/commands.h"
#include "app/condition_prediction.h"
#include "app/options.h"
#include "app/progress.h"
#include "app/tradeoff_journal.h"
#include "app/tradeoff_measurement.h"
#include "study/protocol.h"

namespace parafovea {
namespace {

// Meng et al. 2018 chose this setting with their study; it shades every texel of its buffer.
Anchor published_setting(const TradeoffPlan& plan) {
    return {"KFR as published", "alpha=4 culling=0 sigma=1.8" +
                                    (plan.taa > 0 ? " taa=" + std::to_string(plan.taa) : std::string())};
}
constexpr double kIdenticalCriterion = 0.8;  // of the study's answers

// "1280x1440@76.7": a size and, if it is not the common one, its horizontal field of view.
ViewGeometry parse_view(const std::string& text, double common_fov_deg) {
    const std::size_t at = text.find('@');
    ViewGeometry view{parse_size(text.substr(0, at)), common_fov_deg};
    if (at == std::string::npos) return view;
    try {
        std::size_t read = 0;
        view.horizontal_fov_deg = std::stod(text.substr(at + 1), &read);
        if (at + 1 + read == text.size()) return view;
    } catch (const std::logic_error&) {
    }
    throw std::runtime_error("tradeoff: expected a size and degrees such as 1280x1440@76.7, found '" + text +
                             "'");
}

void report(const FrontierReport& found, const std::string& out) {
    for (const std::filesystem::path& file : write_frontier(found, out)) std::printf("%s\n", file.c_str());
}

}  // namespace

TradeoffCommand::TradeoffCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand(
        "tradeoff", "Measure every method's speed against its accuracy, and recommend a setting");
    command->footer(
        "Example: parafovea tradeoff --scenes atrium --sizes 1280x720 --out tradeoff\n"
        "A run that was killed goes on where it stopped when the same command is given again.\n"
        "On several machines: --shard 1/8 to --shard 8/8, each with its own --out; then --merge OUT1 OUT2 "
        "... --out ALL");
    command->add_option("--scenes", scenes_, "Built-in scenes or glTF files")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--methods", methods_, "Methods, with all their settings; all when absent")
        ->delimiter(',');
    command->add_option(
        "--setting", settings_,
        "\"METHOD NAME=VALUE ...\": measure this setting, too, or only such ones when --methods is "
        "absent; may be repeated");
    command->add_option("--sizes", sizes_, "WIDTHxHEIGHT or WIDTHxHEIGHT@DEGREES (horizontal field of view)")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--gaze", gazes_, "centre, quarter, corner, path")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--gaze-recording", gaze_recording_,
                        "Take the gaze path from this recording; a simulated eye when absent");
    command->add_option("--gaze-age", gaze_age_ms_, "How old gaze is when its frame is seen (ms)")
        ->capture_default_str();
    command->add_option("--motion", motions_, "still, path: of the camera")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--protocol", protocol_,
                        "Take the display (size, field of view, luminance, rate) from this");
    command->add_option("--fov", fov_deg_, "Horizontal field of view of sizes without one (degrees)")
        ->capture_default_str();
    command->add_option("--luminance", peak_cd_m2_, "Of white (cd/m2)")->capture_default_str();
    command->add_option("--rate", refresh_hz_, "Frames per second of what moves")->capture_default_str();
    command->add_option("--rounds", rounds_, "Timed frames of each setting on a still picture")
        ->capture_default_str();
    command->add_option("--frames", frames_, "Frames of what moves")->capture_default_str();
    command
        ->add_option("--reference-samples", reference_samples_,
                     "Samples a pixel of the super-sampled reference")
        ->capture_default_str();
    command->add_option("--seed", seed_, "Of the simulated eye")->capture_default_str();
    command->add_option("--shard", shard_, "I/N: measure the I-th of N parts of the sweep");
    command->add_option("--merge", merge_, "Folders of all shards: join what they measured");
    command->add_option("--predict", predict_,
                        "Instead, what people would answer to this protocol's conditions");
    command->add_option("--participants", participants_, "With --predict: of the simulated studies")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    command->add_option("--out", out_, "Folder for the results")->required();
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] {
        if (!predict_.empty()) return predict();
        merge_.empty() ? run() : merge();
    });
}

void TradeoffCommand::run() const {
    TradeoffPlan plan;
    plan.scenes = scenes_;
    plan.gazes = gazes_;
    plan.motions = motions_;
    plan.refresh_hz = refresh_hz_;
    plan.peak_cd_m2 = peak_cd_m2_;
    if (!protocol_.empty()) {
        const DisplaySetting display = load_protocol(protocol_).display;
        plan.views = {display.view};
        plan.refresh_hz = display.refresh_hz;
        plan.peak_cd_m2 = display.peak_luminance_cd_m2;
    } else {
        for (const std::string& size : sizes_) plan.views.push_back(parse_view(size, fov_deg_));
    }
    plan.methods =
        methods_.empty() && settings_.empty() ? standard_tradeoff_methods() : tradeoff_methods_of(methods_);
    for (const std::string& setting : settings_) plan.methods.push_back(parse_tradeoff_method(setting));
    plan.rounds = rounds_;
    plan.frames = frames_;
    plan.taa = taa_;
    plan.reference_samples = reference_samples_;
    plan.gaze_age_ms = gaze_age_ms_;
    plan.gaze_recording = gaze_recording_;
    plan.seed = seed_;
    check(plan);
    const Shard shard = shard_.empty() ? Shard{} : parse_shard(shard_);

    Gpu gpu;
    const std::string device = gpu.device_name() + ", " + gpu.driver_name();
    TradeoffJournal journal(out_, plan, shard, device);

    // What is left to do: methods that have no row yet, with full resolution beside them.
    struct Task {
        TradeoffGroup group;
        std::vector<TradeoffMethod> methods;
        bool full_known = false;
    };
    std::vector<Task> tasks;
    int work = 0;
    for (const TradeoffGroup& group : groups_of(plan, shard)) {
        Task task{group, {}, false};
        for (const TradeoffMethod& method : methods_of(plan)) {
            const std::string key = key_of(empty_row(plan, group, method));
            const bool known = std::ranges::any_of(
                journal.rows(), [&](const TradeoffRow& row) { return key_of(row) == key; });
            if (task.methods.empty()) {
                task.methods.push_back(method);
                task.full_known = known;
            } else if (!known) {
                task.methods.push_back(method);
            }
        }
        if (task.methods.size() == 1 && task.full_known) continue;
        work += work_of(plan, group, task.methods.size());
        tasks.push_back(std::move(task));
    }
    if (!journal.rows().empty() && !quiet_)
        std::fprintf(stderr, "parafovea: %zu settings were measured before\n", journal.rows().size());
    {
        Progress progress("tradeoff", work, quiet_);
        TradeoffMeasurement measurement(gpu, plan);
        int done = 0;
        for (const Task& task : tasks) {
            measurement.measure(task.group, task.methods,
                                {[&](int more, const std::string& detail) {
                                     done += more;
                                     progress.update(done, detail);
                                 },
                                 [&](const TradeoffRow& row) {
                                     if (task.full_known && row.method == "full") return;
                                     journal.append(row);
                                 }});
        }
    }
    if (shard.count > 1) {
        std::printf("%s\n", (std::filesystem::path(out_) / kTradeoffJournalName).c_str());
        return;
    }
    report({rows_in_order(plan, shard, journal.rows(), out_), published_setting(plan), kIdenticalCriterion,
            device, command_line()},
           out_);
}

void TradeoffCommand::merge() const {
    std::vector<std::filesystem::path> folders(merge_.begin(), merge_.end());
    const MergedTradeoff merged = merge_tradeoff(folders);
    std::string device;
    for (const std::string& one : merged.devices) device += (device.empty() ? "" : "; ") + one;
    report({merged.rows, published_setting(merged.plan), kIdenticalCriterion, device,
            "parafovea tradeoff --merge ..."},
           out_);
}

void TradeoffCommand::predict() const {
    const Protocol protocol = load_protocol(predict_);
    make_output_folder(out_);
    PictureSource pictures(protocol.display.view);
    std::vector<ConditionPrediction> predictions;
    {
        Progress progress("predict", static_cast<int>(protocol.scenes.size() * protocol.conditions.size()),
                          quiet_);
        predictions = predict_conditions(
            protocol, pictures, [&](int done, const std::string& next) { progress.update(done, next); });
    }
    const std::filesystem::path out(out_);
    const std::string markdown = predictions_markdown(predictions, protocol, participants_,
                                                      pictures.device_name() + ", " + pictures.driver_name());
    write_text_file(out / "predicted.csv", predictions_csv(predictions));
    write_text_file(out / "predicted.md", markdown);
    std::printf("%s\n%s\n", markdown.c_str(), (out / "predicted.md").c_str());
}

// The options that say what was measured, as they would be typed.
std::string TradeoffCommand::command_line() const {
    const auto joined = [](const std::vector<std::string>& list) {
        std::string text;
        for (const std::string& one : list) text += (text.empty() ? "" : ",") + one;
        return text;
    };
    std::string line = "parafovea tradeoff --scenes " + joined(scenes_);
    if (!methods_.empty()) line += " --methods " + joined(methods_);
    for (const std::string& setting : settings_) line += " --setting '" + setting + "'";
    line += protocol_.empty()
                ? " --sizes " + joined(sizes_) + " --fov " + short_text(fov_deg_) + " --luminance " +
                      short_text(peak_cd_m2_) + " --rate " + short_text(refresh_hz_)
                : " --protocol " + protocol_;
    line += " --gaze " + joined(gazes_) + " --motion " + joined(motions_) + " --rounds " +
            std::to_string(rounds_) + " --frames " + std::to_string(frames_);
    if (taa_ > 0) line += " --taa " + std::to_string(taa_);
    if (!gaze_recording_.empty()) line += " --gaze-recording " + gaze_recording_;
    return line + " --out " + out_;
}

}  // namespace parafovea
