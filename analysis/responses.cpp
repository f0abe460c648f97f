// Reads response tables kept as CSV.
#include "analysis/responses.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

namespace parafovea {
namespace {

// Where a message points to.
struct Place {
    const std::string& file;
    std::int64_t line;
};

[[noreturn]] void fail(const Place& place, const std::string& what) {
    throw std::runtime_error(place.file + ":" + std::to_string(place.line) + ": " + what);
}

// Splits a line at its commas; a quoted field may hold commas and doubled quotes (RFC 4180), not line ends.
void split_fields(std::string_view line, const Place& place, std::vector<std::string>& fields) {
    std::size_t count = 0, at = 0;
    for (;;) {
        if (count == fields.size()) fields.emplace_back();
        std::string& field = fields[count++];
        field.clear();
        if (at < line.size() && line[at] == '"') {
            for (++at;; ++at) {
                if (at == line.size())
                    fail(place, "a quoted field does not end on its line; close it with \"");
                if (line[at] != '"') {
                    field += line[at];
                } else if (at + 1 < line.size() && line[at + 1] == '"') {
                    field += line[++at];
                } else {
                    break;
                }
            }
            ++at;
            if (at < line.size() && line[at] != ',')
                fail(place, "text follows a closing quote; expected a comma");
        } else {
            const std::size_t end = std::min(line.find(',', at), line.size());
            field.assign(line.substr(at, end - at));
            at = end;
        }
        if (at >= line.size()) break;
        ++at;
    }
    fields.resize(count);
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

template <typename Number>
Number parse_number(const Place& place, const char* column, std::string_view text, const char* expected) {
    Number value{};
    const std::string_view body = trimmed(text);
    const auto [end, error] = std::from_chars(body.data(), body.data() + body.size(), value);
    bool good = error == std::errc() && end == body.data() + body.size() && !body.empty();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good)
        fail(place, std::string("'") + column + "' is '" + std::string(text) + "'; expected " + expected);
    return value;
}

bool parse_flag(const Place& place, const char* column, std::string_view text) {
    std::string body(trimmed(text));
    std::transform(body.begin(), body.end(), body.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (body == "1" || body == "true") return true;
    if (body == "0" || body == "false") return false;
    fail(place, std::string("'") + column + "' is '" + std::string(text) + "'; expected 0 or 1");
}

// Which field of a line holds what.
class ResponseColumns {
  public:
    // The fields name the columns.
    ResponseColumns(const std::vector<std::string>& names, const Place& place) : width_(names.size()) {
        std::unordered_map<std::string, std::size_t> columns;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (!columns.emplace(std::string(trimmed(names[i])), i).second)
                fail(place, "the column '" + names[i] + "' appears twice");
        for (const char* required : {"participant", "session", "sigma", "alpha", "identical"})
            if (!columns.contains(required))
                fail(place, std::string("no column '") + required +
                                "'; expected a header with participant,session,sigma,alpha,identical");
        const auto column = [&](const char* name) {
            const auto found = columns.find(name);
            return found == columns.end() ? kAbsent : found->second;
        };
        participant_ = column("participant"), session_ = column("session"), sigma_ = column("sigma");
        alpha_ = column("alpha"), identical_ = column("identical"), validation_ = column("validation");
        method_ = column("method"), scene_ = column("scene"), site_ = column("site");
        block_ = column("block"), trial_ = column("trial"), foveated_first_ = column("foveated_first");
        response_time_ = column("response_time_s"), dropped_ = column("dropped_frames");
        gaze_loss_ = column("gaze_loss"), excluded_ = column("excluded_reason");
    }

    // One response; an optional column may be empty.
    Response response(const std::vector<std::string>& fields, const Place& place) const {
        if (fields.size() != width_)
            fail(place, std::to_string(fields.size()) + " fields; expected " + std::to_string(width_) +
                            " as in the header");
        const auto given = [&](std::size_t index) {
            return index != kAbsent && !trimmed(fields[index]).empty();
        };
        const auto whole = [&](std::size_t index, const char* name) {
            return parse_number<int>(place, name, fields[index], "a whole number");
        };
        const auto share = [&](std::size_t index, const char* name) {
            return parse_number<double>(place, name, fields[index], "a share from 0 to 1");
        };
        const auto strength = [&](std::size_t index, const char* name, bool validation) {
            const double value = parse_number<double>(place, name, fields[index], "a number above 0");
            if (!validation && (value <= 0.0 || value > 1e6))
                fail(place,
                     "'" + std::string(name) + "' is '" + fields[index] + "'; expected a number above 0");
            return value;
        };
        Response response;
        response.participant = trimmed(fields[participant_]);
        if (response.participant.empty()) fail(place, "'participant' is empty; expected an identifier");
        response.session = whole(session_, "session");
        if (given(validation_)) response.validation = parse_flag(place, "validation", fields[validation_]);
        if (!response.validation || given(sigma_))
            response.sigma = strength(sigma_, "sigma", response.validation);
        if (!response.validation || given(alpha_))
            response.alpha = strength(alpha_, "alpha", response.validation);
        if (given(method_)) response.method = trimmed(fields[method_]);
        if (given(scene_)) response.scene = trimmed(fields[scene_]);
        if (given(site_)) response.site = trimmed(fields[site_]);
        if (given(block_)) response.block = whole(block_, "block");
        if (given(trial_)) response.trial = whole(trial_, "trial");
        if (given(foveated_first_))
            response.foveated_first = parse_flag(place, "foveated_first", fields[foveated_first_]);
        if (given(response_time_))
            response.response_time_s =
                parse_number<double>(place, "response_time_s", fields[response_time_], "seconds");
        if (given(dropped_)) response.dropped_frames = share(dropped_, "dropped_frames");
        if (given(gaze_loss_)) response.gaze_loss = share(gaze_loss_, "gaze_loss");
        if (given(excluded_)) response.excluded_reason = trimmed(fields[excluded_]);
        response.answered = given(identical_) || response.excluded_reason.empty();
        if (response.answered) response.identical = parse_flag(place, "identical", fields[identical_]);
        return response;
    }

  private:
    static constexpr std::size_t kAbsent = std::string::npos;
    std::size_t width_;
    std::size_t participant_, session_, sigma_, alpha_, identical_, validation_, method_, scene_, site_,
        block_, trial_, foveated_first_, response_time_, dropped_, gaze_loss_, excluded_;
};

}  // namespace

void for_each_response_csv(const std::filesystem::path& path,
                           const std::function<void(const Response&)>& use) {
    const std::string file = path.string();
    std::ifstream input(path, std::ios::binary);
    if (!input || std::filesystem::is_directory(path))
        throw std::runtime_error(file + ": cannot be opened; expected a readable CSV file of responses");

    std::string line;
    std::vector<std::string> fields;
    std::optional<ResponseColumns> columns;  // once the first line that is not blank has named them
    std::int64_t line_number = 0;
    while (std::getline(input, line)) {
        const Place place{file, ++line_number};
        if (line_number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (trimmed(line).empty()) continue;
        split_fields(line, place, fields);
        if (columns)
            use(columns->response(fields, place));
        else
            columns.emplace(fields, place);
    }
    if (input.bad())
        throw std::runtime_error(file + ": reading stopped after line " + std::to_string(line_number));
    if (!columns) throw std::runtime_error(file + ":1: the file is empty; expected a header and responses");
}

std::vector<Response> read_responses_csv(const std::filesystem::path& path) {
    std::vector<Response> responses;
    for_each_response_csv(path, [&](const Response& response) { responses.push_back(response); });
    return responses;
}

}  // namespace parafovea
