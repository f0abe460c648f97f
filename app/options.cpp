// Reads the small notations of the command line.
#include "app/options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <string_view>

namespace parafovea {

namespace {

// The two numbers around `separator`, or false.
template <typename Number>
bool read_pair(std::string_view text, std::string_view separator, Number& first, Number& second) {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) return false;
    const auto whole = [](std::string_view part, Number& value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size();
    };
    return whole(text.substr(0, at), first) && whole(text.substr(at + separator.size()), second);
}

}  // namespace

SizePx parse_size(const std::string& text) {
    SizePx size;
    if (!read_pair(text, "x", size.width, size.height) || size.width < 1 || size.height < 1)
        throw CLI::ValidationError("--size",
                                   "expected WIDTHxHEIGHT in pixels such as 1280x720, found '" + text + "'");
    return size;
}

PointPx parse_point(const std::string& text) {
    PointPx point;
    if (!read_pair(text, ",", point.x, point.y))
        throw CLI::ValidationError("--gaze", "expected X,Y in pixels such as 640,360, found '" + text + "'");
    return point;
}

std::pair<int, int> parse_range(const std::string& text) {
    std::pair<int, int> range;
    if (!read_pair(text, "..", range.first, range.second) || range.first < 1 || range.second < range.first)
        throw CLI::ValidationError("--balance", "expected FIRST..LAST such as 1..28, found '" + text + "'");
    return range;
}

void add_setting(const std::string& option, const std::string& text, RenderMethod& method) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
        throw CLI::ValidationError(option, "expected NAME=VALUE such as inset=0.05, found '" + text + "'");
    const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
    double number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error == std::errc() && end == value.data() + value.size())
        method.numbers[name] = number;
    else
        method.words[name] = value;
}

}  // namespace parafovea
