// Lays a sweep out, and writes it down.
#include "app/tradeoff_plan.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "analysis/number_text.h"
#include "app/options.h"
#include "renderer/methods/method_list.h"

namespace parafovea {
namespace {

using Json = nlohmann::ordered_json;

void check_listed(const std::vector<std::string>& given, const std::vector<std::string>& known,
                  const char* what) {
    std::set<std::string> seen;
    if (given.empty()) throw std::runtime_error(std::string("tradeoff: no ") + what + " is given");
    for (const std::string& name : given) {
        if (!seen.insert(name).second)
            throw std::runtime_error(std::string("tradeoff: the ") + what + " '" + name +
                                     "' is listed twice");
        if (known.empty() || std::ranges::find(known, name) != known.end()) continue;
        std::string names;
        for (const std::string& one : known) names += (names.empty() ? "" : ", ") + one;
        throw std::runtime_error(std::string("tradeoff: no ") + what + " '" + name +
                                 "'; there are: " + names);
    }
}

Json json_of(const TradeoffMethod& method) {
    Json numbers = Json::object(), words = Json::object();
    for (const auto& [name, value] : method.method.numbers) numbers[name] = value;
    for (const auto& [name, value] : method.method.words) words[name] = value;
    return {
        {"family", method.family}, {"method", method.method.name}, {"numbers", numbers}, {"words", words}};
}

TradeoffMethod method_from(const Json& json) {
    TradeoffMethod method{json.at("family"), {json.at("method"), {}, {}}};
    for (const auto& [name, value] : json.at("numbers").items()) method.method.numbers[name] = value;
    for (const auto& [name, value] : json.at("words").items()) method.method.words[name] = value;
    return method;
}

std::string lower_key(const std::string& label) {
    std::string key = label;
    std::ranges::transform(key, key.begin(), [](unsigned char c) {
        return c == ' ' ? '_' : static_cast<char>(std::tolower(c));
    });
    return key;
}

}  // namespace

std::vector<TradeoffMethod> methods_of(const TradeoffPlan& plan) {
    std::vector<TradeoffMethod> methods{{"full resolution", {}}};
    for (const TradeoffMethod& method : plan.methods)
        if (method.method != RenderMethod{}) methods.push_back(method);
    if (plan.taa > 0)
        for (TradeoffMethod& method : methods) method.method.numbers.try_emplace("taa", plan.taa);
    return methods;
}

std::string setting_text(const RenderMethod& method) {
    std::string text;
    for (const auto& [name, value] : method.numbers)
        text += (text.empty() ? "" : " ") + name + "=" + short_text(value);
    for (const auto& [name, value] : method.words) text += (text.empty() ? "" : " ") + name + "=" + value;
    return text;
}

std::vector<TradeoffGroup> groups_of(const TradeoffPlan& plan, const Shard& shard) {
    std::vector<TradeoffGroup> groups;
    int number = 0;
    for (const std::string& scene : plan.scenes)
        for (const ViewGeometry& view : plan.views)
            for (const std::string& gaze : plan.gazes)
                for (const std::string& motion : plan.motions)
                    if (number++ % shard.count == shard.index - 1)
                        groups.push_back({scene, view, gaze, motion});
    return groups;
}

TradeoffRow empty_row(const TradeoffPlan& plan, const TradeoffGroup& group, const TradeoffMethod& method) {
    TradeoffRow row;
    row.scene = group.scene;
    row.width = group.view.size.width;
    row.height = group.view.size.height;
    row.horizontal_fov_deg = group.view.horizontal_fov_deg;
    row.peak_cd_m2 = plan.peak_cd_m2;
    row.refresh_hz = plan.refresh_hz;
    row.gaze = group.gaze;
    row.motion = group.motion;
    row.family = method.family;
    row.method = method.method.name;
    row.setting = setting_text(method.method);
    row.frames = group.moves() ? plan.frames : 1;
    return row;
}

void check(const TradeoffPlan& plan) {
    check_listed(plan.scenes, {}, "scene");
    check_listed(plan.gazes, {"centre", "quarter", "corner", "path"}, "gaze");
    check_listed(plan.motions, {"still", "path"}, "motion");
    if (plan.views.empty()) throw std::runtime_error("tradeoff: no size is given");
    for (const ViewGeometry& view : plan.views)
        if (!(view.horizontal_fov_deg > 0 && view.horizontal_fov_deg < 180))
            throw std::runtime_error(
                "tradeoff: a horizontal field of view is between 0 and 180 degrees, found " +
                short_text(view.horizontal_fov_deg));
    const auto within = [](const char* what, double value, double low, double high) {
        if (value >= low && value <= high) return;
        throw std::runtime_error(std::string("tradeoff: ") + what + " is from " + short_text(low) + " to " +
                                 short_text(high) + ", found " + short_text(value));
    };
    within("the number of rounds", plan.rounds, 1, 10000);
    within("the number of frames", plan.frames, 2, 10000);
    within("the number of reference samples", plan.reference_samples, 1, 256);
    within("the refresh rate (Hz)", plan.refresh_hz, 1, 1000);
    within("the luminance (cd/m2)", plan.peak_cd_m2, 0.1, 100000);
    within("the age of gaze (ms)", plan.gaze_age_ms, 0, 1000);
    std::set<std::string> seen;
    for (const TradeoffMethod& method : methods_of(plan)) {
        check(method.method);
        if (!seen.insert(method.family + '\n' + method.method.name + '\n' + setting_text(method.method))
                 .second)
            throw std::runtime_error("tradeoff: '" + method.family + "' (" + setting_text(method.method) +
                                     ") is listed twice");
    }
}

std::string plan_text(const TradeoffPlan& plan) {
    Json json;
    json["scenes"] = plan.scenes;
    json["views"] = Json::array();
    for (const ViewGeometry& view : plan.views)
        json["views"].push_back({view.size.width, view.size.height, view.horizontal_fov_deg});
    json["gazes"] = plan.gazes;
    json["motions"] = plan.motions;
    json["refresh_hz"] = plan.refresh_hz;
    json["peak_cd_m2"] = plan.peak_cd_m2;
    json["rounds"] = plan.rounds;
    json["frames"] = plan.frames;
    json["taa"] = plan.taa;
    json["reference_samples"] = plan.reference_samples;
    json["gaze_age_ms"] = plan.gaze_age_ms;
    json["gaze_recording"] = plan.gaze_recording;
    json["seed"] = plan.seed;
    json["methods"] = Json::array();
    for (const TradeoffMethod& method : plan.methods) json["methods"].push_back(json_of(method));
    return json.dump();
}

TradeoffPlan plan_from_text(const std::string& text, const std::string& place) {
    try {
        const Json json = Json::parse(text);
        TradeoffPlan plan;
        plan.scenes = json.at("scenes").get<std::vector<std::string>>();
        for (const Json& view : json.at("views"))
            plan.views.push_back({{view.at(0), view.at(1)}, view.at(2)});
        plan.gazes = json.at("gazes").get<std::vector<std::string>>();
        plan.motions = json.at("motions").get<std::vector<std::string>>();
        plan.refresh_hz = json.at("refresh_hz");
        plan.peak_cd_m2 = json.at("peak_cd_m2");
        plan.rounds = json.at("rounds");
        plan.frames = json.at("frames");
        plan.taa = json.at("taa");
        plan.reference_samples = json.at("reference_samples");
        plan.gaze_age_ms = json.at("gaze_age_ms");
        plan.gaze_recording = json.at("gaze_recording");
        plan.seed = json.at("seed");
        for (const Json& method : json.at("methods")) plan.methods.push_back(method_from(method));
        return plan;
    } catch (const nlohmann::json::exception&) {
        throw std::runtime_error(place +
                                 ": the plan cannot be read; the file is damaged or of another version");
    }
}

Shard parse_shard(const std::string& text) {
    Shard shard;
    const std::size_t slash = text.find('/');
    const auto whole = [](std::string_view part, int& value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size();
    };
    if (slash == std::string::npos || !whole(std::string_view(text).substr(0, slash), shard.index) ||
        !whole(std::string_view(text).substr(slash + 1), shard.count) || shard.index < 1 ||
        shard.index > shard.count)
        throw std::runtime_error("a shard is written I/N with I from 1 to N such as 2/8, found '" + text +
                                 "'");
    return shard;
}

std::string shard_text(const Shard& shard) {
    return std::to_string(shard.index) + "/" + std::to_string(shard.count);
}

std::vector<TradeoffMethod> tradeoff_methods_of(const std::vector<std::string>& families) {
    const std::vector<TradeoffMethod> all = standard_tradeoff_methods();
    std::vector<TradeoffMethod> chosen;
    for (const std::string& wanted : families) {
        if (wanted == "full" || wanted == "full_resolution") continue;
        const std::size_t before = chosen.size();
        std::ranges::copy_if(all, std::back_inserter(chosen), [&](const TradeoffMethod& method) {
            return lower_key(method.family) == wanted;
        });
        if (chosen.size() > before) continue;
        std::string names = "full";
        std::set<std::string> listed;
        for (const TradeoffMethod& method : all)
            if (listed.insert(method.family).second) names += ", " + lower_key(method.family);
        throw std::runtime_error("tradeoff: no method '" + wanted + "'; there are: " + names);
    }
    return chosen;
}

TradeoffMethod parse_tradeoff_method(const std::string& text) {
    std::istringstream words(text);
    TradeoffMethod method{"", {"", {}, {}}};
    words >> method.method.name;
    for (std::string word; words >> word;) add_setting("--setting", word, method.method);
    check(method.method);
    const std::vector<TradeoffMethod> all = standard_tradeoff_methods();
    auto known = std::ranges::find(all, method.method, &TradeoffMethod::method);
    if (known == all.end())
        known = std::ranges::find_if(
            all, [&](const TradeoffMethod& one) { return one.method.name == method.method.name; });
    method.family = known == all.end() ? method.method.name : known->family;
    return method;
}

}  // namespace parafovea
