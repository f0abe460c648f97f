// A power simulation in parts, for several machines: each writes its studies, and all are joined.
#pragma once

#include <filesystem>
#include <vector>

#include "analysis/power.h"

namespace parafovea {

inline constexpr const char* kPowerShardName = "power.shard";

// Writes the studies of one shard into a folder, with the question they answer.
void write_power_shard(const PowerQuestion& question, const StudyShard& shard,
                       const std::vector<SimulatedStudy>& studies, const std::filesystem::path& folder);

struct MergedPower {
    PowerQuestion question;
    std::vector<SimulatedStudy> studies;  // all of them, in their order
};

// Reads every shard's folder. Throws std::runtime_error with one line where a file is missing or damaged, the
// shards are of different questions, or one is missing or given twice.
MergedPower merge_power_shards(const std::vector<std::filesystem::path>& folders);

}  // namespace parafovea
