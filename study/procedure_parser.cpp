// The keys of [procedure].
#include "study/procedure_parser.h"

#include <algorithm>
#include <cmath>

#include "study/condition_list.h"

namespace parafovea {
namespace {

// A range { from, to, step } or a list of numbers, ascending.
std::vector<double> read_numbers(TomlSection& section, const std::string& key) {
    const toml::node* node = section.any(key);
    if (!node) return {};
    std::vector<double> numbers;
    if (const toml::table* table = node->as_table()) {
        const auto from = (*table)["from"].value<double>(), to = (*table)["to"].value<double>(),
                   step = (*table)["step"].value<double>();
        if (from && to && step && table->size() == 3) numbers = stepped_numbers(*from, *to, *step);
    } else if (const toml::array* array = node->as_array()) {
        for (const toml::node& item : *array) {
            const auto number = item.is_number() ? item.value<double>() : std::nullopt;
            if (!number || !std::isfinite(*number))
                return section.mistake(line_of(item), "expected a number in \"" + key + "\", found " +
                                                          as_found(item) + "; change it"),
                       std::vector<double>();
            numbers.push_back(*number);
        }
    }
    const bool ascends =
        std::is_sorted(numbers.begin(), numbers.end(), [](double a, double b) { return a <= b; });
    if (numbers.empty() || !ascends) {
        section.mistake(section.line_of(key), "expected ascending numbers for \"" + key + "\", found " +
                                                  as_found(*node) + "; write e.g. " + key +
                                                  " = { from = 1.2, to = 2.4, step = 0.1 }");
        return {};
    }
    return numbers;
}

void read_staircase(TomlSection& section, Staircase& staircase) {
    const auto start = section.number("start", {-1e9, 1e9});
    if (!start) section.missing("start", "start = 2.4");
    const auto at =
        start ? std::find(staircase.levels.begin(), staircase.levels.end(), *start) : staircase.levels.end();
    if (at != staircase.levels.end())
        staircase.start = static_cast<int>(at - staircase.levels.begin());
    else if (start && !staircase.levels.empty())
        section.mistake(section.line_of("start"),
                        "expected one of the levels for \"start\", found another number; choose a level");
    if (const auto value = section.integer("down_after", 1, 10))
        staircase.down_after = static_cast<int>(*value);
    if (const auto value = section.integer("step_up", 1, 1000)) staircase.step_up = static_cast<int>(*value);
    if (const auto value = section.integer("step_down", 1, 1000))
        staircase.step_down = static_cast<int>(*value);
}

void read_quest_plus(TomlSection& section, QuestPlus& quest) {
    if (const auto shape = section.word<PsychometricShape>(
            "shape", {{"normal", PsychometricShape::normal}, {"weibull_db", PsychometricShape::weibull_db}}))
        quest.shape = *shape;
    quest.thresholds = read_numbers(section, "thresholds");
    quest.slopes = read_numbers(section, "slopes");
    if (quest.thresholds.empty())
        section.missing("thresholds", "thresholds = { from = 1.2, to = 2.4, step = 0.1 }");
    if (quest.slopes.empty()) section.missing("slopes", "slopes = [0.2, 0.4, 0.8]");
    if (!quest.slopes.empty() && quest.slopes.front() <= 0)
        section.mistake(section.line_of("slopes"),
                        "expected numbers above 0 for \"slopes\", found others; change them");
    for (const auto& [key, shares] :
         {std::pair("guesses", &quest.guesses), std::pair("lapses", &quest.lapses)}) {
        if (!section.has(key)) continue;
        *shares = read_numbers(section, key);
        if (!shares->empty() && (shares->front() < 0 || shares->back() >= 0.5))
            section.mistake(section.line_of(key), std::string("expected shares from 0 to below 0.5 for \"") +
                                                      key + "\", found others; change them");
    }
}

}  // namespace

void read_procedure(TomlSection& root, Protocol& protocol) {
    auto section = root.section("procedure");
    if (!section) return;
    Procedure procedure;
    const auto kind = section->word<bool>("kind", {{"staircase", false}, {"quest_plus", true}});
    if (!kind) section->missing("kind", "kind = \"staircase\"");
    if (const auto parameter = section->text("parameter"))
        procedure.parameter = *parameter;
    else
        section->missing("parameter", "parameter = \"sigma\"");
    if (std::find(protocol.factors.begin(), protocol.factors.end(), procedure.parameter) !=
        protocol.factors.end())
        section->mistake(section->line_of("parameter"), "expected a parameter that is no factor, found \"" +
                                                            procedure.parameter +
                                                            "\"; take it out of the conditions");
    procedure.staircase.levels = read_numbers(*section, "levels");
    if (procedure.staircase.levels.empty())
        section->missing("levels", "levels = { from = 1.2, to = 2.4, step = 0.1 }");
    const auto trials = section->integer("trials", 1, 1000);
    if (!trials) section->missing("trials", "trials = 30");
    if (const auto design = root.section("design"); design && design->has("repetitions"))
        section->mistake(section->line(),
                         "expected no design.repetitions beside a procedure, found some; [procedure] trials "
                         "takes their place");
    protocol.design.repetitions = static_cast<int>(trials.value_or(1));
    if (kind && *kind) {
        procedure.quest_plus.emplace();
        procedure.quest_plus->levels = procedure.staircase.levels;
        read_quest_plus(*section, *procedure.quest_plus);
    } else if (kind) {
        read_staircase(*section, procedure.staircase);
    }
    section->finish();
    protocol.procedure = std::move(procedure);
}

}  // namespace parafovea
