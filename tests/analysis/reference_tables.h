// Published 0/1 tables whose Cochran's Q has been computed elsewhere (R 4.2.2 with coin 1.4.2, and rational
// arithmetic).
#pragma once

#include <string>
#include <vector>

#include "analysis/cochran_q.h"

namespace parafovea {

// Rows as text: "101 011".
inline BinaryTable table_from(const std::string& text) {
    BinaryTable table;
    std::size_t width = 0;
    for (char c : text + " ") {
        if (c == '0' || c == '1') {
            table.values.push_back(static_cast<std::uint8_t>(c - '0'));
            ++width;
        } else if (width > 0) {
            table.columns = width;
            width = 0;
        }
    }
    return table;
}

// Conover 1999, p. 253; also NIST and statsmodels.
inline BinaryTable conover_table() {
    return table_from("111 111 010 110 000 111 111 110 001 010 111 111");
}

// statsmodels' second test table.
inline BinaryTable web_table() {
    return table_from("0001 0001 0001 1111 1001 0101 1001 0001 0100 0000 1001 0011");
}

inline BinaryTable cvst1_table() {
    return table_from("1011 0111 1110 0100 0100 1010 0100 1111 0100");
}
inline BinaryTable cvst2_table() {
    return table_from("00110 01010 01101 10001 11000 10100 01000 00110 00000");
}

// SAS's drugs A, B and C: 46 patients.
inline BinaryTable sas_table() {
    std::string text;
    const char* rows[] = {"000 ", "100 ", "001 ", "101 ", "010 ", "110 ", "011 ", "111 "};
    const int counts[] = {6, 2, 16, 4, 2, 6, 4, 6};
    for (int i = 0; i < 8; ++i)
        for (int n = 0; n < counts[i]; ++n) text += rows[i];
    return table_from(text);
}

// The example of RVAideMemoire's cochran.qtest.
inline BinaryTable rva_table() {
    return table_from("011 001 011 111 001 101 011 001 011 001");
}

}  // namespace parafovea
