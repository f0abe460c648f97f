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

}  // namespace

void for_each_response_csv(const std::filesystem::path& path,
                           const std::function<void(const Response&)>& use) {
    const std::string file = path.string();
    std::ifstream input(path, std::ios::binary);
    if (!input || std::filesystem::is_directory(path))
        throw std::runtime_error(file + ": cannot be opened; expected a readable CSV file of responses");

    std::string line;
    std::vector<std::string> fields;
    std::unordered_map<std::string, std::size_t> columns;
    std::size_t width = 0;
    std::int64_t line_number = 0;
    const auto column = [&](const char* name) {
        const auto found = columns.find(name);
        return found == columns.end() ? std::string::npos : found->second;
    };
    std::size_t participant = 0, session = 0, sigma = 0, alpha = 0, identical = 0, validation = 0, method = 0,
                scene = 0, site = 0, block = 0, trial = 0, foveated_first = 0, response_time = 0, dropped = 0,
                gaze_loss = 0, excluded = 0;
    while (std::getline(input, line)) {
        const Place place{file, ++line_number};
        if (line_number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (trimmed(line).empty()) continue;
        split_fields(line, place, fields);

        // The first line that is not blank names the columns.
        if (width == 0) {
            width = fields.size();
            for (std::size_t i = 0; i < width; ++i)
                if (!columns.emplace(std::string(trimmed(fields[i])), i).second)
                    fail(place, "the column '" + fields[i] + "' appears twice");
            for (const char* required : {"participant", "session", "sigma", "alpha", "identical"})
                if (!columns.contains(required))
                    fail(place, std::string("no column '") + required +
                                    "'; expected a header with participant,session,sigma,alpha,identical");
            participant = column("participant"), session = column("session"), sigma = column("sigma");
            alpha = column("alpha"), identical = column("identical"), validation = column("validation");
            method = column("method"), scene = column("scene"), site = column("site"),
            block = column("block");
            trial = column("trial"), foveated_first = column("foveated_first");
            response_time = column("response_time_s"), dropped = column("dropped_frames");
            gaze_loss = column("gaze_loss"), excluded = column("excluded_reason");
            continue;
        }
        if (fields.size() != width)
            fail(place, std::to_string(fields.size()) + " fields; expected " + std::to_string(width) +
                            " as in the header");

        // Every other line is one response; an optional column may be empty.
        Response response;
        const auto given = [&](std::size_t index) {
            return index != std::string::npos && !trimmed(fields[index]).empty();
        };
        response.participant = trimmed(fields[participant]);
        if (response.participant.empty()) fail(place, "'participant' is empty; expected an identifier");
        response.session = parse_number<int>(place, "session", fields[session], "a whole number");
        if (given(validation)) response.validation = parse_flag(place, "validation", fields[validation]);
        if (!response.validation || given(sigma))
            response.sigma = parse_number<double>(place, "sigma", fields[sigma], "a number above 0");
        if (!response.validation || given(alpha))
            response.alpha = parse_number<double>(place, "alpha", fields[alpha], "a number above 0");
        if (!response.validation && (response.sigma <= 0.0 || response.sigma > 1e6))
            fail(place, "'sigma' is '" + fields[sigma] + "'; expected a number above 0");
        if (!response.validation && (response.alpha <= 0.0 || response.alpha > 1e6))
            fail(place, "'alpha' is '" + fields[alpha] + "'; expected a number above 0");
        if (given(method)) response.method = trimmed(fields[method]);
        if (given(scene)) response.scene = trimmed(fields[scene]);
        if (given(site)) response.site = trimmed(fields[site]);
        if (given(block)) response.block = parse_number<int>(place, "block", fields[block], "a whole number");
        if (given(trial)) response.trial = parse_number<int>(place, "trial", fields[trial], "a whole number");
        if (given(foveated_first))
            response.foveated_first = parse_flag(place, "foveated_first", fields[foveated_first]);
        if (given(response_time))
            response.response_time_s =
                parse_number<double>(place, "response_time_s", fields[response_time], "seconds");
        if (given(dropped))
            response.dropped_frames =
                parse_number<double>(place, "dropped_frames", fields[dropped], "a share from 0 to 1");
        if (given(gaze_loss))
            response.gaze_loss =
                parse_number<double>(place, "gaze_loss", fields[gaze_loss], "a share from 0 to 1");
        if (given(excluded)) response.excluded_reason = trimmed(fields[excluded]);
        response.answered = given(identical) || response.excluded_reason.empty();
        if (response.answered) response.identical = parse_flag(place, "identical", fields[identical]);
        use(response);
    }
    if (input.bad())
        throw std::runtime_error(file + ": reading stopped after line " + std::to_string(line_number));
    if (width == 0) throw std::runtime_error(file + ":1: the file is empty; expected a header and responses");
}

std::vector<Response> read_responses_csv(const std::filesystem::path& path) {
    std::vector<Response> responses;
    for_each_response_csv(path, [&](const Response& response) { responses.push_back(response); });
    return responses;
}

}  // namespace parafovea
