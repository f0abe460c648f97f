// The journal of a sweep: its plan, and each row as it was measured, so that a run that was killed goes on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/tradeoff_table.h"
#include "app/tradeoff_plan.h"

namespace parafovea {

// What a journal says.
struct TradeoffRecord {
    std::string plan;  // as plan_text() writes it
    Shard shard;
    std::string device;  // what drew the pictures: name and driver
    std::vector<TradeoffRow> rows;
};

inline constexpr const char* kTradeoffJournalName = "tradeoff.journal";

// Reads the journal at a path. A last line without its end was being written when the run was killed, and is
// left out. Throws std::runtime_error with one line where the file is missing, damaged, or has a row twice.
TradeoffRecord read_tradeoff_journal(const std::filesystem::path& path);

// The rows of all shards in the order of their plan. Throws std::runtime_error with one line where the shards
// are of different plans, one is missing or given twice, or one has not been measured to its end.
struct MergedTradeoff {
    TradeoffPlan plan;
    std::vector<std::string> devices;  // each once
    std::vector<TradeoffRow> rows;
};
MergedTradeoff merge_tradeoff(const std::vector<std::filesystem::path>& folders);

// Puts rows into the order of a plan. Throws std::runtime_error that begins with `place` where one is missing
// or none of the plan's.
std::vector<TradeoffRow> rows_in_order(const TradeoffPlan& plan, const Shard& shard,
                                       const std::vector<TradeoffRow>& rows, const std::string& place);

// Appends to the journal of one run; nobody else may write it meanwhile.
class TradeoffJournal {
  public:
    // Begins a journal in the folder, or goes on with the one that is there. Throws std::runtime_error with
    // one line where it is of another plan, shard or device, is damaged, or is being written by another run.
    TradeoffJournal(const std::filesystem::path& folder, const TradeoffPlan& plan, const Shard& shard,
                    const std::string& device);
    ~TradeoffJournal();
    TradeoffJournal(const TradeoffJournal&) = delete;
    TradeoffJournal& operator=(const TradeoffJournal&) = delete;

    // All rows, those of earlier runs first.
    const std::vector<TradeoffRow>& rows() const { return rows_; }

    // On disk before it returns.
    void append(const TradeoffRow& row);

  private:
    std::filesystem::path path_;
    int file_ = -1;
    std::vector<TradeoffRow> rows_;
};

}  // namespace parafovea
