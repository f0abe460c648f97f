// The canonical text of a method and its parameters, and back.
#include "study/method_setting.h"

#include <charconv>
#include <stdexcept>

namespace parafovea {
namespace {

std::string shortest(double value) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, end);
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
    throw std::runtime_error("method setting \"" + std::string(text) +
                             "\": expected e.g. \"kfr(alpha=4,sigma=1.8)\", found " + why);
}

}  // namespace

std::string to_text(const MethodSetting& setting) {
    std::map<std::string, std::string> parameters(setting.words.begin(), setting.words.end());
    for (const auto& [name, value] : setting.numbers) parameters[name] = shortest(value);
    std::string text = setting.method;
    char separator = '(';
    for (const auto& [name, value] : parameters) {
        text += separator + name + '=' + value;
        separator = ',';
    }
    return parameters.empty() ? text : text + ')';
}

MethodSetting parse_method_setting(std::string_view text) {
    MethodSetting setting;
    const std::size_t open = text.find('(');
    setting.method = std::string(text.substr(0, open));
    if (setting.method.empty()) refuse(text, "no method name");
    if (open == std::string_view::npos) return setting;
    if (text.back() != ')') refuse(text, "no closing bracket");
    std::string_view rest = text.substr(open + 1, text.size() - open - 2);
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        const std::string_view pair = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
        const std::size_t equals = pair.find('=');
        if (equals == std::string_view::npos || equals == 0 || equals + 1 == pair.size())
            refuse(text, "\"" + std::string(pair) + "\" instead of name=value");
        const std::string name(pair.substr(0, equals));
        const std::string_view value = pair.substr(equals + 1);
        double number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        if (error == std::errc() && end == value.data() + value.size())
            setting.numbers[name] = number;
        else
            setting.words[name] = std::string(value);
    }
    return setting;
}

}  // namespace parafovea
