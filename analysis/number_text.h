// Numbers as text, the same in every locale.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace parafovea {

// With so many digits after the point.
inline std::string fixed_text(double value, int digits) {
    char text[512];
    const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
    return std::string(text, result.ptr);
}

// The shortest text that reads back as the same number: 1.2, not 1.2000000000000000.
inline std::string short_text(double value) {
    char text[64];
    const auto result = std::to_chars(text, text + sizeof text, value);
    return std::string(text, result.ptr);
}

// Up to so many significant digits, without exponent where it can be read without.
inline std::string general_text(double value, int significant) {
    char text[64];
    const auto result =
        std::to_chars(text, text + sizeof text, value, std::chars_format::general, significant);
    return std::string(text, result.ptr);
}

// Absent is empty, as spreadsheets and data frames expect.
inline std::string csv_text(const std::optional<double>& value, int significant = 9) {
    return value ? general_text(*value, significant) : std::string();
}

// A probability for readers: three digits, small ones as a bound or a power of ten, absent as a dash.
inline std::string p_text(const std::optional<double>& p,
                          const std::optional<double>& log10_p = std::nullopt) {
    if (!p) return "\xE2\x80\x93";
    if (*p >= 0.001) return fixed_text(*p, 3);
    const double exponent = log10_p ? *log10_p : std::log10(*p);
    if (!std::isfinite(exponent)) return "< 1e-300";
    return "1e" + std::to_string(static_cast<long>(std::floor(exponent + 0.5)));
}

}  // namespace parafovea
