// Writes and reads the table of a sweep.
#include "analysis/tradeoff_table.h"

#include <charconv>
#include <functional>
#include <stdexcept>

#include "analysis/csv_text.h"
#include "analysis/number_text.h"

namespace parafovea {
namespace {

// A column: its name, its text in a row, and the inverse; `read` says whether the text was understood.
struct Column {
    std::string name;
    std::function<std::string(const TradeoffRow&)> write;
    std::function<bool(TradeoffRow&, const std::string&)> read;
};

template <typename Number>
bool read_number(const std::string& text, Number& value) {
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    return error == std::errc() && end == last;
}

Column text_column(const char* name, std::string TradeoffRow::*member) {
    return {name, [member](const TradeoffRow& row) { return csv_field(row.*member); },
            [member](TradeoffRow& row, const std::string& text) {
                row.*member = text;
                return true;
            }};
}

template <typename Whole>
Column whole_column(const char* name, Whole TradeoffRow::*member) {
    return {name, [member](const TradeoffRow& row) { return std::to_string(row.*member); },
            [member](TradeoffRow& row, const std::string& text) { return read_number(text, row.*member); }};
}

Column number_column(const char* name, double TradeoffRow::*member) {
    return {name, [member](const TradeoffRow& row) { return short_text(row.*member); },
            [member](TradeoffRow& row, const std::string& text) { return read_number(text, row.*member); }};
}

void add_zones(std::vector<Column>& columns, const std::string& stem,
               std::array<double, kEccentricityZones> TradeoffRow::*member) {
    constexpr std::array<const char*, kEccentricityZones> kZone = {"_0_5", "_5_15", "_15_30", "_30_up"};
    for (std::size_t z = 0; z < kZone.size(); ++z)
        columns.push_back({stem + kZone[z],
                           [member, z](const TradeoffRow& row) { return short_text((row.*member)[z]); },
                           [member, z](TradeoffRow& row, const std::string& text) {
                               return read_number(text, (row.*member)[z]);
                           }});
}

std::vector<Column> make_columns() {
    using Row = TradeoffRow;
    std::vector<Column> columns{text_column("scene", &Row::scene),
                                whole_column("width", &Row::width),
                                whole_column("height", &Row::height),
                                number_column("gaze_x", &Row::gaze_x),
                                number_column("gaze_y", &Row::gaze_y),
                                text_column("motion", &Row::motion),
                                text_column("method", &Row::method),
                                text_column("setting", &Row::setting),
                                whole_column("shaded_samples", &Row::shaded_samples),
                                number_column("frame_ms", &Row::frame_ms),
                                number_column("jod", &Row::jod)};
    add_zones(columns, "psnr", &Row::psnr_db);
    const std::vector<Column> more{number_column("flicker", &Row::flicker),
                                   number_column("predicted_p_identical", &Row::predicted_p_identical),
                                   text_column("gaze", &Row::gaze),
                                   text_column("family", &Row::family),
                                   number_column("horizontal_fov_deg", &Row::horizontal_fov_deg),
                                   number_column("peak_cd_m2", &Row::peak_cd_m2),
                                   number_column("refresh_hz", &Row::refresh_hz),
                                   whole_column("frames", &Row::frames),
                                   number_column("frame_ms_low", &Row::frame_ms_low),
                                   number_column("frame_ms_high", &Row::frame_ms_high),
                                   number_column("full_frame_ms", &Row::full_frame_ms),
                                   number_column("shading_ms", &Row::shading_ms),
                                   text_column("passes_ms", &Row::passes_ms),
                                   whole_column("memory_bytes", &Row::memory_bytes),
                                   number_column("jod_supersampled", &Row::jod_supersampled),
                                   number_column("jod_transient", &Row::jod_transient),
                                   number_column("psnr", &Row::psnr_whole_db),
                                   number_column("flip", &Row::flip)};
    columns.insert(columns.end(), more.begin(), more.end());
    add_zones(columns, "jod", &Row::jod_zone);
    add_zones(columns, "flip", &Row::flip_zone);
    return columns;
}

const std::vector<Column>& columns_of_table() {
    static const std::vector<Column> columns = make_columns();
    return columns;
}

// Fields of a line; a quoted field may hold commas and doubled quotes (RFC 4180).
std::vector<std::string> fields_of(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"') {
            if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
                fields.back() += '"';
                ++i;
            } else {
                quoted = !quoted;
            }
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

}  // namespace

std::string key_of(const TradeoffRow& row) {
    return row.scene + ", " + std::to_string(row.width) + "x" + std::to_string(row.height) + " at " +
           short_text(row.horizontal_fov_deg) + " degrees, gaze " + row.gaze + ", motion " + row.motion +
           ", " + row.family + (row.setting.empty() ? "" : " (" + row.method + " " + row.setting + ")");
}

std::string tradeoff_csv_header() {
    std::string header;
    for (const Column& column : columns_of_table()) header += (header.empty() ? "" : ",") + column.name;
    return header + "\n";
}

std::string tradeoff_csv_line(const TradeoffRow& row) {
    std::string line;
    const char* separator = "";
    for (const Column& column : columns_of_table()) {
        line += separator + column.write(row);
        separator = ",";
    }
    return line + "\n";
}

std::string tradeoff_csv(const std::vector<TradeoffRow>& rows) {
    std::string csv = tradeoff_csv_header();
    for (const TradeoffRow& row : rows) csv += tradeoff_csv_line(row);
    return csv;
}

TradeoffRow parse_tradeoff_line(std::string_view line, const std::string& place) {
    const std::vector<Column>& columns = columns_of_table();
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != columns.size())
        throw std::runtime_error(place + ": " + std::to_string(fields.size()) + " fields; expected " +
                                 std::to_string(columns.size()) + " as in the header");
    TradeoffRow row;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (!columns[i].read(row, fields[i]))
            throw std::runtime_error(place + ": '" + columns[i].name + "' is '" + fields[i] +
                                     "'; expected a number");
    return row;
}

}  // namespace parafovea
