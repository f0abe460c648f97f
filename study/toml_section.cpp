// Strict reading of a TOML table, with every mistake named by its line.
#include "study/toml_section.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "study/word_list.h"

namespace parafovea {
namespace {

std::string short_number(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

// Insertions, deletions and replacements that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
            diagonal = above;
        }
    }
    return row[b.size()];
}

}  // namespace

std::string as_found(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return '"' + *text + '"';
    if (const auto whole = node.value_exact<std::int64_t>()) return std::to_string(*whole);
    if (const auto number = node.value_exact<double>()) return short_number(*number);
    if (const auto truth = node.value_exact<bool>()) return *truth ? "true" : "false";
    if (node.is_array()) return "a list";
    if (node.is_table()) return "a table";
    return "a date or time";
}

int line_of(const toml::node& node) {
    return std::max(1, static_cast<int>(node.source().begin.line));
}

TomlSection::TomlSection(const toml::table& table, std::string name, std::vector<ProtocolMistake>& mistakes)
    : table_(&table), name_(std::move(name)), mistakes_(&mistakes) {}

int TomlSection::line() const {
    return parafovea::line_of(*table_);
}

int TomlSection::line_of(std::string_view key) const {
    const auto found = table_->find(key);
    if (found == table_->end()) return line();
    return std::max(1, static_cast<int>(found->first.source().begin.line));
}

void TomlSection::mistake(int line, std::string message) {
    mistakes_->push_back({line, std::move(message)});
}

void TomlSection::missing(std::string_view key, std::string_view example) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
    if (has(key)) return;  // there, but wrong: already said
    missing_.emplace_back(key, example);
}

const toml::node* TomlSection::asked(std::string_view key) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
    return table_->get(key);
}

const toml::node* TomlSection::any(std::string_view key) {
    return asked(key);
}

std::optional<std::string> TomlSection::text(std::string_view key) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    if (auto value = node->value_exact<std::string>()) return value;
    mistake(line_of(key), "expected a text for \"" + std::string(key) + "\", found " + as_found(*node) +
                              "; put it in quotes");
    return std::nullopt;
}

std::optional<double> TomlSection::number(std::string_view key, NumberRange range) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (value && std::isfinite(*value) && *value >= range.low && *value <= range.high) return value;
    mistake(line_of(key), "expected a number from " + short_number(range.low) + " to " +
                              short_number(range.high) + " for \"" + std::string(key) + "\", found " +
                              as_found(*node) + "; change it");
    return std::nullopt;
}

std::optional<std::int64_t> TomlSection::integer(std::string_view key, std::int64_t low, std::int64_t high) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    const auto value = node->value_exact<std::int64_t>();
    if (value && *value >= low && *value <= high) return value;
    mistake(line_of(key), "expected a whole number from " + std::to_string(low) + " to " +
                              std::to_string(high) + " for \"" + std::string(key) + "\", found " +
                              as_found(*node) + "; change it");
    return std::nullopt;
}

std::optional<bool> TomlSection::truth(std::string_view key) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    if (const auto value = node->value_exact<bool>()) return value;
    mistake(line_of(key), "expected true or false for \"" + std::string(key) + "\", found " +
                              as_found(*node) + "; change it");
    return std::nullopt;
}

std::optional<std::vector<std::string>> TomlSection::texts(std::string_view key) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    const toml::array* array = node->as_array();
    std::vector<std::string> values;
    bool good = array != nullptr && !array->empty();
    if (array)
        for (const toml::node& item : *array) {
            const auto value = item.value_exact<std::string>();
            good = good && value && !value->empty();
            if (value) values.push_back(*value);
        }
    if (good) return values;
    mistake(line_of(key), "expected a list of texts for \"" + std::string(key) + "\", found " +
                              (array ? "a list that is empty or has something else in it" : as_found(*node)) +
                              "; write e.g. " + std::string(key) + " = [\"one\", \"two\"]");
    return std::nullopt;
}

std::optional<std::size_t> TomlSection::place_of_word(std::string_view key,
                                                      const std::vector<std::string_view>& names) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    if (const auto value = node->value_exact<std::string>()) {
        const auto place = std::find(names.begin(), names.end(), *value);
        if (place != names.end()) return place - names.begin();
    }
    mistake(line_of(key), "expected one of " + joined(names) + " for \"" + std::string(key) + "\", found " +
                              as_found(*node) + "; write one of them in quotes");
    return std::nullopt;
}

std::optional<TomlSection> TomlSection::section(std::string_view key) {
    const toml::node* node = asked(key);
    if (!node) return std::nullopt;
    const std::string inside =
        table_->get(key) && name_.front() == '[' ? name_.substr(1, name_.size() - 2) + "." : "";
    const std::string header = "[" + inside + std::string(key) + "]";
    if (const toml::table* table = node->as_table()) return TomlSection(*table, header, *mistakes_);
    mistake(line_of(key), "expected a table " + header + ", found " + as_found(*node) +
                              "; write its keys under a line " + header);
    return std::nullopt;
}

std::vector<std::string> TomlSection::all_keys() {
    std::vector<std::pair<toml::source_position, std::string>> keys;
    for (auto&& [key, value] : *table_) {
        keys.emplace_back(key.source().begin, std::string(key.str()));
        asked(key.str());
    }
    // The library sorts by name; the file's order is what its author meant.
    std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> names;
    for (auto& [position, key] : keys) names.push_back(std::move(key));
    return names;
}

void TomlSection::finish() {
    std::vector<std::string> misspelt;  // missing only because the file has it under another spelling
    for (auto&& [key, value] : *table_) {
        const std::string_view found = key.str();
        if (std::find(asked_.begin(), asked_.end(), found) != asked_.end()) continue;
        const auto nearest = std::min_element(
            asked_.begin(), asked_.end(),
            [&](const auto& a, const auto& b) { return edit_distance(a, found) < edit_distance(b, found); });
        const bool close = nearest != asked_.end() && edit_distance(*nearest, found) <= 1 + found.size() / 3;
        if (close) misspelt.push_back(*nearest);
        mistake(line_of(found),
                "expected one of the keys " + joined(asked_) + " in " + name_ + ", found \"" +
                    std::string(found) + "\"; " +
                    (close ? "write " + *nearest + " if that is meant" : "remove or rename it"));
    }
    for (const auto& [key, example] : missing_) {
        if (std::find(misspelt.begin(), misspelt.end(), key) != misspelt.end()) continue;
        mistake(line(), "expected the key \"" + key + "\" in " + name_ + ", found none; add e.g. " + example);
    }
}

}  // namespace parafovea
