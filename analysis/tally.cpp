// Counts answers as they stream past, so that the statistics need no list of all trials.
#include "analysis/tally.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace parafovea {
namespace {

// 1.2 and 0.2 * 6 are one setting: settings are kept to a millionth.
double setting(double value) {
    return std::round(value * 1e6) / 1e6;
}

void insert_sorted(std::vector<double>& values, double value) {
    const auto at = std::lower_bound(values.begin(), values.end(), value);
    if (at == values.end() || *at != value) values.insert(at, value);
}

}  // namespace

std::size_t Tally::participant_index(const Response& response) {
    if (last_participant_ < participants_.size() &&
        participants_[last_participant_] == response.participant &&
        participant_sites_[last_participant_] == response.site)
        return last_participant_;
    const auto [at, added] =
        index_of_.emplace(response.site + '\x1f' + response.participant, participants_.size());
    if (added) {
        const bool taken = std::find(participants_.begin(), participants_.end(), response.participant) !=
                           participants_.end();
        participants_.push_back(taken ? response.participant + " (" + response.site + ")"
                                      : response.participant);
        participant_sites_.push_back(response.site);
        validation_.emplace_back();
    }
    return last_participant_ = at->second;
}

Tally::ConditionAnswers& Tally::condition_answers(const Response& response) {
    const Condition condition{setting(response.sigma), setting(response.alpha)};
    auto at = conditions_.find(condition);
    if (at == conditions_.end()) {
        at = conditions_.emplace(condition, ConditionAnswers{}).first;
        insert_sorted(sigmas_, condition.sigma);
        insert_sorted(alphas_, condition.alpha);
    }
    return at->second;
}

void Tally::add(const Response& response) {
    if (!response.excluded_reason.empty() && (use_exclusions_ == Exclusions::applied || !response.answered)) {
        ++excluded_;
        ++exclusions_[response.excluded_reason];
        if (!response.validation) ++condition_answers(response).records.excluded;
        return;
    }
    const std::size_t participant = participant_index(response);
    if (response.validation) {
        ++validation_trials_;
        ++validation_[participant].n;
        validation_[participant].successes += response.identical ? 1 : 0;
        return;
    }
    ConditionAnswers& answers = condition_answers(response);
    answers.sessions[{participant, response.session}].push_back(response.identical ? 1 : 0);
    ++counted_;

    // Keep what the warnings and the tables of times need.
    ConditionRecords& records = answers.records;
    if (response.dropped_frames) records.dropped_frames.add(*response.dropped_frames);
    if (response.gaze_loss) records.gaze_loss.add(*response.gaze_loss);
    if (response.response_time_s)
        records.response_times_s.push_back(static_cast<float>(*response.response_time_s));
    if (response.foveated_first) {
        ClusterCount& order = *response.foveated_first ? records.foveated_first : records.foveated_second;
        ++order.n;
        order.successes += response.identical ? 1 : 0;
    }
    if (!response.site.empty()) ++sites_[response.site];
}

const std::vector<double>& Tally::sigmas() const {
    return sigmas_;
}
const std::vector<double>& Tally::alphas() const {
    return alphas_;
}
bool Tally::has(Condition condition) const {
    return conditions_.contains(condition);
}

const ConditionRecords& Tally::records(Condition condition) const {
    return conditions_.at(condition).records;
}

std::int64_t Tally::sessions() const {
    std::set<std::pair<std::size_t, int>> all;
    for (const auto& [condition, answers] : conditions_)
        for (const auto& [key, values] : answers.sessions) all.insert(key);
    return static_cast<std::int64_t>(all.size());
}

std::vector<ClusterCount> Tally::by_participant(Condition condition) const {
    std::vector<ClusterCount> counts(participants_.size());
    const auto at = conditions_.find(condition);
    if (at == conditions_.end()) return counts;
    for (const auto& [key, answers] : at->second.sessions) {
        counts[key.first].n += static_cast<std::int64_t>(answers.size());
        counts[key.first].successes += std::count(answers.begin(), answers.end(), std::uint8_t{1});
    }
    return counts;
}

std::vector<ClusterCount> Tally::validation_by_participant() const {
    return validation_;
}

BlockTable Tally::blocks(double sigma, BlockKind kind) const {
    BlockTable result;
    std::vector<const ConditionAnswers*> columns;
    for (double alpha : alphas_) {
        const auto at = conditions_.find({sigma, alpha});
        if (at == conditions_.end()) continue;
        columns.push_back(&at->second);
        result.alphas.push_back(alpha);
    }
    result.table.columns = columns.size();
    if (columns.empty()) return result;

    // Walk over the sessions that have any answer at this sigma.
    std::set<std::pair<std::size_t, int>> keys;
    for (const ConditionAnswers* column : columns)
        for (const auto& [key, answers] : column->sessions) keys.insert(key);
    static const Answers kNone;
    std::map<std::size_t, std::vector<std::int64_t>> sums;
    std::map<std::size_t, std::int64_t> rows_of;
    std::vector<const Answers*> cell(columns.size());
    for (const auto& key : keys) {
        std::size_t complete = SIZE_MAX, most = 0;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const auto at = columns[j]->sessions.find(key);
            cell[j] = at == columns[j]->sessions.end() ? &kNone : &at->second;
            complete = std::min(complete, cell[j]->size());
            most = std::max(most, cell[j]->size());
        }
        result.incomplete_blocks += static_cast<std::int64_t>(most - complete);
        if (complete == 0) continue;
        if (kind == BlockKind::participant_session)
            result.repeated_blocks += static_cast<std::int64_t>(complete) - 1;
        auto& participant = sums[key.first];
        participant.resize(columns.size(), 0);
        rows_of[key.first] += static_cast<std::int64_t>(complete);
        for (std::size_t i = 0; i < complete; ++i) {
            for (std::size_t j = 0; j < columns.size(); ++j) {
                const std::uint8_t identical = (*cell[j])[i];
                participant[j] += identical;
                if (kind == BlockKind::participant_session) result.table.values.push_back(identical);
            }
        }
    }
    for (const auto& [participant, row] : sums) {
        result.participant_sums.insert(result.participant_sums.end(), row.begin(), row.end());
        if (kind == BlockKind::participant)
            for (std::int64_t identical : row)
                result.table.values.push_back(2 * identical > rows_of[participant] ? 1 : 0);
    }
    return result;
}

}  // namespace parafovea
