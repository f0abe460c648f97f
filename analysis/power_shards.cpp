// Writes and joins parts of a power simulation.
#include "analysis/power_shards.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "analysis/number_text.h"
#include "analysis/text_file.h"

namespace parafovea {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFirstLine = "# parafovea power shard 1";
constexpr const char* kHeader =
    "cochran,permutation,undefined,any_holm,wilson_width,clustered_width,decided_sigma";

std::string question_text(const PowerQuestion& question) {
    Json plan = Json::array(), functions = Json::array();
    for (const PlanCell& cell : question.plan)
        plan.push_back({cell.condition.sigma, cell.condition.alpha, cell.trials_per_session});
    const PowerAssumptions& assumed = question.assumptions;
    for (const AssumedFunction& function : assumed.functions)
        functions.push_back({function.alpha, function.threshold, function.width});
    Json json;
    json["plan"] = plan;
    json["functions"] = functions;
    json["rates"] = {assumed.lapse_rate, assumed.guess_rate, assumed.participant_sd, assumed.condition_sd};
    json["participants"] = question.participants;
    json["sessions"] = question.sessions;
    json["effects"] = question.effects;
    json["studies"] = question.studies;
    json["permutations"] = question.permutations;
    json["criterion"] = question.criterion;
    json["level"] = question.level;
    json["seed"] = question.seed;
    return json.dump();
}

PowerQuestion question_from(const std::string& text) {
    const Json json = Json::parse(text);
    PowerQuestion question;
    for (const Json& cell : json.at("plan")) question.plan.push_back({{cell.at(0), cell.at(1)}, cell.at(2)});
    PowerAssumptions& assumed = question.assumptions;
    for (const Json& function : json.at("functions"))
        assumed.functions.push_back({function.at(0), function.at(1), function.at(2)});
    const Json& rates = json.at("rates");
    assumed.lapse_rate = rates.at(0);
    assumed.guess_rate = rates.at(1);
    assumed.participant_sd = rates.at(2);
    assumed.condition_sd = rates.at(3);
    question.participants = json.at("participants").get<std::vector<int>>();
    question.sessions = json.at("sessions").get<std::vector<int>>();
    question.effects = json.at("effects").get<std::vector<double>>();
    question.studies = json.at("studies");
    question.permutations = json.at("permutations");
    question.criterion = json.at("criterion");
    question.level = json.at("level");
    question.seed = json.at("seed");
    return question;
}

std::string switches_text(const std::vector<std::uint8_t>& values) {
    std::string text;
    for (const std::uint8_t value : values) text += value ? '1' : '0';
    return text;
}

[[noreturn]] void fail(const std::string& place, const std::string& what) {
    throw std::runtime_error(place + ": " + what);
}

std::vector<std::uint8_t> switches_from(const std::string& text, std::size_t sigmas,
                                        const std::string& place) {
    if (text.size() != sigmas || text.find_first_not_of("01") != std::string::npos)
        fail(place, "expected " + std::to_string(sigmas) + " zeros and ones, found '" + text + "'");
    std::vector<std::uint8_t> values;
    for (const char c : text) values.push_back(c == '1' ? 1 : 0);
    return values;
}

double number_from(const std::string& text, const std::string& place) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
        fail(place, "expected a number, found '" + text + "'");
    return value;
}

SimulatedStudy study_from(const std::string& line, std::size_t sigmas, const std::string& place) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    if (fields.size() != 7) fail(place, "expected 7 fields; the file is damaged");
    SimulatedStudy study;
    study.cochran = switches_from(fields[0], sigmas, place);
    study.permutation = switches_from(fields[1], sigmas, place);
    study.undefined = switches_from(fields[2], sigmas, place);
    study.any_holm = fields[3] == "1";
    study.wilson_width = number_from(fields[4], place);
    study.clustered_width = number_from(fields[5], place);
    study.decided_sigma = number_from(fields[6], place);
    return study;
}

struct ReadShard {
    std::string question;
    StudyShard shard;
    std::vector<SimulatedStudy> studies;
};

std::size_t studies_of(const PowerQuestion& question, const StudyShard& shard) {
    const std::size_t all = study_count(question), count = static_cast<std::size_t>(shard.count);
    return (all + count - static_cast<std::size_t>(shard.index)) / count;
}

ReadShard read_shard(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) fail(path.string(), "cannot be read; expected what `parafovea power --shard` writes there");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    if (lines.size() < 4 || lines[0] != kFirstLine || !lines[1].starts_with("# shard ") ||
        !lines[2].starts_with("# question ") || lines[3] != kHeader)
        fail(path.string(), "is no shard of a power simulation, or of another version");
    ReadShard read;
    const std::string numbers = lines[1].substr(8);
    const std::size_t slash = std::min(numbers.find('/'), numbers.size() - 1);
    read.shard.index = static_cast<int>(number_from(numbers.substr(0, slash), path.string()));
    read.shard.count = static_cast<int>(number_from(numbers.substr(slash + 1), path.string()));
    if (read.shard.index < 1 || read.shard.index > read.shard.count)
        fail(path.string(), "is shard " + numbers + ", which there cannot be");
    read.question = lines[2].substr(11);
    PowerQuestion question;
    try {
        question = question_from(read.question);
    } catch (const nlohmann::json::exception&) {
        fail(path.string(), "the question cannot be read; the file is damaged");
    }
    std::vector<double> sigmas;
    for (const PlanCell& cell : question.plan)
        if (std::ranges::find(sigmas, cell.condition.sigma) == sigmas.end())
            sigmas.push_back(cell.condition.sigma);
    for (std::size_t i = 4; i < lines.size(); ++i)
        read.studies.push_back(
            study_from(lines[i], sigmas.size(), path.string() + ":" + std::to_string(i + 1)));
    const std::size_t expected = studies_of(question, read.shard);
    if (read.studies.size() != expected)
        fail(path.string(), std::to_string(read.studies.size()) + " studies; expected " +
                                std::to_string(expected) + ". Run that shard again");
    return read;
}

}  // namespace

void write_power_shard(const PowerQuestion& question, const StudyShard& shard,
                       const std::vector<SimulatedStudy>& studies, const std::filesystem::path& folder) {
    std::string text = std::string(kFirstLine) + "\n# shard " + std::to_string(shard.index) + "/" +
                       std::to_string(shard.count) + "\n# question " + question_text(question) + "\n" +
                       kHeader + "\n";
    for (const SimulatedStudy& study : studies)
        text += switches_text(study.cochran) + "," + switches_text(study.permutation) + "," +
                switches_text(study.undefined) + "," + (study.any_holm ? "1" : "0") + "," +
                short_text(study.wilson_width) + "," + short_text(study.clustered_width) + "," +
                short_text(study.decided_sigma) + "\n";
    make_output_folder(folder);
    write_text_file(folder / kPowerShardName, text);
}

MergedPower merge_power_shards(const std::vector<std::filesystem::path>& folders) {
    if (folders.empty()) throw std::runtime_error("power --merge: no folder is given");
    std::map<int, std::pair<std::filesystem::path, ReadShard>> shards;
    std::string question;
    int count = 0;
    for (const std::filesystem::path& folder : folders) {
        const std::filesystem::path path = folder / kPowerShardName;
        ReadShard read = read_shard(path);
        if (count == 0) {
            question = read.question;
            count = read.shard.count;
        }
        if (read.question != question)
            fail(path.string(), "answers another question than " + folders.front().string() +
                                    " (design, assumptions, participants, studies or seed)");
        if (read.shard.count != count)
            fail(path.string(), "is one of " + std::to_string(read.shard.count) +
                                    " shards where the others are one of " + std::to_string(count));
        const int index = read.shard.index;
        const auto found = shards.find(index);
        if (found != shards.end())
            fail(path.string(),
                 "is shard " + std::to_string(index) + ", and so is " + found->second.first.string());
        shards.emplace(index, std::pair{path, std::move(read)});
    }
    for (int index = 1; index <= count; ++index)
        if (!shards.contains(index))
            throw std::runtime_error("power --merge: shard " + std::to_string(index) + "/" +
                                     std::to_string(count) + " is missing; name its folder, too");
    MergedPower merged;
    merged.question = question_from(question);
    merged.studies.resize(study_count(merged.question));
    for (std::size_t i = 0; i < merged.studies.size(); ++i) {
        const std::size_t parts = static_cast<std::size_t>(count);
        merged.studies[i] = shards.at(static_cast<int>(i % parts) + 1).second.studies[i / parts];
    }
    return merged;
}

}  // namespace parafovea
