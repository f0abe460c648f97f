// What a protocol implies: trial counts, its hash, and how its mistakes read.
#include "study/protocol.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace parafovea {
namespace {

constexpr std::pair<std::string_view, Button> kButtons[] = {{"a", Button::a},
                                                            {"b", Button::b},
                                                            {"x", Button::x},
                                                            {"y", Button::y},
                                                            {"left_shoulder", Button::left_shoulder},
                                                            {"right_shoulder", Button::right_shoulder},
                                                            {"view", Button::view},
                                                            {"menu", Button::menu},
                                                            {"up", Button::up},
                                                            {"down", Button::down},
                                                            {"left", Button::left},
                                                            {"right", Button::right}};

std::string all_lines(const std::string& file_name, const std::vector<ProtocolMistake>& mistakes) {
    std::string text;
    for (const ProtocolMistake& mistake : mistakes)
        text += (text.empty() ? "" : "\n") + file_name + ":" + std::to_string(mistake.line) + ": " +
                mistake.message;
    return text;
}

std::vector<ProtocolMistake> by_line(std::vector<ProtocolMistake> mistakes) {
    std::stable_sort(mistakes.begin(), mistakes.end(),
                     [](const auto& a, const auto& b) { return a.line < b.line; });
    return mistakes;
}

}  // namespace

int Protocol::conditions_per_session() const {
    const int scenes_each = design.scene_use == SceneUse::crossed ? static_cast<int>(scenes.size()) : 1;
    return static_cast<int>(conditions.size()) * scenes_each * design.repetitions;
}

int Protocol::validation_per_session() const {
    const double share = design.validation_share;
    return static_cast<int>(std::lround(conditions_per_session() * share / (1 - share)));
}

ProtocolError::ProtocolError(const std::string& file_name, std::vector<ProtocolMistake> found)
    : std::runtime_error(all_lines(file_name, by_line(found))), mistakes_(by_line(std::move(found))) {}

std::string protocol_hash(const Protocol& protocol) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const unsigned char byte : protocol.source) hash = (hash ^ byte) * 0x100000001b3u;
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::string_view button_name(Button button) {
    for (const auto& [name, value] : kButtons)
        if (value == button) return name;
    return "unknown";
}

std::optional<Button> button_from_name(std::string_view name) {
    for (const auto& [known, value] : kButtons)
        if (known == name) return value;
    return std::nullopt;
}

}  // namespace parafovea
