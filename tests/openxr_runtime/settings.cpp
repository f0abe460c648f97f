// Reads the simulated headset's settings.
#include "tests/openxr_runtime/settings.h"

#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace parafovea::headset {

namespace {

constexpr std::array<std::pair<std::string_view, EventKind>, 12> kEventNames{{
    {"late", EventKind::late},
    {"negative_time", EventKind::negative_time},
    {"backwards_time", EventKind::backwards_time},
    {"gaze_missing", EventKind::gaze_missing},
    {"gaze_inactive", EventKind::gaze_inactive},
    {"unfocused", EventKind::unfocused},
    {"hidden", EventKind::hidden},
    {"stopping", EventKind::stopping},
    {"exiting", EventKind::exiting},
    {"session_lost", EventKind::session_lost},
    {"recentred", EventKind::recentred},
    {"capture", EventKind::capture},
}};

[[noreturn]] void refuse(std::string_view entry, const std::string& expected) {
    throw std::runtime_error("PARAFOVEA_HEADSET: '" + std::string(entry) + "': expected " + expected);
}

template <typename Number>
Number parse_number(std::string_view text, std::string_view entry) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) refuse(entry, "a number");
    return value;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

void read_gaze(Settings& settings, std::string_view value, std::string_view entry) {
    if (value == "none") {
        settings.gaze = GazeKind::none;
    } else if (value.starts_with("fixed:")) {
        const std::string_view angles = value.substr(6);
        const std::size_t comma = angles.find(',');
        if (comma == std::string_view::npos) refuse(entry, "gaze=fixed:AZIMUTH,ELEVATION in degrees");
        settings.gaze = GazeKind::fixed;
        settings.fixed_gaze = {parse_number<double>(angles.substr(0, comma), entry),
                               parse_number<double>(angles.substr(comma + 1), entry)};
    } else {
        settings.gaze = GazeKind::recording;
        settings.recording = value;
    }
}

void read_setting(Settings& settings, std::string_view name, std::string_view value, std::string_view entry) {
    if (name == "pacing") {
        if (value != "real" && value != "simulated") refuse(entry, "pacing=real or pacing=simulated");
        settings.simulated_pacing = value == "simulated";
    } else if (name == "views") {
        settings.views = parse_number<int>(value, entry);
        if (settings.views != 1 && settings.views != 2 && settings.views != 4)
            refuse(entry, "views=1, views=2 or views=4");
    } else if (name == "refresh_hz") {
        settings.refresh_hz = parse_number<double>(value, entry);
        if (!(settings.refresh_hz >= 1 && settings.refresh_hz <= 1000)) refuse(entry, "a rate in 1..1000");
    } else if (name == "shrink") {
        settings.shrink = parse_number<int>(value, entry);
        if (settings.shrink < 1 || settings.shrink > 32) refuse(entry, "a number in 1..32");
    } else if (name == "gaze") {
        read_gaze(settings, value, entry);
    } else if (name == "gaze_latency_ms") {
        settings.gaze_latency_ms = parse_number<double>(value, entry);
        if (!(settings.gaze_latency_ms >= 0)) refuse(entry, "a latency of at least 0");
    } else if (name == "gaze_times") {
        if (value == "made") {
            settings.sample_times = SampleTimes::made;
        } else if (value == "zero") {
            settings.sample_times = SampleTimes::zero;
        } else if (value == "echo") {
            settings.sample_times = SampleTimes::echo;
        } else {
            refuse(entry, "gaze_times=made, zero or echo");
        }
    } else if (name == "headset") {
        if (value != "plugged" && value != "unplugged") refuse(entry, "headset=plugged or headset=unplugged");
        settings.plugged_in = value == "plugged";
    } else if (name == "without") {
        settings.without.emplace_back(value);
    } else if (name == "log") {
        settings.log = value;
    } else if (name == "capture") {
        settings.capture = value;
    } else if (name == "control") {
        settings.control = value;
    } else {
        refuse(entry, "a known setting");
    }
}

}  // namespace

ScriptedEvent parse_event(std::string_view text, std::int64_t frame) {
    const std::size_t colon = text.find(':');
    const std::string_view name = trimmed(text.substr(0, colon));
    for (const auto& [known, kind] : kEventNames) {
        if (name != known) continue;
        ScriptedEvent event{kind, frame, 1};
        if (colon != std::string_view::npos)
            event.count = parse_number<std::int64_t>(trimmed(text.substr(colon + 1)), text);
        if (event.count < 1) refuse(text, "a count of at least 1");
        return event;
    }
    refuse(text, "a known event");
}

Settings parse_settings(std::string_view text) {
    Settings settings;
    while (!text.empty()) {
        const std::size_t end = text.find_first_of(";\n");
        const std::string_view entry = trimmed(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        if (entry.empty()) continue;
        // A path may hold an '@', so a setting's '=' decides.
        if (const std::size_t equals = entry.find('='); equals != std::string_view::npos) {
            read_setting(settings, entry.substr(0, equals), entry.substr(equals + 1), entry);
        } else if (const std::size_t at = entry.find('@'); at != std::string_view::npos) {
            const std::string_view when = entry.substr(at + 1);
            const std::size_t colon = when.find(':');
            std::string event(entry.substr(0, at));
            if (colon != std::string_view::npos) event += when.substr(colon);
            settings.events.push_back(
                parse_event(event, parse_number<std::int64_t>(when.substr(0, colon), entry)));
        } else {
            refuse(entry, "NAME=VALUE or KIND@FRAME[:COUNT]");
        }
    }
    return settings;
}

}  // namespace parafovea::headset
