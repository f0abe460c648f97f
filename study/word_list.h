// Words in a row, as a sentence lists them.
#pragma once

#include <string>

namespace parafovea {

// "a, b, c"; empty for no words.
template <typename Words>
std::string joined(const Words& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

}  // namespace parafovea
