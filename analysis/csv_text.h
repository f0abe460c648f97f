// Text as a field of a CSV file.
#pragma once

#include <string>

namespace parafovea {

// Quoted as in RFC 4180 where it must be.
inline std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + "\"";
}

}  // namespace parafovea
