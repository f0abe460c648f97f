// Questions as pages of text.
#include "app/questionnaire_page.h"

#include <algorithm>
#include <vector>

namespace parafovea {

namespace {

int steps_of(Button button, bool number) {
    // Options are listed downwards; numbers grow upwards.
    switch (button) {
        case Button::up:
            return number ? 1 : -1;
        case Button::down:
            return number ? -1 : 1;
        case Button::left:
            return number ? -10 : 0;
        case Button::right:
            return number ? 10 : 0;
        default:
            return 0;
    }
}

std::optional<std::string> ask_one(const Questionnaire& questionnaire, const Question& question,
                                   const Protocol& protocol, Stage& stage, ControllerSource& controller,
                                   const std::stop_token& stop) {
    const bool number = question.options.empty();
    const int low = number ? question.low : 0;
    const int high = number ? question.high : static_cast<int>(question.options.size()) - 1;
    int choice = low;
    std::vector<ControllerEvent> events;
    controller.drain(events);
    while (!stop.stop_requested()) {
        Picture picture;
        picture.kind = PictureKind::text;
        picture.text = question_page_text(questionnaire, question, choice);
        stage.show(picture);
        events.clear();
        controller.drain(events);
        for (const ControllerEvent& event : events) {
            if (event.kind != ControllerEventKind::press) continue;
            const std::string answer = std::to_string(choice);
            if (event.button == protocol.keys.proceed && !answer_mistake(question, answer)) return answer;
            choice = std::clamp(choice + steps_of(event.button, number), low, high);
        }
    }
    return std::nullopt;
}

}  // namespace

std::string question_page_text(const Questionnaire& questionnaire, const Question& question, int choice) {
    std::string text = questionnaire.title + "\n\n" + question.text + "\n\n";
    if (question.options.empty()) return text + "\u25b2\u25bc  " + std::to_string(choice);
    for (std::size_t i = 0; i < question.options.size(); ++i)
        text += (static_cast<int>(i) == choice ? "\u25cf  " : "\u25cb  ") + question.options[i] + "\n";
    return text;
}

std::optional<QuestionnaireAnswers> ask_questionnaire(const Questionnaire& questionnaire,
                                                      const Protocol& protocol, Stage& stage,
                                                      ControllerSource& controller, std::stop_token stop) {
    QuestionnaireAnswers answers;
    for (const Question& question : questionnaire.questions) {
        const std::optional<std::string> answer =
            ask_one(questionnaire, question, protocol, stage, controller, stop);
        if (!answer) return std::nullopt;
        answers[question.name] = *answer;
    }
    return answers;
}

}  // namespace parafovea
