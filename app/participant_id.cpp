// From a participant's pseudonym to the row of the counterbalancing square.
#include "app/participant_id.h"

#include <charconv>
#include <stdexcept>

namespace parafovea {

int participant_index(const std::string& id) {
    constexpr const char* kDigits = "0123456789";
    const std::size_t last_other = id.find_last_not_of(kDigits);
    const std::size_t digits = last_other == std::string::npos ? 0 : last_other + 1;
    int number = 0;
    const auto [end, error] = std::from_chars(id.data() + digits, id.data() + id.size(), number);
    const bool clean =
        id.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") ==
        std::string::npos;
    if (!clean || error != std::errc() || number < 1)
        throw std::runtime_error(
            "participant '" + id +
            "': expected letters, digits, '-' and '_' ending in a number above 0, such as P01; "
            "the number picks the row of the counterbalancing square");
    return number - 1;
}

}  // namespace parafovea
