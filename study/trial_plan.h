// The complete plan of one participant: every random draw of a study, made before the first frame.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace parafovea {

enum class TrialKind { training, condition, validation };

struct PlannedTrial {
    int number = 0;    // from 0, in the order planned; names the trial in the log
    int session = 0;   // 0 is training, testing sessions count from 1
    int block = 0;     // repetition within the session, from 0
    int position = 0;  // within the session, from 0
    TrialKind kind = TrialKind::condition;
    int condition = -1;          // index into Protocol::conditions; -1 in a validation trial
    int reference_interval = 0;  // 0 or 1: which interval shows the reference (both do in a validation trial)
    std::string scene;
    MethodSetting first, second;  // what the two intervals show

    bool operator==(const PlannedTrial&) const = default;
};

struct TrialPlan {
    int participant_index = 0;  // from 0; the row of the Williams square
    std::uint64_t seed = 0;
    std::vector<PlannedTrial> trials;

    bool operator==(const TrialPlan&) const = default;
};

// The same protocol, index and seed give the same plan on any machine. Index and seed are independent: the
// index alone decides everything that is balanced over participants.
TrialPlan make_plan(const Protocol& protocol, int participant_index, std::uint64_t seed);

// One line a trial: trial,session,block,position,kind,condition,scene,reference_interval,first,second and one
// column for each of the protocol's factors (empty where a trial has none).
void write_plan_csv(std::ostream& out, const TrialPlan& plan, const Protocol& protocol);

std::string_view kind_name(TrialKind kind);  // "training", "condition", "validation"

}  // namespace parafovea
