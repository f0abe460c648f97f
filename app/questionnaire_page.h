// Asks a questionnaire on the participant's own pages, answered with the controller.
#pragma once

#include <optional>
#include <stop_token>

#include "devices/controller_source.h"
#include "study/questionnaire.h"
#include "study/stage.h"

namespace parafovea {

// One question a page: up and down choose, the key for "proceed" confirms; for numbers left and right go by
// ten. None where it was stopped.
std::optional<QuestionnaireAnswers> ask_questionnaire(const Questionnaire& questionnaire,
                                                      const Protocol& protocol, Stage& stage,
                                                      ControllerSource& controller, std::stop_token stop);

// The page of one question with the choice made so far: an option's place, or the number itself.
std::string question_page_text(const Questionnaire& questionnaire, const Question& question, int choice);

}  // namespace parafovea
