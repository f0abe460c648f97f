// Counts what the plans of a group balance.
#include "study/balance_report.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <limits>
#include <map>
#include <ostream>
#include <string>

#include "study/counterbalance.h"
#include "study/trial_plan.h"

namespace parafovea {
namespace {

// One session over all participants.
struct SessionTally {
    std::vector<std::vector<int>> orders;  // of conditions, a row for each participant
    std::map<std::string, int> scenes;     // trials
    int least_reference_first = std::numeric_limits<int>::max(), most_reference_first = 0;
    int least_validation = std::numeric_limits<int>::max(), most_validation = 0;
    int trials = 0;                    // of one participant
    std::vector<int> reference_first;  // by condition, over participants
};

SessionTally tally_of(const std::vector<TrialPlan>& plans, int session, std::size_t conditions) {
    SessionTally tally;
    tally.reference_first.resize(conditions);
    for (const TrialPlan& plan : plans) {
        std::vector<int> order;
        int reference_first = 0, validation = 0;
        tally.trials = 0;
        for (const PlannedTrial& trial : plan.trials) {
            if (trial.session != session) continue;
            ++tally.trials;
            ++tally.scenes[trial.scene];
            if (trial.kind == TrialKind::validation) ++validation;
            if (trial.kind != TrialKind::condition) continue;
            order.push_back(trial.condition);
            if (trial.reference_interval != 0) continue;
            ++reference_first;
            ++tally.reference_first[static_cast<std::size_t>(trial.condition)];
        }
        tally.orders.push_back(std::move(order));
        tally.least_reference_first = std::min(tally.least_reference_first, reference_first);
        tally.most_reference_first = std::max(tally.most_reference_first, reference_first);
        tally.least_validation = std::min(tally.least_validation, validation);
        tally.most_validation = std::max(tally.most_validation, validation);
    }
    return tally;
}

std::string range(int low, int high) {
    return low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high);
}

void write_session(std::ostream& out, int session, const SessionTally& tally, std::size_t conditions) {
    const Balance balance = balance_of(tally.orders, static_cast<int>(conditions));
    char share[64];
    std::snprintf(share, sizeof share, "%.4g %%", 100.0 * tally.most_validation / tally.trials);
    const auto [fewest, most] =
        std::minmax_element(tally.reference_first.begin(), tally.reference_first.end());
    out << "session " << session << "\n"
        << "  trials                            " << tally.trials << "\n"
        << "  validation trials                 " << range(tally.least_validation, tally.most_validation)
        << " (" << share << ")\n"
        << "  a condition at a position         " << range(balance.position_low, balance.position_high)
        << " times\n"
        << "  a condition followed by another   " << range(balance.followed_low, balance.followed_high)
        << " times\n"
        << "  reference first, a participant    "
        << range(tally.least_reference_first, tally.most_reference_first) << " of "
        << tally.orders.front().size() << " condition trials\n"
        << "  reference first, a condition      " << range(*fewest, *most) << " of " << tally.orders.size()
        << " participants\n";
    for (const auto& [scene, trials] : tally.scenes)
        out << "  scene " << scene << ": " << trials << " trials\n";
}

}  // namespace

void write_balance_report(std::ostream& out, const Protocol& protocol, int first, int last,
                          std::uint64_t seed) {
    assert(first >= 0 && last >= first);
    std::vector<TrialPlan> plans;
    for (int participant = first; participant <= last; ++participant)
        plans.push_back(make_plan(protocol, participant, seed));
    out << protocol.name << ": " << protocol.conditions.size() << " conditions, " << plans.size()
        << " participants\n";
    for (int session = 1; session <= protocol.design.sessions; ++session)
        write_session(out, session, tally_of(plans, session, protocol.conditions.size()),
                      protocol.conditions.size());
}

}  // namespace parafovea
