// The canonical text of a method and its parameters.
#include "study/method_setting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "devices/random.h"

namespace parafovea {
namespace {

TEST(MethodSetting, text_lists_parameters_in_alphabetical_order) {
    MethodSetting setting{"kfr", {{"sigma", 1.8}, {"alpha", 4}}, {{"kernel", "power"}}};
    EXPECT_EQ(to_text(setting), "kfr(alpha=4,kernel=power,sigma=1.8)");
    EXPECT_EQ(to_text(MethodSetting()), "full");
}

TEST(MethodSetting, text_reads_back_to_the_same_setting) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        MethodSetting setting{"m" + std::to_string(i), {}, {}};
        for (int k = 0; k < static_cast<int>(random.below(4)); ++k)
            setting.numbers["n" + std::to_string(k)] =
                random.normal() * std::pow(10, random.uniform(-300, 300));
        for (int k = 0; k < static_cast<int>(random.below(3)); ++k)
            setting.words["w" + std::to_string(k)] = "word_" + std::to_string(i);
        EXPECT_EQ(parse_method_setting(to_text(setting)), setting) << to_text(setting);
    }
}

TEST(MethodSetting, text_that_is_none_is_refused) {
    for (const char* text : {"", "(sigma=1)", "kfr(", "kfr(sigma)", "kfr(sigma=1", "kfr(=1)", "kfr(sigma=)"})
        EXPECT_THROW(parse_method_setting(text), std::runtime_error) << text;
}

}  // namespace
}  // namespace parafovea
