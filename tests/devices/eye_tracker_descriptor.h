// The report descriptor of an eye tracker as on page 0x12's reference devices, and reports that fit it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace parafovea {

inline std::vector<std::uint8_t> bytes_from_hex(std::string_view hex) {
    std::vector<std::uint8_t> bytes;
    int high = -1;
    for (const char c : hex) {
        const int digit = c >= '0' && c <= '9'   ? c - '0'
                          : c >= 'a' && c <= 'f' ? c - 'a' + 10
                          : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                 : -1;
        if (digit < 0) continue;
        if (high < 0) {
            high = digit;
        } else {
            bytes.push_back(static_cast<std::uint8_t>(high << 4 | digit));
            high = -1;
        }
    }
    return bytes;
}

inline std::vector<std::uint8_t> eye_tracker_descriptor() {
    return bytes_from_hex(
        "05 12 09 01 A1 01"
        "09 10 A1 02 85 10 15 00 26 FF 00 75 08 09 20 66 01 10 55 0A 95 08 81 02"
        "95 01 75 20 65 11 55 0C 17 80 7B E1 FF 27 80 84 1E 00"
        "09 24 A1 00 95 02 09 21 09 22 81 03 C0"
        "09 25 A1 00 95 03 09 21 09 22 09 23 81 03 C0"
        "09 26 A1 00 95 03 09 21 09 22 09 23 81 03 C0"
        "09 27 A1 00 95 03 09 21 09 22 09 23 81 03 C0"
        "09 28 A1 00 95 03 09 29 09 2A 09 2B 81 03 C0"
        "C0"
        "09 11 A1 02 85 11 75 08 95 01 0A 00 01 15 00 25 01 65 00 55 00 B1 03"
        "A1 00 95 05 75 20 17 80 7B E1 FF 27 80 84 1E 00 65 11 55 0C"
        "0A 01 01 0A 02 01 0A 03 01 0A 04 01 0A 05 01 B1 03 C0"
        "C0"
        "09 12 A1 02 85 12 75 08 15 00 26 FF 00 95 01 75 10 27 FF FF 00 00 65 00 55 00"
        "0A 00 02 B1 03 0A 01 02 B1 03"
        "75 20 27 FF FF FF 7F 0A 02 02 B1 03"
        "75 10 15 00 27 FF FF 00 00 0A 03 02 B1 03"
        "A1 00 65 11 55 0C 27 FF FF FF 7F 75 20 0A 04 02 B1 03 0A 05 02 B1 03 C0"
        "C0"
        "09 13 A1 02 85 13 75 08 65 00 55 00 25 04 0A 01 03 B1 02 75 10 27 FF FF 00 00 66 01 F0 55 00 0A 00 "
        "03 B1 02 C0"
        "09 13 A1 02 85 13 75 08 65 00 55 00 25 04 0A 01 03 81 02 75 10 27 FF FF 00 00 66 01 F0 55 00 0A 00 "
        "03 81 02 C0"
        "09 14 A1 02 85 14 75 08 25 07 65 00 55 00 0A 00 04 B1 02 C0"
        "C0");
}

inline std::vector<std::uint8_t> golden_gaze_report() {
    return bytes_from_hex(
        "10 d2 02 96 49 00 00 00 00 d0 ef 03 00 68 36 02 00 c4 74 03 00 68 36 02 00 c0 27 09 00 dc 6a 04 00 "
        "68 36 02 00 "
        "c0 27 09 00 d0 ef 03 00 68 36 02 00 c0 27 09 00 ff ff ff 7f ff ff ff 7f ff ff ff 7f");
}

}  // namespace parafovea
