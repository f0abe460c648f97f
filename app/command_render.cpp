// parafovea render: one picture of a scene, with what it cost.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/commands.h"
#include "app/options.h"
#include "renderer/frame_renderer.h"
#include "renderer/scene_catalog.h"

namespace parafovea {

namespace {

nlohmann::ordered_json notes_json(const std::vector<FeatureNote>& notes) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FeatureNote& note : notes) list.push_back({{"name", note.name}, {"reason", note.reason}});
    return list;
}

void write_statistics(const FrameStatistics& statistics, const std::string& file_name) {
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
    json["built"] = notes_json(statistics.built);
    json["left_out"] = notes_json(statistics.left_out);

    std::ofstream file(file_name);
    file << json.dump(4) << '\n';
    if (!file.flush())
        throw std::runtime_error(file_name + ": cannot write the statistics; name another file with --stats");
}

}  // namespace

RenderCommand::RenderCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "Render one picture of a scene");
    command->footer(
        "Example: parafovea render --scene atrium --method kfr --sigma 1.8 --alpha 4 --out atrium.png");
    command->add_option("--scene", scene_, "A built-in scene (see: parafovea scenes) or a glTF file")
        ->required();
    command->add_option("--method", method_, "full or kfr")->capture_default_str();
    foveation_.add_to(*command);
    command->add_option("--size", size_, "WIDTHxHEIGHT in pixels")->capture_default_str();
    command->add_option("--out", out_, "Picture to write (PNG)")->required();
    command->add_option("--stats", stats_, "Write times, counts and features to this file (JSON)");
    command->add_flag("--no-culling", no_culling_, "kfr: shade the texels that no pixel reads, too");
    command->add_flag("--no-filters", no_filters_, "kfr: without the internal filter");
    command->add_flag("--post-filter", post_filter_, "kfr: with the screen-space filter of Eq. 14");
    command->callback([this] { run(); });
}

void RenderCommand::run() const {
    const SizePx size = parse_size(size_);
    const PointPx gaze = foveation_.gaze_on(size);
    RenderMethod method{method_, {}, {}};
    if (method_ == "kfr") {
        method.numbers = {{"sigma", foveation_.sigma},           {"alpha", foveation_.alpha},
                          {"as_printed", foveation_.as_printed}, {"culling", !no_culling_},
                          {"internal_filter", !no_filters_},     {"post_filter", post_filter_}};
        for (std::size_t i = 0; i < foveation_.betas.size(); ++i)
            method.numbers["beta_" + std::to_string(i + 1)] = foveation_.betas[i];
        method.words = {{"kernel", foveation_.kernel}};
    }

    const Scene scene = load_scene(scene_);
    for (const std::string& warning : scene.warnings)
        std::fprintf(stderr, "parafovea: %s\n", warning.c_str());
    Gpu gpu;
    FrameRenderer renderer(gpu, scene);
    const RenderedFrame frame =
        renderer.render(size, view_through(scene.cameras.front(), size), method, gaze);
    save_png(frame.image, out_);
    if (!stats_.empty()) write_statistics(frame.statistics, stats_);
}

}  // namespace parafovea
