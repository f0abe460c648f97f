// The questions, in two languages, and the sickness scores.
#include "study/questionnaire.h"

#include <charconv>
#include <stdexcept>

namespace parafovea {
namespace {

// A symptom and the scales it counts for.
struct Symptom {
    const char* name;
    const char* english;
    const char* german;
    bool nausea, oculomotor, disorientation;
};

constexpr Symptom kSymptoms[] = {
    {"general_discomfort", "Do you feel unwell in general?", "Fühlen Sie sich allgemein unwohl?", true, true,
     false},
    {"fatigue", "Are you tired?", "Sind Sie müde?", false, true, false},
    {"headache", "Does your head ache?", "Haben Sie Kopfschmerzen?", false, true, false},
    {"eye_strain", "Do your eyes feel strained?", "Sind Ihre Augen angestrengt?", false, true, false},
    {"difficulty_focusing", "Is it hard to see sharply?", "Fällt es Ihnen schwer, scharf zu sehen?", false,
     true, true},
    {"increased_salivation", "Is there more saliva in your mouth than usual?",
     "Haben Sie mehr Speichel im Mund als sonst?", true, false, false},
    {"sweating", "Are you sweating?", "Schwitzen Sie?", true, false, false},
    {"nausea", "Do you feel sick to your stomach?", "Ist Ihnen übel?", true, false, true},
    {"difficulty_concentrating", "Is it hard to concentrate?",
     "Fällt es Ihnen schwer, sich zu konzentrieren?", true, true, false},
    {"fullness_of_head", "Does your head feel full or under pressure?",
     "Fühlt sich Ihr Kopf voll oder unter Druck an?", false, false, true},
    {"blurred_vision", "Do you see things blurred?", "Sehen Sie verschwommen?", false, true, true},
    {"dizzy_eyes_open", "Are you dizzy with your eyes open?", "Ist Ihnen mit offenen Augen schwindlig?",
     false, false, true},
    {"dizzy_eyes_closed", "Are you dizzy with your eyes closed?",
     "Ist Ihnen mit geschlossenen Augen schwindlig?", false, false, true},
    {"vertigo", "Do you feel as if you or the room were turning?",
     "Dreht sich für Sie der Raum, oder drehen Sie sich?", false, false, true},
    {"stomach_awareness", "Do you notice your stomach, short of feeling sick?",
     "Spüren Sie Ihren Magen, ohne dass Ihnen übel ist?", true, false, false},
    {"burping", "Do you have to burp?", "Müssen Sie aufstoßen?", true, false, false},
};

std::optional<int> whole_number(const std::string& text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

Questionnaire consent(bool german) {
    return {
        "consent",
        german ? "Einwilligung" : "Consent",
        {{"consent",
          german ? "Ich bin über die Studie informiert worden, nehme freiwillig teil und weiß, dass ich "
                   "jederzeit ohne "
                   "Angabe von Gründen aufhören und meine Daten löschen lassen kann."
                 : "I have been told about the study, take part of my own will, and know that I may stop at "
                   "any time "
                   "without giving a reason and have my data removed.",
          german ? std::vector<std::string>{"Nein", "Ja"} : std::vector<std::string>{"No", "Yes"}, 0, 0}}};
}

Questionnaire about_participant(const Questions& asked, bool german) {
    Questionnaire questionnaire{"participant", german ? "Über Sie" : "About you", {}};
    if (asked.minimum_age_years > 0)
        questionnaire.questions.push_back(
            {"age_years",
             german ? "Wie alt sind Sie (in Jahren)?" : "How old are you, in years?",
             {},
             0,
             120});
    if (asked.vision)
        questionnaire.questions.push_back(
            {"vision", german ? "Wie sehen Sie?" : "How do you see?",
             german ? std::vector<std::string>{"gut, ohne Hilfe", "gut, mit Kontaktlinsen", "gut, mit Brille",
                                               "nicht gut"}
                    : std::vector<std::string>{"well, without help", "well, with contact lenses",
                                               "well, with glasses", "not well"},
             0, 0});
    return questionnaire;
}

}  // namespace

Questionnaire sickness_questionnaire(std::string_view name, std::string_view language) {
    const bool german = language == "de";
    Questionnaire questionnaire{
        std::string(name), german ? "Wie fühlen Sie sich jetzt?" : "How do you feel right now?", {}};
    const std::vector<std::string> options =
        german ? std::vector<std::string>{"gar nicht", "leicht", "mäßig", "stark"}
               : std::vector<std::string>{"not at all", "slightly", "moderately", "severely"};
    for (const Symptom& symptom : kSymptoms)
        questionnaire.questions.push_back(
            {symptom.name, german ? symptom.german : symptom.english, options, 0, 0});
    return questionnaire;
}

std::vector<Questionnaire> questionnaires_before(const Protocol& protocol) {
    const bool german = protocol.language == "de";
    std::vector<Questionnaire> all;
    if (protocol.questions.consent) all.push_back(consent(german));
    if (protocol.questions.minimum_age_years > 0 || protocol.questions.vision)
        all.push_back(about_participant(protocol.questions, german));
    if (protocol.questions.sickness_before_after)
        all.push_back(sickness_questionnaire("sickness_before", protocol.language));
    return all;
}

std::vector<Questionnaire> questionnaires_after(const Protocol& protocol) {
    if (!protocol.questions.sickness_before_after) return {};
    return {sickness_questionnaire("sickness_after", protocol.language)};
}

std::optional<std::string> answer_mistake(const Question& question, const std::string& answer) {
    const int low = question.options.empty() ? question.low : 0;
    const int high = question.options.empty() ? question.high : static_cast<int>(question.options.size()) - 1;
    const std::optional<int> value = whole_number(answer);
    if (value && *value >= low && *value <= high) return std::nullopt;
    return "expected a whole number from " + std::to_string(low) + " to " + std::to_string(high) + " for \"" +
           question.name + "\", found \"" + answer + "\"; ask again";
}

std::optional<std::string> reason_not_to_take_part(const Protocol& protocol,
                                                   const Questionnaire& questionnaire,
                                                   const QuestionnaireAnswers& answers) {
    const auto number = [&](const char* name) {
        const auto found = answers.find(name);
        return found == answers.end() ? std::nullopt : whole_number(found->second);
    };
    if (questionnaire.name == "consent" && number("consent") != 1) return "consent was not given";
    if (questionnaire.name != "participant") return std::nullopt;
    if (protocol.questions.minimum_age_years > 0 &&
        number("age_years").value_or(0) < protocol.questions.minimum_age_years)
        return "younger than " + std::to_string(protocol.questions.minimum_age_years);
    if (protocol.questions.vision && number("vision").value_or(3) == 3)
        return "vision is neither normal nor corrected";
    return std::nullopt;
}

SicknessScore sickness_score(const QuestionnaireAnswers& answers) {
    int nausea = 0, oculomotor = 0, disorientation = 0;
    for (const Symptom& symptom : kSymptoms) {
        const auto found = answers.find(symptom.name);
        const std::optional<int> value = found == answers.end() ? std::nullopt : whole_number(found->second);
        if (!value || *value < 0 || *value > 3)
            throw std::runtime_error(
                "sickness questionnaire: expected 0 to 3 for \"" + std::string(symptom.name) + "\", found " +
                (found == answers.end() ? "nothing" : '"' + found->second + '"') + "; complete it");
        if (symptom.nausea) nausea += *value;
        if (symptom.oculomotor) oculomotor += *value;
        if (symptom.disorientation) disorientation += *value;
    }
    return {nausea * 9.54, oculomotor * 7.58, disorientation * 13.92,
            (nausea + oculomotor + disorientation) * 3.74};
}

}  // namespace parafovea
