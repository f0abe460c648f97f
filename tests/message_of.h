// What a call complains of.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace parafovea {

// The message of the std::runtime_error that the call throws; a failure when it throws none.
template <typename Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    ADD_FAILURE() << "expected an error";
    return {};
}

}  // namespace parafovea
