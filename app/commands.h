// The subcommands of the program: each holds its options, adds itself to the command line and can be run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/kernel_setting.h"

namespace parafovea {

class FrameRenderer;
struct RenderMethod;
struct Scene;

class RunCommand {
  public:
    explicit RunCommand(CLI::App& program);

  private:
    void run() const;

    std::string protocol_, participant_, data_ = "sessions", display_ = "window", gaze_, controller_;
    std::optional<std::uint64_t> seed_;
    bool resume_ = false;
    int monitor_ = 0;
    bool full_screen_ = false, no_console_ = false, hash_pictures_ = false;
    bool quiet_ = false;
};

class ReplayCommand {
  public:
    explicit ReplayCommand(CLI::App& program);

  private:
    void run() const;

    std::string session_, out_;
    bool verify_ = false, quiet_ = false;
};

class DevicesCommand {
  public:
    explicit DevicesCommand(CLI::App& program);
};

class PlanCommand {
  public:
    explicit PlanCommand(CLI::App& program);

  private:
    void run() const;

    std::string protocol_, participant_, balance_;
    std::uint64_t seed_ = 0;
};

class CheckCommand {
  public:
    explicit CheckCommand(CLI::App& program);

  private:
    void run() const;

    std::string protocol_;
};

class SimulateCommand {
  public:
    explicit SimulateCommand(CLI::App& program);

  private:
    void run() const;

    std::string protocol_, out_;
    int participants_ = 0;
    std::uint64_t seed_ = 0;
    bool quiet_ = false;
};

class AnalyzeCommand {
  public:
    explicit AnalyzeCommand(CLI::App& program);

  private:
    void run() const;

    std::vector<std::string> inputs_;
    std::string out_;
    bool overdispersion_ = false;
};

// What `analyze` does, and `simulate` at its end: writes the results into `out`, prints Table 1 and where the
// files are.
void analyze_and_print(const std::vector<std::string>& inputs, const std::string& out,
                       bool overdispersion = false);

// The options that say how a picture is foveated, common to several commands.
struct FoveationOptions {
    std::optional<double> sigma, alpha;  // what is absent is as the method has it
    std::optional<std::string> kernel;
    std::vector<double> betas;
    std::string gaze;  // "X,Y" in pixels; empty: the centre
    bool as_printed = false;

    void add_to(CLI::App& command);
    // The kernel log-polar map that the options describe.
    KernelSetting kernel_setting() const;
    // Puts what was given into a method's parameters.
    void add_to(RenderMethod& method) const;
    // The gaze on a picture of this size.
    PointPx gaze_on(SizePx size) const;
};

class RenderCommand {
  public:
    explicit RenderCommand(CLI::App& program);

  private:
    void run() const;

    RenderMethod wanted_method() const;
    void render_frames(FrameRenderer& renderer, const Scene& scene) const;
    void write_sheet(FrameRenderer& renderer, const Scene& scene) const;

    std::string scene_, method_ = "kfr", size_ = "1280x720", out_, stats_, eye_fov_;
    FoveationOptions foveation_;
    std::vector<std::string> settings_;
    std::optional<double> path_s_, path_seconds_, contrast_;
    int taa_ = 0, views_ = 1, frames_ = 0;
    double ipd_mm_ = 63, gaze_distance_m_ = 2;
    bool no_culling_ = false;
    bool no_filters_ = false;
    bool post_filter_ = false;
    bool sheet_ = false;
};

class FoveateCommand {
  public:
    explicit FoveateCommand(CLI::App& program);

  private:
    void run() const;

    std::string in_, out_;
    FoveationOptions foveation_;
    bool no_filters_ = false;
};

class ExportCommand {
  public:
    explicit ExportCommand(CLI::App& program);

  private:
    void run() const;

    std::vector<std::string> inputs_;
    std::string format_, out_;
};

struct PowerPoint;
struct PowerQuestion;

class PowerCommand {
  public:
    explicit PowerCommand(CLI::App& program);

  private:
    void run() const;
    void merge_shards() const;
    void report(const std::vector<PowerPoint>& points, const PowerQuestion& question) const;

    std::string protocol_, assume_, shard_, out_;
    std::vector<std::string> merge_;
    std::vector<int> participants_;
    std::vector<double> effects_ = {0, 1};
    int studies_ = 1000;
    std::uint64_t seed_ = 1;
    bool quiet_ = false;
};

class WithdrawCommand {
  public:
    explicit WithdrawCommand(CLI::App& program);

  private:
    void run() const;

    std::string participant_, data_ = "sessions";
};

class BenchCommand {
  public:
    explicit BenchCommand(CLI::App& program);

  private:
    void run() const;

    std::vector<std::string> scenes_ = {"atrium", "primitives"};
    std::vector<std::string> sizes_ = {"1920x1080", "2560x1440", "3840x2160"};
    std::vector<std::string> methods_;
    std::string out_;
    int rounds_ = 5;
    int samples_ = 1;
    std::string shading_ = "auto";
    bool moving_gaze_ = false;
    bool still_ = false;
    bool no_needs_ = false;
    bool quiet_ = false;
};

class TradeoffCommand {
  public:
    explicit TradeoffCommand(CLI::App& program);

  private:
    void run() const;
    void merge() const;
    void predict() const;
    std::string command_line() const;

    std::vector<std::string> scenes_ = {"atrium"};
    std::vector<std::string> methods_, settings_;
    std::vector<std::string> sizes_ = {"1280x720"};
    std::vector<std::string> gazes_ = {"centre"};
    std::vector<std::string> motions_ = {"still", "path"};
    std::vector<std::string> merge_;
    std::string protocol_, gaze_recording_, shard_, predict_, out_;
    int participants_ = 18;
    double fov_deg_ = 100, peak_cd_m2_ = 100, refresh_hz_ = 70, gaze_age_ms_ = 0;
    int rounds_ = 3, frames_ = 5, taa_ = 0, reference_samples_ = 16;
    std::uint64_t seed_ = 1;
    bool quiet_ = false;
};

class ScenesCommand {
  public:
    explicit ScenesCommand(CLI::App& program);

  private:
    void run() const;
};

}  // namespace parafovea
