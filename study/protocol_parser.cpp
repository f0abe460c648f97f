// Reads a protocol's TOML text into a Protocol, collecting every mistake.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "study/condition_list.h"
#include "study/procedure_parser.h"
#include "study/protocol.h"
#include "study/toml_section.h"

namespace parafovea {
namespace {

constexpr double kUnbounded = 1e9;

template <typename Value>
void keep(Value& target, const std::optional<Value>& found) {
    if (found) target = *found;
}

template <typename Value>
void keep(std::optional<Value>& target, const std::optional<Value>& found) {
    if (found) target = found;
}

void keep_int(int& target, const std::optional<std::int64_t>& found) {
    if (found) target = static_cast<int>(*found);
}

void keep_int(std::optional<int>& target, const std::optional<std::int64_t>& found) {
    if (found) target = static_cast<int>(*found);
}

void read_display(TomlSection& root, DisplaySetting& display) {
    auto section = root.section("display");
    if (!section)
        return root.missing("display",
                            "a table [display] with width_px, height_px, horizontal_fov_deg and refresh_hz");
    const auto width = section->integer("width_px", 16, 32768),
               height = section->integer("height_px", 16, 32768);
    const auto fov = section->number("horizontal_fov_deg", {1, 170});
    const auto refresh = section->number("refresh_hz", {1, 1000});
    if (!width) section->missing("width_px", "width_px = 1280");
    if (!height) section->missing("height_px", "height_px = 1440");
    if (!fov) section->missing("horizontal_fov_deg", "horizontal_fov_deg = 90");
    if (!refresh) section->missing("refresh_hz", "refresh_hz = 90");
    keep_int(display.view.size.width, width);
    keep_int(display.view.size.height, height);
    keep(display.view.horizontal_fov_deg, fov);
    keep(display.refresh_hz, refresh);
    keep(display.peak_luminance_cd_m2, section->number("peak_luminance_cd_m2", {1, 10000}));
    keep(display.photodiode_patch, section->truth("photodiode_patch"));
    section->finish();
}

void read_foveation(TomlSection& root, Protocol& protocol) {
    auto section = root.section("foveation");
    if (!section) return;
    keep(protocol.foveation_gaze, section->word<GazePolicy>("gaze", {{"center", GazePolicy::center},
                                                                     {"tracked", GazePolicy::tracked}}));
    keep(protocol.gaze_stale_after_ms, section->number("stale_after_ms", {1, 10000}));
    section->finish();
}

void read_timing(TomlSection& root, Timing& timing) {
    auto section = root.section("timing");
    if (!section) return root.missing("timing", "a table [timing] with interval_s and gap_s");
    keep(timing.lead_in_s, section->number("lead_in_s", {0, 60}));
    keep(timing.lead_in,
         section->word<LeadIn>("lead_in", {{"black", LeadIn::black}, {"fixation", LeadIn::fixation}}));
    const auto interval = section->number("interval_s", {0.01, 600}), gap = section->number("gap_s", {0, 60});
    if (!interval) section->missing("interval_s", "interval_s = 2.5");
    if (!gap) section->missing("gap_s", "gap_s = 0.75");
    keep(timing.interval_s, interval);
    keep(timing.gap_s, gap);
    keep(timing.response_window_s, section->number("response_window_s", {0.1, 3600}));
    section->finish();
}

void read_design(TomlSection& root, Design& design) {
    auto section = root.section("design");
    if (!section) return root.missing("design", "a table [design] with sessions");
    keep_int(design.participants, section->integer("participants", 1, 100000));
    keep_int(design.training_trials, section->integer("training_trials", 0, 10000));
    const auto sessions = section->integer("sessions", 1, 100);
    if (!sessions) section->missing("sessions", "sessions = 2");
    keep_int(design.sessions, sessions);
    keep_int(design.repetitions, section->integer("repetitions", 1, 1000));
    keep(design.validation_share, section->number("validation_share", {0, 0.9}));
    keep(design.condition_order,
         section->word<ConditionOrder>("condition_order", {{"williams", ConditionOrder::williams},
                                                           {"shuffled", ConditionOrder::shuffled},
                                                           {"listed", ConditionOrder::listed}}));
    keep(design.interval_order,
         section->word<IntervalOrder>("interval_order",
                                      {{"balanced", IntervalOrder::balanced},
                                       {"random", IntervalOrder::random},
                                       {"reference_first", IntervalOrder::reference_first},
                                       {"reference_second", IntervalOrder::reference_second}}));
    if (const auto seed = section->integer("label_seed", 0, std::numeric_limits<std::int64_t>::max()))
        design.label_seed = static_cast<std::uint64_t>(*seed);
    keep(design.scene_use, section->word<SceneUse>("scene_use", {{"per_session", SceneUse::per_session},
                                                                 {"crossed", SceneUse::crossed}}));
    section->finish();
}

void read_rests(TomlSection& root, Rests& rests) {
    auto section = root.section("rests");
    if (!section) return;
    keep(rests.after_session, section->truth("after_session"));
    keep(rests.after_failed_validation, section->truth("after_failed_validation"));
    keep_int(rests.every_trials, section->integer("every_trials", 1, 100000));
    keep(rests.at_least_s, section->number("at_least_s", {0, 3600}));
    section->finish();
}

void read_key(TomlSection& section, std::string_view key, Button& button) {
    const auto name = section.text(key);
    if (!name) return;
    if (const auto found = button_from_name(*name))
        button = *found;
    else
        section.mistake(section.line_of(key),
                        "expected the name of a button for \"" + std::string(key) + "\", found \"" + *name +
                            "\"; write one of a, b, x, y, left_shoulder, right_shoulder, view, menu, up, "
                            "down, left, right");
}

void read_keys(TomlSection& root, Keys& keys) {
    auto section = root.section("keys");
    if (!section) return;
    read_key(*section, "same", keys.same);
    read_key(*section, "different", keys.different);
    read_key(*section, "proceed", keys.proceed);
    if (keys.same == keys.different)
        section->mistake(section->line(),
                         "expected two different buttons for \"same\" and \"different\", found " +
                             std::string(button_name(keys.same)) + " for both; change one");
    section->finish();
}

void read_calibration(TomlSection& root, CalibrationRules& rules) {
    auto section = root.section("calibration");
    if (!section) return;
    if (const auto targets = section->integer("targets", 5, 13)) {
        rules.targets = static_cast<int>(*targets);
        if (*targets != 5 && *targets != 9 && *targets != 13)
            section->mistake(
                section->line_of("targets"),
                "expected 5, 9 or 13 targets, found " + std::to_string(*targets) + "; write targets = 9");
    }
    keep(rules.extent_deg, section->number("extent_deg", {1, 60}));
    keep(rules.each_s, section->number("each_s", {0.7, 30}));
    keep(rules.greatest_mean_accuracy_deg, section->number("greatest_mean_accuracy_deg", {0.1, 90}));
    keep(rules.greatest_loss_share, section->number("greatest_loss_share", {0, 1}));
    keep(rules.drift_check_deg, section->number("drift_check_deg", {0.1, 90}));
    section->finish();
}

void read_validity(TomlSection& root, ValidityRules& rules) {
    auto section = root.section("validity");
    if (!section) return;
    keep(rules.gaze_off_center_deg, section->number("gaze_off_center_deg", {0.1, 90}));
    keep(rules.gaze_off_share, section->number("gaze_off_share", {0, 1}));
    keep(rules.gaze_lost_share, section->number("gaze_lost_share", {0, 1}));
    keep(rules.gaze_age_ms, section->number("gaze_age_ms", {1, 10000}));
    keep_int(rules.missed_frames, section->integer("missed_frames", 0, 1000000));
    keep(rules.unanswered, section->truth("unanswered"));
    keep_int(rules.repeats, section->integer("repeats", 0, 100));
    if (rules.gaze_off_share && !rules.gaze_off_center_deg)
        section->mistake(section->line_of("gaze_off_share"),
                         "expected \"gaze_off_center_deg\" beside \"gaze_off_share\", found none; add e.g. "
                         "gaze_off_center_deg = 3");
    section->finish();
}

void read_exclusion(TomlSection& root, ExclusionRules& rules) {
    auto section = root.section("exclusion");
    if (!section) return;
    keep(rules.failed_validation_share, section->number("failed_validation_share", {0, 1}));
    keep(rules.invalid_trial_share, section->number("invalid_trial_share", {0, 1}));
    section->finish();
}

void read_resume(TomlSection& root, ResumeRules& rules) {
    auto section = root.section("resume");
    if (!section) return;
    keep(rules.restart_after_h, section->number("restart_after_h", {0, kUnbounded}));
    keep(rules.refuse_after_h, section->number("refuse_after_h", {0, kUnbounded}));
    if (rules.refuse_after_h < rules.restart_after_h)
        section->mistake(section->line(),
                         "expected refuse_after_h to be at least restart_after_h, found less; swap them");
    section->finish();
}

void read_questions(TomlSection& root, Questions& questions) {
    auto section = root.section("questions");
    if (!section) return;
    keep(questions.consent, section->truth("consent"));
    keep_int(questions.minimum_age_years, section->integer("minimum_age_years", 0, 120));
    keep(questions.vision, section->truth("vision"));
    keep(questions.sickness_before_after, section->truth("sickness_before_after"));
    section->finish();
}

void read_texts(TomlSection& root, Protocol& protocol) {
    auto section = root.section("texts");
    if (!section)
        return root.missing("texts",
                            "a table [texts." + protocol.language + "] with the participant's pages");
    for (const std::string& language : section->all_keys()) {
        auto words = section->section(language);
        if (!words) continue;
        Texts texts;
        const std::pair<std::string_view, std::string*> pages[] = {
            {"introduction", &texts.introduction},
            {"calibration", &texts.calibration},
            {"recalibrate", &texts.recalibrate},
            {"training", &texts.training},
            {"session", &texts.session},
            {"question", &texts.question},
            {"rest", &texts.rest},
            {"rest_after_failed_validation", &texts.rest_after_failed_validation},
            {"paused", &texts.paused},
            {"finished", &texts.finished}};
        for (const auto& [key, page] : pages) keep(*page, words->text(key));
        if (texts.question.empty())
            words->missing("question", "question = \"Did the two pictures look the same?\"");
        words->finish();
        protocol.texts[language] = std::move(texts);
    }
    if (!protocol.texts.contains(protocol.language))
        section->mistake(section->line(), "expected a table [texts." + protocol.language +
                                              "] for the protocol's language, found none; add it");
}

void read_top(TomlSection& root, Protocol& protocol) {
    const auto name = root.text("name");
    if (!name) {
        root.missing("name", "name = \"final\"");
    } else {
        protocol.name = *name;
        const bool plain = !name->empty() && std::all_of(name->begin(), name->end(), [](unsigned char c) {
            return c < 128 && (std::isalnum(c) || c == '-' || c == '_');
        });
        if (!plain)
            root.mistake(root.line_of("name"),
                         "expected letters, digits, '-' and '_' for \"name\", found \"" + *name +
                             "\"; it becomes part of file names");
    }
    keep(protocol.kind,
         root.word<StudyKind>(
             "kind", {{"free", StudyKind::free}, {"pilot", StudyKind::pilot}, {"final", StudyKind::final}}));
    keep(protocol.description, root.text("description"));
    keep(protocol.language, root.text("language"));
    if (auto scenes = root.texts("scenes"))
        protocol.scenes = *std::move(scenes);
    else
        root.missing("scenes", "scenes = [\"atrium\"]");
}

void check_whole(TomlSection& root, const Protocol& protocol) {
    const int per_session = protocol.conditions_per_session();
    const int distinct = static_cast<int>(protocol.conditions.size());
    if (protocol.design.training_trials > distinct && distinct > 0)
        root.mistake(root.line_of("design"), "expected at most " + std::to_string(distinct) +
                                                 " training_trials, one for each condition, found " +
                                                 std::to_string(protocol.design.training_trials) +
                                                 "; lower it");
    if (per_session > 10000)
        root.mistake(root.line_of("conditions"), "expected at most 10000 trials in a session, found " +
                                                     std::to_string(per_session) +
                                                     "; use fewer factor levels or repetitions");
}

}  // namespace

Protocol parse_protocol(std::string_view text, const std::string& file_name) {
    std::vector<ProtocolMistake> mistakes;
    toml::table table;
    try {
        table = toml::parse(text, std::string_view(file_name));
    } catch (const toml::parse_error& error) {
        throw ProtocolError(file_name, {{std::max(1, static_cast<int>(error.source().begin.line)),
                                         "expected TOML, found a mistake in its grammar: " +
                                             std::string(error.description()) + "; correct the line"}});
    }
    Protocol protocol;
    protocol.source = std::string(text);
    protocol.file_name = file_name;
    TomlSection root(table, "the top of the file", mistakes);
    read_top(root, protocol);
    read_display(root, protocol.display);
    read_foveation(root, protocol);
    read_timing(root, protocol.timing);
    read_conditions(root, protocol);
    read_design(root, protocol.design);
    read_procedure(root, protocol);
    read_rests(root, protocol.rests);
    read_keys(root, protocol.keys);
    read_calibration(root, protocol.calibration);
    read_validity(root, protocol.validity);
    read_exclusion(root, protocol.exclusion);
    read_resume(root, protocol.resume);
    read_questions(root, protocol.questions);
    read_texts(root, protocol);
    root.finish();
    check_whole(root, protocol);
    if (!mistakes.empty()) throw ProtocolError(file_name, std::move(mistakes));
    return protocol;
}

Protocol load_protocol(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        throw std::runtime_error(path.string() +
                                 ": expected a protocol (TOML), found no readable file; check the path");
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    return parse_protocol(text, path.string());
}

}  // namespace parafovea
