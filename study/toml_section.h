// Reads one table of a TOML file strictly: every key is asked for by name, and what was not asked for is a
// mistake.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "study/protocol.h"

namespace parafovea {

// The numbers a key may have; the ends count as inside.
struct NumberRange {
    double low, high;
};

// Mistakes are collected, not thrown, so that a reader sees all of them; a call that found one returns
// nothing.
class TomlSection {
  public:
    // `name` is how the table is written, e.g. "[timing]"; "the top of the file" for the root.
    TomlSection(const toml::table& table, std::string name, std::vector<ProtocolMistake>& mistakes);

    std::optional<std::string> text(std::string_view key);
    std::optional<double> number(std::string_view key, NumberRange range);
    std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high);
    std::optional<bool> truth(std::string_view key);
    std::optional<std::vector<std::string>> texts(std::string_view key);

    // One of the words given, by its place among them.
    template <typename Value>
    std::optional<Value> word(std::string_view key,
                              std::initializer_list<std::pair<std::string_view, Value>> words) {
        std::vector<std::string_view> names;
        for (const auto& [name, value] : words) names.push_back(name);
        if (const auto place = place_of_word(key, names)) return words.begin()[*place].second;
        return std::nullopt;
    }

    // A table inside this one, or nothing where the file has none. The caller keeps it until its finish().
    std::optional<TomlSection> section(std::string_view key);

    // Any value, e.g. for a key whose value may be a number or a word.
    const toml::node* any(std::string_view key);

    // The keys the file has here, in its order, each counted as asked for.
    std::vector<std::string> all_keys();

    bool has(std::string_view key) const { return table_->contains(key); }
    const std::string& name() const { return name_; }
    int line() const;
    int line_of(std::string_view key) const;

    void mistake(int line, std::string message);
    // "expected the key ..., found none; add ...", said by finish() unless the key turns out to be misspelt.
    void missing(std::string_view key, std::string_view example);

    // Reports every key that was never asked for, and every missing one. To be called once, at the end.
    void finish();

  private:
    const toml::node* asked(std::string_view key);
    std::optional<std::size_t> place_of_word(std::string_view key,
                                             const std::vector<std::string_view>& names);

    const toml::table* table_;
    std::string name_;
    std::vector<ProtocolMistake>* mistakes_;
    std::vector<std::string> asked_;
    std::vector<std::pair<std::string, std::string>> missing_;  // key, example
};

// A value as a reader would write it, for "found ...".
std::string as_found(const toml::node& node);

int line_of(const toml::node& node);

}  // namespace parafovea
