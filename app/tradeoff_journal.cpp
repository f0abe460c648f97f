// Writes, reads and joins journals.
#include "app/tradeoff_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "analysis/text_file.h"

namespace parafovea {
namespace {

constexpr const char* kFirstLine = "# parafovea tradeoff journal 1";

std::string header_of(const std::string& plan, const Shard& shard, const std::string& device) {
    return std::string(kFirstLine) + "\n# shard " + shard_text(shard) + "\n# device " + device + "\n# plan " +
           plan + "\n" + tradeoff_csv_header();
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
    throw std::runtime_error(path.string() + ": " + what);
}

std::string contents_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        fail(path, "cannot be read; expected the journal that `parafovea tradeoff --out` writes there");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// The lines that have their end.
std::vector<std::string> whole_lines(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        lines.push_back(text.substr(at, end - at));
    return lines;
}

// What follows the mark at a line's beginning.
std::string after(const std::filesystem::path& path, const std::string& line, const std::string& mark) {
    if (!line.starts_with(mark))
        fail(path, "expected a line that begins with '" + mark + "'; the file is damaged");
    return line.substr(mark.size());
}

// Names the first thing two plans differ in.
std::string difference(const std::string& a, const std::string& b, const std::string& place) {
    const TradeoffPlan first = plan_from_text(a, place), second = plan_from_text(b, place);
    if (first.scenes != second.scenes) return "other scenes";
    if (first.gazes != second.gazes || first.gaze_recording != second.gaze_recording) return "other gazes";
    if (first.motions != second.motions) return "other motions";
    if (first.methods != second.methods) return "other methods or settings";
    if (first.rounds != second.rounds || first.frames != second.frames)
        return "another number of rounds or frames";
    return "another display or another reference";
}

}  // namespace

TradeoffRecord read_tradeoff_journal(const std::filesystem::path& path) {
    const std::vector<std::string> lines = whole_lines(contents_of(path));
    if (lines.empty() || lines[0] != kFirstLine)
        fail(path, std::string("is no journal of a sweep; its first line should be '") + kFirstLine + "'");
    if (lines.size() < 5) fail(path, "the journal's head is incomplete; remove the file and measure again");
    TradeoffRecord record;
    try {
        record.shard = parse_shard(after(path, lines[1], "# shard "));
    } catch (const std::runtime_error& error) {
        fail(path, error.what());
    }
    record.device = after(path, lines[2], "# device ");
    record.plan = after(path, lines[3], "# plan ");
    plan_from_text(record.plan, path.string());
    if (lines[4] + "\n" != tradeoff_csv_header())
        fail(path, "the table has other columns than this version's; choose another folder with --out");
    std::set<std::string> keys;
    for (std::size_t i = 5; i < lines.size(); ++i) {
        const std::string place = path.string() + ":" + std::to_string(i + 1);
        record.rows.push_back(parse_tradeoff_line(lines[i], place));
        if (!keys.insert(key_of(record.rows.back())).second)
            throw std::runtime_error(place + ": the row is there twice: " + key_of(record.rows.back()));
    }
    return record;
}

std::vector<TradeoffRow> rows_in_order(const TradeoffPlan& plan, const Shard& shard,
                                       const std::vector<TradeoffRow>& rows, const std::string& place) {
    std::map<std::string, const TradeoffRow*> by_key;
    for (const TradeoffRow& row : rows) by_key[key_of(row)] = &row;
    std::vector<TradeoffRow> ordered;
    std::size_t missing = 0;
    std::string first_missing;
    for (const TradeoffGroup& group : groups_of(plan, shard))
        for (const TradeoffMethod& method : methods_of(plan)) {
            const std::string key = key_of(empty_row(plan, group, method));
            const auto found = by_key.find(key);
            if (found == by_key.end()) {
                if (missing++ == 0) first_missing = key;
                continue;
            }
            ordered.push_back(*found->second);
            by_key.erase(found);
        }
    if (!by_key.empty())
        throw std::runtime_error(place + ": a row is none of its plan's: " + by_key.begin()->first);
    if (missing > 0)
        throw std::runtime_error(place + ": " + std::to_string(missing) + " of " +
                                 std::to_string(missing + ordered.size()) +
                                 " rows are not measured yet (the first: " + first_missing +
                                 "); run that shard again with the same --out, it goes on where it stopped");
    return ordered;
}

MergedTradeoff merge_tradeoff(const std::vector<std::filesystem::path>& folders) {
    if (folders.empty()) throw std::runtime_error("tradeoff --merge: no folder is given");
    MergedTradeoff merged;
    std::map<int, std::pair<std::filesystem::path, TradeoffRecord>> shards;
    std::string plan;
    int count = 0;
    for (const std::filesystem::path& folder : folders) {
        const std::filesystem::path path = folder / kTradeoffJournalName;
        TradeoffRecord record = read_tradeoff_journal(path);
        if (count == 0) {
            plan = record.plan;
            count = record.shard.count;
        }
        if (record.plan != plan)
            fail(path, "is of another plan than " + folders.front().string() + " (" +
                           difference(record.plan, plan, path.string()) + ")");
        if (record.shard.count != count)
            fail(path, "is shard " + shard_text(record.shard) + " where the others are one of " +
                           std::to_string(count));
        const int index = record.shard.index;
        const auto found = shards.find(index);
        if (found != shards.end())
            fail(path,
                 "is shard " + shard_text(record.shard) + ", and so is " + found->second.first.string());
        if (std::ranges::find(merged.devices, record.device) == merged.devices.end())
            merged.devices.push_back(record.device);
        shards.emplace(index, std::pair{path, std::move(record)});
    }
    for (int index = 1; index <= count; ++index)
        if (!shards.contains(index))
            throw std::runtime_error("tradeoff --merge: shard " + shard_text({index, count}) +
                                     " is missing; name its folder, too");
    merged.plan = plan_from_text(plan, folders.front().string());
    std::vector<TradeoffRow> rows;
    for (const auto& [index, shard] : shards) {
        const auto& [path, record] = shard;
        const std::vector<TradeoffRow> ordered =
            rows_in_order(merged.plan, record.shard, record.rows, path.string());
        rows.insert(rows.end(), ordered.begin(), ordered.end());
    }
    merged.rows = rows_in_order(merged.plan, {}, rows, "tradeoff --merge");
    return merged;
}

TradeoffJournal::TradeoffJournal(const std::filesystem::path& folder, const TradeoffPlan& plan,
                                 const Shard& shard, const std::string& device)
    : path_(folder / kTradeoffJournalName) {
    make_output_folder(folder);
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0) fail(path_, std::string("cannot be written: ") + std::strerror(errno));
    try {
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0)
            fail(path_, "another run is writing it; wait for it or choose another folder with --out");
        const std::string text = contents_of(path_);
        const std::string header = header_of(plan_text(plan), shard, device);
        // Killed before the head was on disk: nothing is lost.
        if (header.starts_with(text)) {
            if (::ftruncate(file_, 0) != 0)
                fail(path_, std::string("cannot be written: ") + std::strerror(errno));
            const auto written = ::write(file_, header.data(), header.size());
            if (written != static_cast<ssize_t>(header.size()) || ::fsync(file_) != 0)
                fail(path_, std::string("cannot be written: ") + std::strerror(errno));
            return;
        }
        TradeoffRecord record = read_tradeoff_journal(path_);
        const char* remedy = "; choose another folder with --out, or remove the file to measure anew";
        if (record.plan != plan_text(plan))
            fail(path_,
                 "was begun with " + difference(record.plan, plan_text(plan), path_.string()) + remedy);
        if (record.shard != shard)
            fail(path_, "is of shard " + shard_text(record.shard) + ", not of " + shard_text(shard) + remedy);
        if (record.device != device)
            fail(path_, "was begun on '" + record.device + "', this is '" + device + "'" + remedy);
        const std::size_t end = text.rfind('\n') + 1;
        if (end < text.size() && ::ftruncate(file_, static_cast<off_t>(end)) != 0)
            fail(path_, std::string("cannot be written: ") + std::strerror(errno));
        rows_ = std::move(record.rows);
    } catch (...) {
        ::close(file_);
        throw;
    }
}

TradeoffJournal::~TradeoffJournal() {
    ::close(file_);
}

void TradeoffJournal::append(const TradeoffRow& row) {
    const std::string line = tradeoff_csv_line(row);
    const auto written = ::write(file_, line.data(), line.size());
    if (written != static_cast<ssize_t>(line.size()) || ::fdatasync(file_) != 0)
        fail(path_, std::string("cannot be written: ") + std::strerror(errno) +
                        "; make room and run the same command again, it goes on where it stopped");
    rows_.push_back(row);
}

}  // namespace parafovea
