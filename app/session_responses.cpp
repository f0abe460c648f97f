// Turns session files and responses tables into the analysis's rows.
#include "app/session_responses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "study/exclusion.h"

namespace parafovea {

namespace {

namespace fs = std::filesystem;

double number_or_zero(const MethodSetting& setting, const char* name) {
    const auto found = setting.numbers.find(name);
    return found == setting.numbers.end() ? 0 : found->second;
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    return text;
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

// Gaze while pictures were shown, over all sessions.
class GazeCount {
  public:
    GazeCount() {
        map_.columns = map_.rows = 60;
        map_.width_deg = map_.height_deg = 30;
        map_.counts.assign(static_cast<std::size_t>(map_.columns * map_.rows), 0);
    }

    // Adds one testing trial's samples; sets the trial's loss.
    void add(const TrialRow& trial, const std::vector<GazeSample>& samples, SessionQuality& quality) {
        for (const IntervalRecord& interval : trial.intervals) {
            if (interval.phase != Phase::first_interval && interval.phase != Phase::second_interval) continue;
            duration_s_ += (interval.end - interval.first_display).seconds();
            quality.frames += interval.presented_frames;
            quality.missed += interval.missed_vsyncs;
            for (const GazeSample& sample : samples) {
                if (sample.host_time < interval.first_display || sample.host_time >= interval.end) continue;
                ++all_;
                if (!sample.direction) continue;
                ++tracked_;
                count(*sample.direction);
            }
        }
    }

    // Completes a session's row from what came since the last one.
    void finish(SessionQuality& quality) {
        if (all_ > 0) {
            quality.gaze_loss = 1 - static_cast<double>(tracked_) / static_cast<double>(all_);
            if (duration_s_ > 0) quality.gaze_hz = static_cast<double>(tracked_) / duration_s_;
        }
        any_ = any_ || all_ > 0;
        all_ = tracked_ = 0;
        duration_s_ = 0;
    }

    std::optional<GazeHeatMap> map() const { return any_ ? std::optional(map_) : std::nullopt; }

  private:
    void count(DirectionDeg direction) {
        const int column =
            static_cast<int>(std::floor((direction.azimuth_deg / map_.width_deg + 0.5) * map_.columns));
        const int row =
            static_cast<int>(std::floor((0.5 - direction.elevation_deg / map_.height_deg) * map_.rows));
        if (column < 0 || row < 0 || column >= map_.columns || row >= map_.rows) return;
        map_.counts[static_cast<std::size_t>(row * map_.columns + column)] += 1;
    }

    GazeHeatMap map_;
    std::int64_t all_ = 0, tracked_ = 0;
    double duration_s_ = 0;
    bool any_ = false;
};

std::vector<SessionQuality> session_qualities(const SessionRows& session, const fs::path& file,
                                              GazeCount& gaze) {
    std::map<int, SessionQuality> by_session;
    for (const TrialRow& trial : session.trials) {
        if (!is_testing_trial(trial)) continue;
        const auto [row, is_new] = by_session.try_emplace(trial.planned.session);
        if (is_new) {
            if (by_session.size() > 1) gaze.finish(std::prev(row)->second);
            row->second.participant = session.facts.participant;
            row->second.session = trial.planned.session;
            if (!session.calibrations.empty())
                row->second.accuracy_deg = session.calibrations.back().mean_accuracy_deg;
        }
        gaze.add(trial, read_gaze(file, trial.planned.number, trial.attempt), row->second);
    }
    if (!by_session.empty()) gaze.finish(by_session.rbegin()->second);
    std::vector<SessionQuality> rows;
    for (auto& [number, quality] : by_session) rows.push_back(std::move(quality));
    return rows;
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

void describe(const SessionRows& session, StudyDescription& description) {
    const Protocol protocol = parse_protocol(session.protocol_text, session.protocol_file);
    description.is_pilot = protocol.kind == StudyKind::pilot;
    description.protocol_name = session.protocol_name;
    description.protocol_hash = session.protocol_hash;
    description.program_version = session.facts.program_version;
    description.exclusion_rules = rules_in_words(protocol.exclusion);
    description.exclusion_rules_hash = session.protocol_hash;  // the rules are part of the protocol's text
    description.provenance.emplace_back("rendered by", session.facts.device + ", " + session.facts.driver);
    description.provenance.emplace_back("eye tracker", session.facts.gaze_source);
    description.provenance.emplace_back("display", session.facts.display);
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

SessionStamp stamp_of(const SessionRows& session, const fs::path& file) {
    SessionStamp stamp;
    stamp.file = file.string();
    stamp.session_id = session.facts.uuid;
    stamp.participant = session.facts.participant;
    stamp.protocol_name = session.protocol_name;
    stamp.protocol_hash = session.protocol_hash;
    stamp.answers = std::count_if(session.trials.begin(), session.trials.end(),
                                  [](const TrialRow& trial) { return trial.answer.has_value(); });
    return stamp;
}

std::vector<Response> responses_of(const SessionRows& session) {
    const Protocol protocol = parse_protocol(session.protocol_text, session.protocol_file);
    const std::string excluded = joined(exclusion_reasons(session, protocol.exclusion));
    std::vector<Response> responses;
    for (const TrialRow& trial : session.trials) {
        if (!is_testing_trial(trial)) continue;
        responses.push_back(response_of(trial));
        responses.back().participant = session.facts.participant;
        if (responses.back().excluded_reason.empty()) responses.back().excluded_reason = excluded;
    }
    return responses;
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

    // Take stock of all sessions before any is used.
    std::vector<SessionStamp> stamps;
    for (const fs::path& file : sessions) stamps.push_back(stamp_of(read_session(file), file));
    const Inventory inventory = take_inventory(stamps);
    for (const InventoryProblem& problem : inventory.problems) data.problems.push_back(problem.text);

    GazeCount gaze;
    std::string seeds;
    for (const std::size_t index : inventory.usable) {
        const fs::path& file = sessions[index];
        const SessionRows session = read_session(file);
        if (seeds.empty()) describe(session, data.description);
        if (session.facts.simulated_people) data.description.data_origin = "simulated participants";
        seeds +=
            (seeds.empty() ? "" : ", ") + session.facts.participant + " " + std::to_string(session.plan.seed);
        for (const Response& response : responses_of(session)) {
            on_response(response);
            ++responses;
        }
        for (SessionQuality& quality : session_qualities(session, file, gaze))
            data.recordings.sessions.push_back(std::move(quality));
    }
    data.recordings.gaze = gaze.map();
    if (!seeds.empty()) data.description.provenance.emplace_back("seeds", seeds);
    if (responses == 0)
        throw std::runtime_error("no answered testing trial in the input; nothing to analyse");
    return data;
}

}  // namespace parafovea
