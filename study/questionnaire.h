// What a participant is asked beside the trials: consent, age and vision, and how they feel.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/protocol.h"

namespace parafovea {

struct Question {
    std::string name;  // the key of its answer in the log
    std::string text;  // in the participant's language
    // Either the options to choose from (the answer is an option's place, from "0"), or whole numbers in
    // [low, high].
    std::vector<std::string> options;
    int low = 0, high = 0;
};

struct Questionnaire {
    std::string name;   // "consent", "participant", "sickness_before", "sickness_after"
    std::string title;  // in the participant's language
    std::vector<Question> questions;
};

using QuestionnaireAnswers = std::map<std::string, std::string>;  // by Question::name

// What the protocol asks before the first trial, consent first, and after the last. In the protocol's
// language where it is "en" or "de", else in English.
std::vector<Questionnaire> questionnaires_before(const Protocol& protocol);
std::vector<Questionnaire> questionnaires_after(const Protocol& protocol);

// Why an answer cannot be taken, in English; nothing where it can.
std::optional<std::string> answer_mistake(const Question& question, const std::string& answer);

// Why the answers keep this participant out of the study ("consent was not given", ...); nothing where they
// do not.
std::optional<std::string> reason_not_to_take_part(const Protocol& protocol,
                                                   const Questionnaire& questionnaire,
                                                   const QuestionnaireAnswers& answers);

// The Simulator Sickness Questionnaire of Kennedy, Lane, Berbaum and Lilienthal 1993: 16 symptoms from 0
// (none) to 3 (severe), in words of our own.
Questionnaire sickness_questionnaire(std::string_view name, std::string_view language);

// Its published scores. The weighted sums go from 0 to 200.34, 159.18, 292.32 and 235.62.
struct SicknessScore {
    double nausea = 0, oculomotor = 0, disorientation = 0, total = 0;
};
// Throws std::runtime_error where an answer is missing or not 0 to 3.
SicknessScore sickness_score(const QuestionnaireAnswers& answers);

}  // namespace parafovea
