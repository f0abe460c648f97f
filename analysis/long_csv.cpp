// One long table of all trials with a codebook: the export that every statistics program reads.
#include "analysis/long_csv.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/csv_text.h"
#include "analysis/number_text.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

const std::vector<LongColumn>& fixed_columns() {
    static const std::vector<LongColumn> kColumns{
        {"participant", "Identifier of the participant", "", ""},
        {"session", "Number of the participant's testing session", "", "whole number from 1"},
        {"sigma",
         "Reduction of the log-polar buffer: its width and height are those of the screen over sigma", "",
         "above 0; empty for validation trials"},
        {"alpha", "Exponent of the kernel function x^alpha", "", "above 0; empty for validation trials"},
        {"identical", "The answer: the two pictures looked the same", "",
         "1 identical, 0 different, empty no answer"},
        {"validation", "Both pictures were drawn at full resolution", "", "0 or 1"},
        {"method", "How the reduced picture was drawn", "", ""},
        {"scene", "Scene shown", "", ""},
        {"site", "Where the session was recorded", "", ""},
        {"block", "Index of the block in the session", "", "whole number"},
        {"trial", "Index of the trial in the session", "", "whole number"},
        {"foveated_first", "The foveated picture was the first of the two", "",
         "0 or 1, empty when not known"},
        {"response_time_s", "Time from the question to the answer", "s", ""},
        {"dropped_frames", "Share of the trial's refreshes that were missed", "", "0 to 1"},
        {"gaze_loss", "Share of the trial's gaze samples without a gaze", "", "0 to 1"},
        {"excluded_reason", "Why the trial is not counted, by rules stored before the first session", "",
         "empty: counted"}};
    return kColumns;
}

std::string number(const std::optional<double>& value) {
    return value ? short_text(*value) : std::string();
}

}  // namespace

LongCsvWriter::LongCsvWriter(const std::filesystem::path& folder, const std::vector<LongColumn>& further)
    : table_path_(folder / "responses.csv"),
      codebook_path_(folder / "responses.codebook.json"),
      further_(further.size()) {
    make_output_folder(folder);
    std::vector<LongColumn> columns = fixed_columns();
    for (const LongColumn& column : further) {
        if (std::any_of(columns.begin(), columns.end(),
                        [&](const LongColumn& c) { return c.name == column.name; }))
            throw std::runtime_error("long CSV: the column '" + column.name + "' is there already");
        columns.push_back(column);
    }
    nlohmann::ordered_json book;
    std::string head;
    for (const LongColumn& column : columns) {
        head += (head.empty() ? "" : ",") + csv_field(column.name);
        nlohmann::ordered_json& entry = book[column.name];
        entry["description"] = column.description;
        if (!column.units.empty()) entry["units"] = column.units;
        if (!column.values.empty()) entry["values"] = column.values;
    }
    write_text_file(codebook_path_,
                    book.dump(2, ' ', false, nlohmann::detail::error_handler_t::replace) + "\n");
    table_.open(table_path_, std::ios::binary | std::ios::trunc);
    table_ << head << "\n";
    if (!table_)
        throw std::runtime_error(table_path_.string() + ": cannot be written; is the folder writable?");
}

void LongCsvWriter::write(const Response& response, const std::vector<std::string>& further) {
    if (further.size() != further_)
        throw std::runtime_error("long CSV: " + std::to_string(further.size()) + " further values for " +
                                 std::to_string(further_) + " columns");
    const bool settings = !response.validation;
    const auto flag = [](bool value) { return value ? "1" : "0"; };
    std::string row = csv_field(response.participant) + "," + std::to_string(response.session) + ",";
    row += (settings ? short_text(response.sigma) : "") + "," + (settings ? short_text(response.alpha) : "") +
           ",";
    row += std::string(response.answered ? flag(response.identical) : "") + "," + flag(response.validation) +
           ",";
    row +=
        csv_field(response.method) + "," + csv_field(response.scene) + "," + csv_field(response.site) + ",";
    row += std::to_string(response.block) + "," + std::to_string(response.trial) + ",";
    row += std::string(response.foveated_first ? flag(*response.foveated_first) : "") + ",";
    row += number(response.response_time_s) + "," + number(response.dropped_frames) + "," +
           number(response.gaze_loss) + ",";
    row += csv_field(response.excluded_reason);
    for (const std::string& value : further) row += "," + csv_field(value);
    row += "\n";
    table_.write(row.data(), static_cast<std::streamsize>(row.size()));
}

void LongCsvWriter::finish() {
    table_.close();
    if (!table_)
        throw std::runtime_error(table_path_.string() + ": cannot be written to its end; is the disk full?");
}

}  // namespace parafovea
