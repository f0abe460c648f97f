// The statements that write and read one session file's rows; the one place that knows the columns.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/database.h"
#include "study/session_log.h"
#include "study/trial_record.h"

namespace parafovea {

// Writes of a fresh file.
void write_experiment(Database& database, const Protocol& protocol);
void write_session(Database& database, const SessionFacts& facts, const TrialPlan& plan);
void write_plan(Database& database, const TrialPlan& plan, const Protocol& protocol);

// Returns the anchor's number.
std::int64_t write_anchor(Database& database, ClockAnchor anchor);

// All rows of one showing. The caller holds the transaction.
void write_trial(Database& database, const TrialRecord& record, std::int64_t anchor);
void write_calibration(Database& database, const CalibrationRecord& record, std::int64_t anchor);
void write_gaze_between(Database& database, const std::string& phase, std::span<const GazeSample> samples,
                        std::int64_t anchor);

std::string read_protocol_text(Database& database, std::string* file_name);
TrialPlan read_plan(Database& database);
SessionFacts read_facts(Database& database);
std::vector<ShownTrial> read_shown(Database& database);

}  // namespace parafovea
