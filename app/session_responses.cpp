// Turns session files and responses tables into the analysis's rows.
#include "app/session_responses.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "study/session_log_reader.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

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
        for (const fs::directory_entry& entry : fs::directory_iterator(input))
            if (entry.path().extension() == ".sqlite") found.push_back(entry.path());
        if (found.empty())
            throw std::runtime_error(input +
                                     ": expected session files (*.sqlite) in this folder, found none");
        std::sort(found.begin(), found.end());
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

double number_or_zero(const MethodSetting& setting, const char* name) {
    const auto found = setting.numbers.find(name);
    return found == setting.numbers.end() ? 0 : found->second;
}

Response response_from(const SessionRows& session, const TrialRow& trial) {
    Response response;
    response.participant = session.facts.participant;
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
    if (trial.answer) {
        response.identical = trial.answer->identical;
        response.response_time_s = trial.answer->reaction.seconds();
    }
    for (const std::string& rule : trial.invalid)
        response.excluded_reason += (response.excluded_reason.empty() ? "" : ", ") + rule;
    int missed = 0, frames = 0;
    for (const IntervalRecord& interval : trial.intervals) {
        if (interval.phase != Phase::first_interval && interval.phase != Phase::second_interval) continue;
        missed += interval.missed_vsyncs;
        frames += interval.presented_frames;
    }
    if (frames > 0) response.dropped_frames = static_cast<double>(missed) / (frames + missed);
    return response;
}

// Answered testing trials that were neither broken off nor started over; invalid ones stay, with their
// reason.
void append_session(const SessionRows& session, std::vector<Response>& responses) {
    for (const TrialRow& trial : session.trials) {
        if (trial.planned.kind == TrialKind::training || trial.interrupted || trial.superseded ||
            !trial.answer)
            continue;
        responses.push_back(response_from(session, trial));
    }
}

}  // namespace

StudyData read_study_data(const std::vector<std::string>& inputs) {
    StudyData data;
    std::map<std::string, fs::path> file_of_uuid;
    std::string seeds;
    fs::path first_session;

    for (const fs::path& file : input_files(inputs)) {
        if (file.extension() == ".csv") {
            const std::vector<Response> rows = read_responses_csv(file);
            data.responses.insert(data.responses.end(), rows.begin(), rows.end());
            data.description.provenance.emplace_back("responses table", file.filename().string());
            continue;
        }
        const SessionRows session = read_session(file);
        const auto [known, is_new] = file_of_uuid.emplace(session.facts.uuid, file);
        if (!is_new)
            throw std::runtime_error(file.string() + ": the same session as " + known->second.string() +
                                     "; give each session once");
        StudyDescription& description = data.description;
        if (first_session.empty()) {
            first_session = file;
            const Protocol protocol = parse_protocol(session.protocol_text, session.protocol_file);
            description.is_pilot = protocol.kind == StudyKind::pilot;
            description.protocol_name = session.protocol_name;
            description.protocol_hash = session.protocol_hash;
            description.program_version = session.facts.program_version;
            description.provenance.emplace_back("rendered by",
                                                session.facts.device + ", " + session.facts.driver);
            description.provenance.emplace_back("eye tracker", session.facts.gaze_source);
        } else if (session.protocol_hash != description.protocol_hash) {
            throw std::runtime_error(file.string() + ": protocol " + session.protocol_name + " (hash " +
                                     session.protocol_hash + ") differs from that of " +
                                     first_session.string() + " (hash " + description.protocol_hash +
                                     "); analyse them apart");
        }
        if (session.facts.simulated_people) description.data_origin = "simulated participants";
        seeds +=
            (seeds.empty() ? "" : ", ") + session.facts.participant + " " + std::to_string(session.plan.seed);
        append_session(session, data.responses);
    }
    if (!seeds.empty()) data.description.provenance.emplace_back("seeds", seeds);
    if (data.responses.empty())
        throw std::runtime_error("no answered testing trial in the input; nothing to analyse");
    return data;
}

}  // namespace parafovea
