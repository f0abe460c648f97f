// Chooses each eye's sigma.
#include "renderer/eye_dominance.h"

#include <stdexcept>

namespace parafovea {
namespace {

constexpr double kUsualSigma = 1.8;

Eye dominant_eye(const RenderMethod& method) {
    const auto named = method.words.find("dominant_eye");
    if (named == method.words.end() || named->second == "right") return Eye::right;
    if (named->second == "left") return Eye::left;
    throw std::runtime_error("method " + method.name + ": dominant_eye is \"left\" or \"right\", not \"" +
                             named->second + "\"");
}

}  // namespace

RenderMethod method_for_eye(const RenderMethod& method, Eye eye) {
    RenderMethod own = method;
    own.words.erase("dominant_eye");
    const bool dominant = eye == dominant_eye(method);
    const auto other = own.numbers.find("sigma_other_eye");
    if (other == own.numbers.end()) return own;
    const double sigma_other_eye = other->second;
    own.numbers.erase(other);
    const auto sigma = own.numbers.find("sigma");
    const double sigma_dominant = sigma == own.numbers.end() ? kUsualSigma : sigma->second;
    if (!(sigma_other_eye >= sigma_dominant && sigma_other_eye <= 50)) {
        throw std::runtime_error("method " + method.name +
                                 ": sigma_other_eye is at least sigma and at most 50");
    }
    own.numbers["sigma"] = dominant ? sigma_dominant : sigma_other_eye;
    return own;
}

RenderMethod method_for_dominant_eye(const RenderMethod& method) {
    return method_for_eye(method, dominant_eye(method));
}

}  // namespace parafovea
