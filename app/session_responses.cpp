// Turns session files and responses tables into the analysis's rows.
#include "app/session_responses.h"

#include <algorithm>
#include <stdexcept>

#include "analysis/inventory.h"
#include "analysis/parallel.h"
#include "app/session_quality.h"
#include "study/exclusion.h"
#include "study/session_log_reader.h"
#include "study/word_list.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

double number_or_zero(const MethodSetting& setting, const char* name) {
    const auto found = setting.numbers.find(name);
    return found == setting.numbers.end() ? 0 : found->second;
}

bool is_testing_trial(const TrialRow& trial) {
    return trial.planned.kind != TrialKind::training && !trial.interrupted && !trial.superseded;
}

Response response_of(const TrialRow& trial) {
    Response response;
    response.session = trial.planned.session;
    response.block = trial.planned.block;
    response.trial = trial.planned.position;
    response.scene = trial.planned.scene;
    response.validation = trial.planned.kind == TrialKind::validation;
    if (!response.validation) {
        const bool foveated_first = trial.planned.reference_interval == 1;
        const MethodSetting& setting = foveated_first ? trial.planned.first : trial.planned.second;
        response.method = setting.method;
        response.sigma = number_or_zero(setting, "sigma");
        response.alpha = number_or_zero(setting, "alpha");
        response.foveated_first = foveated_first;
    }
    response.answered = trial.answer.has_value();
    if (trial.answer) {
        response.identical = trial.answer->identical;
        response.response_time_s = trial.answer->reaction.seconds();
    }
    response.excluded_reason = joined(trial.invalid);
    if (!response.answered && response.excluded_reason.empty()) response.excluded_reason = "no answer";
    int missed = 0, frames = 0;
    for (const IntervalRecord& interval : trial.intervals) {
        if (interval.phase != Phase::first_interval && interval.phase != Phase::second_interval) continue;
        missed += interval.missed_vsyncs;
        frames += interval.presented_frames;
    }
    if (frames > 0) response.dropped_frames = static_cast<double>(missed) / (frames + missed);
    return response;
}

std::string rules_in_words(const ExclusionRules& rules) {
    std::vector<std::string> words;
    if (rules.failed_validation_share)
        words.push_back("more than " + std::to_string(*rules.failed_validation_share * 100) +
                        " % of the validation trials called different");
    if (rules.invalid_trial_share)
        words.push_back("more than " + std::to_string(*rules.invalid_trial_share * 100) +
                        " % of the condition trials without a valid answer");
    return joined(words);
}

void describe(const SessionHead& session, const Protocol& protocol, StudyDescription& description) {
    description.is_pilot = protocol.kind == StudyKind::pilot;
    description.protocol_name = session.protocol_name;
    description.protocol_hash = session.protocol_hash;
    description.program_version = session.facts.program_version;
    description.planned_participants = protocol.design.participants;
    description.exclusion_rules = rules_in_words(protocol.exclusion);
    description.exclusion_rules_hash = session.protocol_hash;  // the rules are part of the protocol's text
    description.provenance.emplace_back("rendered by", session.facts.device + ", " + session.facts.driver);
    description.provenance.emplace_back("eye tracker", session.facts.gaze_source);
    description.provenance.emplace_back("display", session.facts.display);
}

SessionStamp stamp_of(const SessionHead& session, const fs::path& file) {
    SessionStamp stamp;
    stamp.file = file.string();
    stamp.session_id = session.facts.uuid;
    stamp.participant = session.facts.participant;
    stamp.protocol_name = session.protocol_name;
    stamp.protocol_hash = session.protocol_hash;
    stamp.answers = session.answers;
    return stamp;
}

constexpr std::size_t kSessionsAtATime = 64;  // in memory, about 100 kB each

// What one file adds to a study.
struct SessionPart {
    std::string seed;  // whose and which
    bool simulated_people = false;
    RecordingCount recorded;
    std::vector<Response> responses;
};

SessionPart read_part(const fs::path& file, const ExclusionRules& rules) {
    const SessionRows session = read_session(file);
    SessionSurvey survey(file);
    SessionPart part;
    part.seed = session.facts.participant + " " + std::to_string(session.plan.seed);
    part.simulated_people = session.facts.simulated_people;
    const std::string excluded = joined(exclusion_reasons(session, rules));
    part.recorded.begin(session);
    for (const TrialRow& trial : session.trials) {
        if (!is_testing_trial(trial)) continue;
        Response response = response_of(trial);
        response.participant = session.facts.participant;
        if (response.excluded_reason.empty()) response.excluded_reason = excluded;
        response.gaze_loss = part.recorded.add(trial, survey);
        part.responses.push_back(std::move(response));
    }
    part.recorded.finish();
    return part;
}

}  // namespace

std::vector<fs::path> input_files(const std::vector<std::string>& inputs) {
    std::vector<fs::path> files;
    for (const std::string& input : inputs) {
        if (!fs::exists(input))
            throw std::runtime_error(
                input + ": expected a session file, a folder of them or a responses CSV, found nothing");
        if (!fs::is_directory(input)) {
            files.push_back(input);
            continue;
        }
        std::vector<fs::path> found;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(input))
            if (entry.path().extension() == ".sqlite") found.push_back(entry.path());
        if (found.empty())
            throw std::runtime_error(input +
                                     ": expected session files (*.sqlite) in this folder, found none");
        std::sort(found.begin(), found.end());
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

SessionList list_sessions(const std::vector<fs::path>& files) {
    SessionList list;
    std::vector<SessionHead> heads(files.size());
    parallel_for(files.size(), [&](std::size_t i) { heads[i] = SessionSurvey(files[i]).head(); });
    std::vector<SessionStamp> stamps;
    for (std::size_t i = 0; i < files.size(); ++i) stamps.push_back(stamp_of(heads[i], files[i]));
    const Inventory inventory = take_inventory(stamps);
    for (const InventoryProblem& problem : inventory.problems) list.problems.push_back(problem.text);
    for (const std::size_t index : inventory.usable)
        list.sessions.push_back({files[index], std::move(heads[index])});
    return list;
}

StudyData read_study(const std::vector<std::string>& inputs,
                     const std::function<void(const Response&)>& on_response) {
    StudyData data;
    std::int64_t responses = 0;
    std::vector<fs::path> sessions;
    for (const fs::path& file : input_files(inputs)) {
        if (file.extension() != ".csv") {
            sessions.push_back(file);
            continue;
        }
        for_each_response_csv(file, [&](const Response& response) {
            on_response(response);
            ++responses;
        });
        data.description.provenance.emplace_back("responses table", file.filename().string());
    }

    // Take stock of all sessions before any is used, then read a few at a time, and hand them on in order.
    const SessionList list = list_sessions(sessions);
    data.problems = list.problems;
    RecordingCount recorded;
    std::string seeds;
    std::optional<Protocol> protocol;  // of all the sessions that are used
    if (!list.sessions.empty()) {
        const SessionHead& head = list.sessions.front().head;
        protocol = parse_protocol(head.protocol_text, head.protocol_file);
        describe(head, *protocol, data.description);
    }
    std::vector<SessionPart> parts;
    for (std::size_t begin = 0; begin < list.sessions.size(); begin += parts.size()) {
        parts.assign(std::min(kSessionsAtATime, list.sessions.size() - begin), {});
        parallel_for(parts.size(), [&](std::size_t i) {
            parts[i] = read_part(list.sessions[begin + i].file, protocol->exclusion);
        });
        for (const SessionPart& part : parts) {
            if (part.simulated_people) data.description.data_origin = "simulated participants";
            seeds += (seeds.empty() ? "" : ", ") + part.seed;
            recorded.add(part.recorded);
            for (const Response& response : part.responses) on_response(response);
            responses += static_cast<std::int64_t>(part.responses.size());
        }
    }
    data.recordings = recorded.recordings();
    if (!seeds.empty()) data.description.provenance.emplace_back("seeds", seeds);
    if (responses == 0)
        throw std::runtime_error("no answered testing trial in the input; nothing to analyse");
    return data;
}

}  // namespace parafovea
