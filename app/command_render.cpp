// parafovea render: pictures of a scene, with what they cost.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/commands.h"
#include "app/contact_sheet.h"
#include "app/options.h"
#include "app/rendered_views.h"
#include "renderer/methods/method_list.h"
#include "renderer/scene_catalog.h"
#include "renderer/temporal_view.h"

namespace parafovea {

namespace {

nlohmann::ordered_json notes_json(const std::vector<FeatureNote>& notes) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FeatureNote& note : notes) list.push_back({{"name", note.name}, {"reason", note.reason}});
    return list;
}

nlohmann::ordered_json statistics_json(const FrameStatistics& statistics) {
    nlohmann::ordered_json json;
    json["width"] = statistics.size.width;
    json["height"] = statistics.size.height;
    json["buffer_width"] = statistics.buffer.width;
    json["buffer_height"] = statistics.buffer.height;
    json["screen_pixels"] = statistics.screen_pixels;
    json["shaded_samples"] = statistics.shaded_samples;
    json["shaded_share"] =
        static_cast<double>(statistics.shaded_samples) / static_cast<double>(statistics.screen_pixels);
    json["triangles_in_view"] = statistics.triangles;
    json["passes_ms"] = nlohmann::ordered_json::object();
    for (const PassTimer::Pass& pass : statistics.passes) json["passes_ms"][pass.name] = pass.ms;
    json["device"] = statistics.device;
    json["driver"] = statistics.driver;
    json["device_memory_bytes"] = statistics.device_memory_bytes;
    json["peak_device_memory_bytes"] = statistics.peak_device_memory_bytes;
    json["peak_host_memory_bytes"] = peak_host_memory_bytes();
    json["built"] = notes_json(statistics.built);
    json["left_out"] = notes_json(statistics.left_out);
    return json;
}

void write_statistics(const nlohmann::ordered_json& json, const std::string& file_name) {
    std::ofstream file(file_name);
    file << json.dump(4) << '\n';
    if (!file.flush())
        throw std::runtime_error(file_name + ": cannot write the statistics; name another file with --stats");
}

// "name.png" with something between name and ending.
std::string file_named(const std::string& out, const std::string& addition) {
    const std::filesystem::path path(out);
    return (path.parent_path() / (path.stem().string() + addition + path.extension().string())).string();
}

std::string method_choices() {
    std::string text = "How it is drawn:";
    for (const MethodName& method : method_names()) text += "\n" + method.name + ": " + method.summary;
    return text;
}

SceneCamera camera_at(const Scene& scene, double time_s) {
    if (scene.path.empty())
        throw std::runtime_error("scene " + scene.name +
                                 " has no camera path; leave out --path and --frames");
    return camera_on_path(scene, static_cast<float>(time_s));
}

}  // namespace

RenderCommand::RenderCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "Render pictures of a scene");
    command->footer(
        "Example: parafovea render --scene atrium --method kfr --sigma 1.8 --alpha 4 --out atrium.png\n"
        "Parameters of every method, for --set: taa, taa_alpha, contrast; sigma_other_eye and dominant_eye "
        "(left or right) where a method has sigma.");
    command->add_option("--scene", scene_, "A built-in scene (see: parafovea scenes) or a glTF file")
        ->required();
    command->add_option("--method", method_, method_choices())->capture_default_str();
    foveation_.add_to(*command);
    command->add_option("--set", settings_, "NAME=VALUE: any parameter of the method; may be repeated");
    command->add_option("--size", size_, "WIDTHxHEIGHT in pixels, of each eye's picture")
        ->capture_default_str();
    command->add_option("--out", out_, "Picture to write (PNG)")->required();
    command->add_option("--stats", stats_, "Write times, counts and features to this file (JSON)");
    command->add_option("--taa", taa_, "Anti-aliasing over time: as after this many frames (1 to 64)")
        ->check(CLI::Range(1, 64));
    command
        ->add_option("--contrast", contrast_,
                     "Preserve contrast: gain for each pixel of blur (Patney et al. 2016 use 0.2)")
        ->check(CLI::Range(0.0, 2.0));
    command->add_option("--views", views_, "1, or 2: the left and the right eye's picture side by side")
        ->check(CLI::Range(1, 2))
        ->capture_default_str();
    command->add_option("--ipd-mm", ipd_mm_, "Two views: distance between the eyes")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command->add_option(
        "--eye-fov", eye_fov_,
        "Two views: LEFT,RIGHT,UP,DOWN of the left eye in degrees, mirrored for the right one; "
        "the camera's own when absent");
    command
        ->add_option("--gaze-distance-m", gaze_distance_m_,
                     "Two views: how far away the point is at which both eyes look")
        ->check(CLI::Range(0.05, 1e6))
        ->capture_default_str();
    command->add_option("--path", path_s_, "From the scene's camera path, at this time in seconds");
    command
        ->add_option("--frames", frames_,
                     "Write this many frames along the scene's camera path: out_0000.png, out_0001.png, ...")
        ->check(CLI::Range(1, 100000));
    command->add_option("--path-seconds", path_seconds_,
                        "With --frames: how much of the path they show, from --path on; all when absent");
    command->add_flag(
        "--sheet", sheet_,
        "A contact sheet of full resolution and KFR at the settings of the paper's figures, and "
        "out_density.png with the samples of each pixel");
    command->add_flag("--no-culling", no_culling_, "kfr: shade the texels that no pixel reads, too");
    command->add_flag("--no-filters", no_filters_, "kfr: without the internal filter");
    command->add_flag("--post-filter", post_filter_, "kfr: with the screen-space filter of Eq. 14");
    command->callback([this] { run(); });
}

RenderMethod RenderCommand::wanted_method() const {
    RenderMethod method{method_, {}, {}};
    if (method_ != "full") foveation_.add_to(method);
    if (no_culling_) method.numbers["culling"] = 0;
    if (no_filters_) method.numbers["internal_filter"] = 0;
    if (post_filter_) method.numbers["post_filter"] = 1;
    if (taa_ > 0) method.numbers["taa"] = taa_;
    if (contrast_) method.numbers["contrast"] = *contrast_;
    for (const std::string& setting : settings_) add_setting("--set", setting, method);
    check(method);
    return method;
}

void RenderCommand::run() const {
    wanted_method();  // refuses before anything is loaded
    const Scene scene = load_scene(scene_);
    for (const std::string& warning : scene.warnings)
        std::fprintf(stderr, "parafovea: %s\n", warning.c_str());
    Gpu gpu;
    FrameRenderer renderer(gpu, scene);
    if (sheet_)
        write_sheet(renderer, scene);
    else
        render_frames(renderer, scene);
}

void RenderCommand::render_frames(FrameRenderer& renderer, const Scene& scene) const {
    const SizePx size = parse_size(size_);
    const RenderMethod method = wanted_method();
    TwoEyes two{.ipd_m = ipd_mm_ / 1000, .gaze_distance_m = gaze_distance_m_};
    if (!eye_fov_.empty()) parse_eye_fov(eye_fov_, two);
    const double start_s = path_s_.value_or(0);
    const int frames = std::max(frames_, 1);
    double seconds = 0;
    if (frames_ > 0) {
        seconds = path_seconds_.value_or(scene.path.empty() ? 0 : scene.path.back().time_s - start_s);
    }

    std::vector<MovingView> moving;
    for (int i = 0; i < views_ && frames_ > 0; ++i) moving.emplace_back(renderer);
    nlohmann::ordered_json statistics = nlohmann::ordered_json::array();
    for (int i = 0; i < frames; ++i) {
        const SceneCamera camera = frames_ > 0 || path_s_
                                       ? camera_at(scene, start_s + seconds * i / std::max(frames - 1, 1))
                                       : scene.cameras.front();
        const std::vector<RenderedView> views =
            rendered_views(camera, size, method, foveation_.gaze_on(size), views_ == 2 ? &two : nullptr);
        std::vector<Image> pictures;
        for (std::size_t v = 0; v < views.size(); ++v) {
            const auto& [view, own_method, gaze] = views[v];
            RenderedFrame frame = frames_ > 0 ? moving[v].render(size, view, own_method, gaze)
                                              : renderer.render(size, view, own_method, gaze);
            statistics.push_back(statistics_json(frame.statistics));
            statistics.back()["scene_load_s"] = scene.load_s;
            pictures.push_back(std::move(frame.image));
        }
        char number[16] = "";
        if (frames_ > 0) std::snprintf(number, sizeof number, "_%04d", i);
        save_png(side_by_side(pictures), file_named(out_, number));
    }
    if (!stats_.empty()) write_statistics(statistics.size() == 1 ? statistics.front() : statistics, stats_);
}

void RenderCommand::write_sheet(FrameRenderer& renderer, const Scene& scene) const {
    const SizePx size = parse_size(size_);
    if (size.width < 64 || size.height < 64)
        throw CLI::ValidationError("--size", "a contact sheet needs pictures of at least 64x64 pixels");
    const SceneCamera camera = path_s_ ? camera_at(scene, *path_s_) : scene.cameras.front();
    const PointPx gaze = foveation_.gaze_on(size);
    RenderMethod more;
    if (taa_ > 0) more.numbers["taa"] = taa_;
    if (contrast_) more.numbers["contrast"] = *contrast_;
    const std::vector<SheetEntry> entries = kfr_sheet(more);
    save_png(contact_sheet(renderer, size, view_through(camera, size), gaze, entries), out_);
    save_png(density_sheet(renderer, size, gaze, entries), file_named(out_, "_density"));
}

}  // namespace parafovea
