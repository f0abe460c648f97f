// parafovea replay: a recorded session again, from its plan, gaze and buttons.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "app/commands.h"
#include "app/eye_pictures.h"
#include "app/picture_source.h"
#include "app/progress.h"
#include "app/window_stage.h"
#include "app/window_surface.h"
#include "renderer/image.h"
#include "study/protocol.h"
#include "study/session_log_reader.h"
#include "study/session_replay.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

// Renders what is replayed, a picture that goes on over many frames once.
class ReplayedPictures {
  public:
    // `eyes`: of the headset that the session was shown on.
    ReplayedPictures(const ViewGeometry& view, fs::path folder, std::optional<Eyes> eyes)
        : pictures_(view), folder_(std::move(folder)), eyes_(std::move(eyes)) {
        if (!eyes_) return;
        gpu_ = std::make_unique<Gpu>();
        eye_pictures_ = std::make_unique<EyePictures>(*gpu_);
    }

    std::optional<std::uint64_t> hash_of(const Picture& picture) {
        if (picture.kind != PictureKind::stimulus) return std::nullopt;
        if (last_ && last_->scene == picture.scene && last_->method == picture.method &&
            last_->fovea == picture.fovea)
            return last_hash_;
        last_ = picture;
        if (eyes_) {
            last_hash_ = 0;
            for (std::size_t i = 0; i < eyes_->views.size(); ++i) {
                const EyePictures::Drawn drawn = eye_pictures_->draw(*eyes_, i, picture, true);
                last_hash_ = EyePictures::combine(last_hash_, *drawn.pixels);
                save(*drawn.pixels);
            }
            return last_hash_;
        }
        const RenderedPicture rendered = pictures_.picture(picture.scene, picture.method, picture.fovea);
        last_hash_ = rendered.hash;
        save(rendered);
        return last_hash_;
    }

    PictureSource& source() { return pictures_; }

  private:
    void save(const RenderedPicture& rendered) {
        if (folder_.empty() || !saved_.insert(rendered.hash).second) return;
        char name[32];
        std::snprintf(name, sizeof name, "%016llx.png", static_cast<unsigned long long>(rendered.hash));
        save_png({rendered.size, rendered.rgba}, folder_ / name);
    }

    PictureSource pictures_;
    fs::path folder_;
    std::optional<Eyes> eyes_;
    std::unique_ptr<Gpu> gpu_;
    std::unique_ptr<EyePictures> eye_pictures_;
    std::optional<Picture> last_;
    std::uint64_t last_hash_ = 0;
    std::set<std::uint64_t> saved_;
};

// The participant's window, on which a session is shown again at its own pace.
struct ReplayWindow {
    WindowSystem system;
    Monitor monitor = connected_monitors().front();
    SteadyClock clock;
    WindowSurface surface;
    WindowStage stage;

    ReplayWindow(const Protocol& protocol, PictureSource& pictures)
        : surface({.title = "Parafovea: replay", .size = size_on(monitor, protocol.display.view.size)}),
          stage(surface, monitor, protocol, clock, pictures, nullptr) {}

    static SizePx size_on(const Monitor& monitor, SizePx picture) {
        const double scale = placement_of(picture, monitor.size).scale;
        return {static_cast<int>(scale * picture.width), static_cast<int>(scale * picture.height)};
    }
};

}  // namespace

ReplayCommand::ReplayCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("replay", "Show a recorded session again, or verify it");
    command->footer("Example: parafovea replay sessions/final_P01_20260131T101500Z.sqlite --verify");
    command->add_option("session", session_, "Session file")->required();
    command->add_flag(
        "--verify", verify_,
        "Render every stimulus again and compare pictures and rows, as fast as it goes, without a window");
    command->add_option("--out", out_, "Folder for the stimuli as PNG files, named by their hashes");
    command->add_flag("--quiet", quiet_, "No progress");
    command->callback([this] { run(); });
}

void ReplayCommand::run() const {
    const SessionRows rows = read_session(session_);
    const Protocol protocol = parse_protocol(rows.protocol_text, rows.protocol_file);
    if (!out_.empty()) {
        std::error_code error;
        fs::create_directories(out_, error);
        if (error)
            throw std::runtime_error(out_ + ": cannot make this folder (" + error.message() +
                                     "); name another with --out");
    }
    const auto eyes = rows.facts.other.find("eyes");
    ReplayedPictures pictures(
        protocol.display.view, out_,
        eyes == rows.facts.other.end() ? std::nullopt : std::optional(parse_eyes(eyes->second)));
    std::unique_ptr<ReplayWindow> window;
    if (!verify_) window = std::make_unique<ReplayWindow>(protocol, pictures.source());

    Progress bar("showing", static_cast<int>(rows.trials.size()), quiet_);
    const ReplayReport report = replay_session(
        session_,
        [&](const Picture& picture, const ShownFrame& recorded) -> std::optional<std::uint64_t> {
            if (window) {
                window->stage.show(picture);
                window->system.wait_for_events(0);
                if (window->surface.close_requested())
                    throw std::runtime_error("the replay's window was closed");
            }
            // A frame that was not rendered then has nothing to be compared with.
            if (!recorded.image_hash) return std::nullopt;
            return pictures.hash_of(picture);
        },
        [&](int done, int) { bar.update(done, ""); });

    std::printf("%d showings, %lld frames, %lld pictures rendered and compared\n", report.trials,
                static_cast<long long>(report.frames), static_cast<long long>(report.images));
    for (const std::string& difference : report.differences) std::printf("%s\n", difference.c_str());
    if (!verify_) return;
    if (!report.differences.empty())
        throw std::runtime_error(session_ + ": differs from what its plan, gaze and buttons give in " +
                                 std::to_string(report.differences.size()) + " places, listed above");
    std::printf("every row and every picture is equal\n");
}

}  // namespace parafovea
