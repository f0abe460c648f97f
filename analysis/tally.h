// Counts answers as they stream past, so that the statistics need no list of all trials.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "analysis/cochran_q.h"
#include "analysis/proportion.h"
#include "analysis/responses.h"
#include "analysis/running_moments.h"

namespace parafovea {

struct Condition {
    double sigma = 0.0;
    double alpha = 0.0;

    auto operator<=>(const Condition&) const = default;
};

// What a row of Cochran's table is.
enum class BlockKind {
    participant_session,  // one answer per condition, as many rows as a participant has complete sessions
    participant           // one row a participant: identical in more than half of the condition's trials
};

// A table of answers for one sigma, its columns the alphas, and what had to be left out to make it complete.
struct BlockTable {
    BinaryTable table;
    std::vector<double> alphas;
    std::int64_t incomplete_blocks = 0;  // had an answer in some but not all columns; left out whole
    std::int64_t repeated_blocks =
        0;  // of the rows: further repetitions of the conditions within one session
    std::vector<std::int64_t>
        participant_sums;  // per participant with complete blocks: "identical" per column over those
};

// What is kept of a condition's trials beside the answers.
struct ConditionRecords {
    RunningMoments dropped_frames;  // share per trial
    RunningMoments gaze_loss;       // share per trial
    std::vector<float> response_times_s;
    ClusterCount foveated_first;  // successes: answered "identical"
    ClusterCount foveated_second;
    std::int64_t excluded = 0;
};

enum class Exclusions {
    applied,  // excluded trials are counted, by reason, and left out
    ignored   // they are used as any other, except those without an answer
};

class Tally {
  public:
    explicit Tally(Exclusions exclusions = Exclusions::applied) : use_exclusions_(exclusions) {}

    // Validation trials and excluded trials are counted apart and do not enter the conditions.
    void add(const Response& response);

    const std::vector<double>& sigmas() const;  // in rising order, as are alphas
    const std::vector<double>& alphas() const;
    bool has(Condition condition) const;
    std::int64_t counted() const { return counted_; }
    std::int64_t validation_trials() const { return validation_trials_; }
    std::int64_t excluded() const { return excluded_; }
    const std::map<std::string, std::int64_t>& exclusions() const { return exclusions_; }
    // One name at two sites is two people; the later one's name is then followed by the site.
    const std::vector<std::string>& participants() const { return participants_; }
    std::int64_t sessions() const;  // participant-sessions with a counted trial

    const ConditionRecords& records(Condition condition) const;  // of a condition that has() says is there
    const std::map<std::string, std::int64_t>& sites() const {
        return sites_;
    }  // counted trials per site named

    // One entry per participant, also those without a trial in the condition.
    std::vector<ClusterCount> by_participant(Condition condition) const;
    std::vector<ClusterCount> validation_by_participant() const;  // successes: answered "identical"

    BlockTable blocks(double sigma, BlockKind kind) const;

  private:
    using Answers = std::vector<std::uint8_t>;  // in the order of the trials
    struct ConditionAnswers {
        std::map<std::pair<std::size_t, int>, Answers> sessions;  // by participant and session
        ConditionRecords records;
    };
    ConditionAnswers& condition_answers(const Response& response);
    std::size_t participant_index(const Response& response);

    Exclusions use_exclusions_;
    std::vector<std::string> participants_;
    std::unordered_map<std::string, std::size_t> index_of_;
    std::vector<std::string> participant_sites_;
    std::size_t last_participant_ = 0;
    std::map<Condition, ConditionAnswers> conditions_;
    std::vector<ClusterCount> validation_;
    std::vector<double> sigmas_, alphas_;
    std::int64_t counted_ = 0, validation_trials_ = 0, excluded_ = 0;
    std::map<std::string, std::int64_t> exclusions_, sites_;
};

}  // namespace parafovea
