// Parsing of the three recording formats, and the writer of our own.
#include "devices/gaze_recording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "devices/unit_vector.h"

namespace parafovea {
namespace {

constexpr std::string_view kOwnHeader =
    "sequence,device_time_ns,host_time_ns,host_time_error_ns,arrival_time_ns,status,azimuth_deg,elevation_"
    "deg,"
    "left_azimuth_deg,left_elevation_deg,left_pupil_mm,right_azimuth_deg,right_elevation_deg,right_pupil_mm";
constexpr std::array kStatusNames = {"tracked", "low_accuracy", "blink", "lost"};

std::string quoted(std::string_view text) {
    std::string result(1, '"');
    result += text;
    result += '"';
    return result;
}

// A text table with a header line: fields by column name, errors by line.
class Table {
  public:
    Table(std::string_view text, const std::string& name) : text_(text), name_(name) {
        if (!next_line()) fail("the file is empty; expected a gaze recording");
        header_ = line_;
        separator_ = header_.find('\t') != std::string_view::npos ? '\t' : ',';
        columns_ = split(header_);
    }

    std::string_view header() const { return header_; }

    bool has(std::string_view column) const {
        return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
    }

    std::size_t column(std::string_view wanted) const {
        const auto found = std::find(columns_.begin(), columns_.end(), wanted);
        if (found == columns_.end()) fail("there is no column " + quoted(wanted));
        return static_cast<std::size_t>(found - columns_.begin());
    }

    // False at the end; empty lines are passed over.
    bool next_row() {
        do {
            if (!next_line()) return false;
        } while (line_.empty());
        fields_ = split(line_);
        if (fields_.size() != columns_.size())
            fail("expected " + std::to_string(columns_.size()) + " fields, found " +
                 std::to_string(fields_.size()));
        return true;
    }

    std::string_view text(std::size_t column) const { return fields_[column]; }

    double number(std::size_t column) const {
        double value = 0;
        const std::string_view field = fields_[column];
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size() || std::isinf(value))
            fail(quoted(field) + " in column " + quoted(columns_[column]) + " is not a number");
        return value;
    }

    std::int64_t whole_number(std::size_t column) const {
        std::int64_t value = 0;
        const std::string_view field = fields_[column];
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size())
            fail(quoted(field) + " in column " + quoted(columns_[column]) + " is not a whole number");
        return value;
    }

    std::optional<double> optional_number(std::size_t column) const {
        if (fields_[column].empty()) return std::nullopt;
        return number(column);
    }

    [[noreturn]] void fail(const std::string& why) const {
        throw std::runtime_error(name_ + ":" + std::to_string(line_number_) + ": " + why);
    }

  private:
    bool next_line() {
        if (position_ >= text_.size()) return false;
        const std::size_t end = std::min(text_.find('\n', position_), text_.size());
        line_ = text_.substr(position_, end - position_);
        if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
        position_ = end + 1;
        ++line_number_;
        return true;
    }

    std::vector<std::string_view> split(std::string_view line) const {
        std::vector<std::string_view> fields;
        for (std::size_t begin = 0;;) {
            const std::size_t end = std::min(line.find(separator_, begin), line.size());
            fields.push_back(line.substr(begin, end - begin));
            if (end == line.size()) return fields;
            begin = end + 1;
        }
    }

    std::string_view text_;
    std::string name_;
    std::size_t position_ = 0;
    int line_number_ = 0;
    char separator_ = ',';
    std::string_view line_, header_;
    std::vector<std::string_view> columns_, fields_;
};

// Sets the cyclopean direction and the status from the eyes.
void combine_eyes(GazeSample& sample) {
    const auto left = sample.left ? sample.left->direction : std::nullopt;
    const auto right = sample.right ? sample.right->direction : std::nullopt;
    if (left && right)
        sample.direction = mean_direction(*left, *right);
    else
        sample.direction = left ? left : right;
    sample.status = sample.direction ? GazeStatus::tracked : GazeStatus::lost;
}

void parse_own(Table& table, GazeRecording& recording) {
    const auto eye = [&](std::size_t first) -> std::optional<EyeSample> {
        EyeSample sample;
        const auto azimuth = table.optional_number(first), elevation = table.optional_number(first + 1);
        if (azimuth.has_value() != elevation.has_value()) table.fail("an azimuth needs an elevation");
        if (azimuth) sample.direction = {*azimuth, *elevation};
        sample.pupil_mm = table.optional_number(first + 2);
        if (!sample.direction && !sample.pupil_mm) return std::nullopt;
        return sample;
    };
    while (table.next_row()) {
        GazeSample sample;
        sample.sequence = table.whole_number(0);
        sample.device_time = {table.whole_number(1)};
        sample.host_time = {table.whole_number(2)};
        sample.host_time_error = {table.whole_number(3)};
        sample.arrival_time = {table.whole_number(4)};
        const auto status = std::find(kStatusNames.begin(), kStatusNames.end(), table.text(5));
        if (status == kStatusNames.end())
            table.fail("the status " + quoted(table.text(5)) +
                       " is unknown; expected tracked, low_accuracy, blink or lost");
        sample.status = static_cast<GazeStatus>(status - kStatusNames.begin());
        const auto azimuth = table.optional_number(6), elevation = table.optional_number(7);
        if (azimuth.has_value() != elevation.has_value()) table.fail("an azimuth needs an elevation");
        if (azimuth) sample.direction = {*azimuth, *elevation};
        sample.left = eye(8);
        sample.right = eye(11);
        recording.samples.push_back(sample);
    }
}

void parse_head_mounted(Table& table, GazeRecording& recording) {
    const std::size_t time = table.column("OcutimeStamp");
    const std::size_t left_x = table.column("leftEyeDirection.x"),
                      right_x = table.column("rightEyeDirection.x");
    const std::size_t left_valid = table.column("valL"), right_valid = table.column("valR");
    if (table.column("leftEyeDirection.z") != left_x + 2 ||
        table.column("rightEyeDirection.z") != right_x + 2)
        table.fail("the columns x, y, z of an eye's direction do not stand side by side");
    const auto eye = [&](std::size_t x, std::size_t valid) {
        EyeSample sample;
        const Vector3 v{table.number(x), table.number(x + 1), table.number(x + 2)};
        const double norm = length(v);
        if (table.text(valid) == "True" && norm > 0.5 && norm < 2) sample.direction = direction_of(v);
        return sample;
    };
    std::int64_t first_us = 0;
    while (table.next_row()) {
        GazeSample sample;
        const std::int64_t us = table.whole_number(time);
        if (recording.samples.empty()) first_us = us;
        sample.sequence = static_cast<std::int64_t>(recording.samples.size());
        sample.device_time = {us * 1000};
        sample.host_time = sample.arrival_time = {(us - first_us) * 1000};
        sample.left = eye(left_x, left_valid);
        sample.right = eye(right_x, right_valid);
        combine_eyes(sample);
        recording.samples.push_back(sample);
    }
}

void parse_validation(Table& table, GazeRecording& recording, const RecordedScreen& screen) {
    const std::size_t time = table.column("timestamp"), id = table.column("target_id");
    const std::size_t target_x = table.column("tar_x"), target_y = table.column("tar_y");
    const auto direction = [&](double x_px, double y_px) {
        return direction_of({x_px * screen.width_mm / screen.width_px,
                             y_px * screen.height_mm / screen.height_px, screen.distance_mm});
    };
    const auto eye = [&](const char* side) -> std::optional<EyeSample> {
        const std::string x_name = std::string(side) + "_x";
        if (!table.has(x_name)) return std::nullopt;
        const double x = table.number(table.column(x_name)),
                     y = table.number(table.column(std::string(side) + "_y"));
        EyeSample sample;
        if (!std::isnan(x) && !std::isnan(y)) sample.direction = direction(x, y);
        return sample;
    };
    double first_ms = 0;
    while (table.next_row()) {
        GazeSample sample;
        const double ms = table.number(time);
        if (recording.samples.empty()) first_ms = ms;
        sample.sequence = static_cast<std::int64_t>(recording.samples.size());
        sample.device_time = {static_cast<std::int64_t>(std::llround(ms * 1e6))};
        sample.host_time =
            sample.arrival_time = {static_cast<std::int64_t>(std::llround((ms - first_ms) * 1e6))};
        sample.left = eye("left");
        sample.right = eye("right");
        combine_eyes(sample);
        recording.samples.push_back(sample);

        const std::int64_t target = table.whole_number(id);
        if (target < 0)
            recording.targets.emplace_back();
        else
            recording.targets.push_back(RecordedTarget{
                static_cast<int>(target), direction(table.number(target_x), table.number(target_y))});
    }
}

template <typename Number>
void put(std::ostream& out, Number value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    out.write(text, end - text);
}

void put_optional(std::ostream& out, std::optional<double> value) {
    out << ',';
    if (value) put(out, *value);
}

void put_direction(std::ostream& out, const std::optional<DirectionDeg>& d) {
    put_optional(out, d ? std::optional(d->azimuth_deg) : std::nullopt);
    put_optional(out, d ? std::optional(d->elevation_deg) : std::nullopt);
}

}  // namespace

GazeRecording parse_gaze_recording(std::string_view text, const std::string& name,
                                   const RecordedScreen& screen) {
    Table table(text, name);
    GazeRecording recording;
    recording.name = name;
    if (table.header() == kOwnHeader) {
        recording.format = "parafovea gaze CSV";
        parse_own(table, recording);
    } else if (table.has("OcutimeStamp")) {
        recording.format = "head-mounted display CSV (salient360Toolbox)";
        parse_head_mounted(table, recording);
    } else if (table.has("target_id")) {
        recording.format = "validation TSV (ETDQualitizer)";
        parse_validation(table, recording, screen);
    } else {
        table.fail(
            "the header is none of a known gaze recording: ours begins \"sequence,device_time_ns\", a "
            "head-mounted "
            "display's has \"OcutimeStamp\", a validation recording's has \"target_id\"");
    }
    if (recording.samples.empty()) table.fail("the recording has no samples");

    std::vector<std::int64_t> intervals;
    for (std::size_t i = 1; i < recording.samples.size(); ++i) {
        const Duration interval = recording.samples[i].host_time - recording.samples[i - 1].host_time;
        if (interval.ns < 0)
            throw std::runtime_error(name + ": time runs backwards at sample " + std::to_string(i + 1) +
                                     "; expected samples in the order of time");
        intervals.push_back(interval.ns);
    }
    if (!intervals.empty()) {
        const auto median = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
        std::nth_element(intervals.begin(), median, intervals.end());
        if (*median > 0) recording.rate_hz = 1e9 / static_cast<double>(*median);
    }
    return recording;
}

GazeRecording read_gaze_recording(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (file) text << file.rdbuf();
    if (!file || file.bad())
        throw std::runtime_error("cannot read the gaze recording " + path.string() +
                                 "; check that the file is there and readable");
    return parse_gaze_recording(text.str(), path.filename().string());
}

void write_gaze_csv(std::ostream& out, std::span<const GazeSample> samples) {
    out << kOwnHeader << '\n';
    for (const GazeSample& sample : samples) {
        put(out, sample.sequence);
        for (const std::int64_t ns : {sample.device_time.ns, sample.host_time.ns, sample.host_time_error.ns,
                                      sample.arrival_time.ns}) {
            out << ',';
            put(out, ns);
        }
        out << ',' << kStatusNames[static_cast<std::size_t>(sample.status)];
        put_direction(out, sample.direction);
        for (const auto& eye : {sample.left, sample.right}) {
            put_direction(out, eye ? eye->direction : std::nullopt);
            put_optional(out, eye ? eye->pupil_mm : std::nullopt);
        }
        out << '\n';
    }
}

}  // namespace parafovea
