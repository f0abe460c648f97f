// Crosses factors into conditions.
#include "study/condition_list.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

namespace parafovea {
namespace {

using Level = std::variant<double, std::string>;

void set_parameter(MethodSetting& setting, const std::string& name, const Level& level) {
    if (name == "method")
        setting.method = std::get<std::string>(level);
    else if (const double* number = std::get_if<double>(&level))
        setting.numbers[name] = *number;
    else
        setting.words[name] = std::get<std::string>(level);
}

// A number, a word, or a switch (which counts as 0 or 1).
std::optional<Level> level_of(const toml::node& node) {
    if (const auto truth = node.value_exact<bool>()) return Level(*truth ? 1.0 : 0.0);
    if (node.is_number())
        if (const auto number = node.value<double>(); number && std::isfinite(*number)) return Level(*number);
    // Words are restricted to what the canonical text of a setting can hold.
    if (const auto word = node.value_exact<std::string>())
        if (!word->empty() && word->find_first_of("(),=") == std::string::npos) return Level(*word);
    return std::nullopt;
}

std::vector<Level> levels_of_range(TomlSection& section, const std::string& name, const toml::table& table,
                                   std::vector<ProtocolMistake>& mistakes) {
    TomlSection range(table, "the range of " + name, mistakes);
    const NumberRange any{-1e9, 1e9};
    const auto from = range.number("from", any), to = range.number("to", any),
               step = range.number("step", any);
    if (!from) range.missing("from", "from = 1.2");
    if (!to) range.missing("to", "to = 2.4");
    if (!step) range.missing("step", "step = 0.2");
    range.finish();
    if (!from || !to || !step) return {};
    const std::vector<double> numbers = stepped_numbers(*from, *to, *step);
    if (numbers.empty())
        section.mistake(section.line_of(name),
                        "expected whole steps (at most 10000) from \"from\" to \"to\" for \"" + name +
                            "\", found from = " + as_found(*table.get("from")) +
                            ", to = " + as_found(*table.get("to")) +
                            ", step = " + as_found(*table.get("step")) + "; change one of them");
    return {numbers.begin(), numbers.end()};
}

std::vector<Level> levels_of_list(TomlSection& section, const std::string& name, const toml::array& array) {
    std::vector<Level> levels;
    for (const toml::node& item : array) {
        const auto level = level_of(item);
        const bool right = level && (name != "method" || std::holds_alternative<std::string>(*level));
        if (!right)
            section.mistake(line_of(item), "expected numbers or words for \"" + name + "\", found " +
                                               as_found(item) + "; change it");
        else if (std::find(levels.begin(), levels.end(), *level) != levels.end())
            section.mistake(line_of(item), "expected different levels for \"" + name + "\", found " +
                                               as_found(item) + " twice; remove one");
        else
            levels.push_back(*level);
    }
    if (array.empty())
        section.mistake(section.line_of(name),
                        "expected at least one level for \"" + name + "\", found an empty list; add one");
    return levels;
}

void read_parameters(TomlSection& section, MethodSetting& setting) {
    for (const std::string& name : section.all_keys()) {
        const auto level = level_of(*section.any(name));
        if (!level || (name == "method" && !std::holds_alternative<std::string>(*level)))
            section.mistake(section.line_of(name), "expected a number, a word or true/false for \"" + name +
                                                       "\", found " + as_found(*section.any(name)) +
                                                       "; change it");
        else
            set_parameter(setting, name, *level);
    }
}

void cross_factors(TomlSection& factors, const MethodSetting& start, Protocol& protocol,
                   std::vector<ProtocolMistake>& mistakes) {
    std::vector<MethodSetting> crossed = {start};
    for (const std::string& name : factors.all_keys()) {
        const toml::node& node = *factors.any(name);
        std::vector<Level> levels;
        if (const toml::array* array = node.as_array())
            levels = levels_of_list(factors, name, *array);
        else if (const toml::table* table = node.as_table())
            levels = levels_of_range(factors, name, *table, mistakes);
        else
            factors.mistake(factors.line_of(name), "expected a list or { from, to, step } for \"" + name +
                                                       "\", found " + as_found(node) + "; write e.g. " +
                                                       name + " = [1, 2, 3, 4]");
        if (crossed.size() * levels.size() > 10000) {
            factors.mistake(factors.line_of(name),
                            "expected at most 10000 conditions, found more; use fewer levels");
            return;
        }
        std::vector<MethodSetting> next;
        for (const MethodSetting& setting : crossed)
            for (const Level& level : levels) {
                next.push_back(setting);
                set_parameter(next.back(), name, level);
            }
        crossed = std::move(next);
        protocol.factors.push_back(name);
    }
    protocol.conditions = std::move(crossed);
}

void read_list(TomlSection& section, const MethodSetting& start, Protocol& protocol,
               std::vector<ProtocolMistake>& mistakes) {
    const toml::array* array = section.any("list")->as_array();
    if (!array || array->empty() ||
        !std::all_of(array->begin(), array->end(), [](const toml::node& item) { return item.is_table(); }))
        return section.mistake(
            section.line_of("list"),
            "expected tables [[conditions.list]], found something else; write one for each condition");
    std::vector<std::string> names;
    for (const toml::node& item : *array) {
        TomlSection entry(*item.as_table(), "[[conditions.list]]", mistakes);
        MethodSetting setting = start;
        read_parameters(entry, setting);
        for (const std::string& name : entry.all_keys())
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        if (std::find(protocol.conditions.begin(), protocol.conditions.end(), setting) !=
            protocol.conditions.end())
            section.mistake(entry.line(), "expected different conditions, found " + to_text(setting) +
                                              " twice; remove one");
        protocol.conditions.push_back(std::move(setting));
    }
    protocol.factors = std::move(names);
}

}  // namespace

std::vector<double> stepped_numbers(double from, double to, double step) {
    const double steps = (to - from) / step;
    if (!(steps >= 0) || steps > 10000 || std::abs(steps - std::round(steps)) > 1e-6) return {};
    std::vector<double> numbers;
    for (int i = 0; i <= static_cast<int>(std::round(steps)); ++i)
        numbers.push_back(std::round((from + i * step) * 1e9) / 1e9);
    return numbers;
}

void read_conditions(TomlSection& root, Protocol& protocol) {
    auto section = root.section("conditions");
    if (!section) return root.missing("conditions", "a table [conditions] with method and factors");
    std::vector<ProtocolMistake> mistakes;

    MethodSetting start;
    start.method.clear();
    if (const auto method = section->text("method")) start.method = *method;
    if (const auto reference = section->text("reference")) protocol.reference.method = *reference;
    if (auto fixed = section->section("fixed")) read_parameters(*fixed, start);

    auto factors = section->section("factors");
    if (factors && section->has("list")) {
        section->mistake(section->line_of("list"),
                         "expected either factors or a list, found both; remove one");
    } else if (factors) {
        cross_factors(*factors, start, protocol, mistakes);
    } else if (section->any("list")) {
        read_list(*section, start, protocol, mistakes);
    } else {
        section->missing("factors", "a table [conditions.factors] with e.g. alpha = [1, 2, 3, 4]");
    }
    for (auto& [line, message] : mistakes) section->mistake(line, std::move(message));
    if (!protocol.conditions.empty() && protocol.conditions.front().method.empty())
        section->missing("method", "method = \"kfr\"");
    section->finish();
}

}  // namespace parafovea
