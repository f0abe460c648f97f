// Predicts a study.
#include "app/condition_prediction.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>

#include "analysis/cochran_q.h"
#include "analysis/csv_text.h"
#include "analysis/number_text.h"
#include "analysis/parallel.h"
#include "app/simulated_participant.h"

namespace parafovea {
namespace {

constexpr int kStudies = 400;
constexpr double kLevel = 0.05;

double number_of(const MethodSetting& condition, const char* name) {
    const auto found = condition.numbers.find(name);
    if (found == condition.numbers.end())
        throw std::runtime_error("a prediction needs conditions with a sigma and an alpha, found " +
                                 to_text(condition));
    return found->second;
}

// The JOD of a person, interpolated; constant beyond the ends.
double jod_for(const ConditionPrediction& prediction, double log10_sensitivity) {
    const auto& known = prediction.jod_by_log10_sensitivity;
    if (log10_sensitivity <= known.front().first) return known.front().second;
    for (std::size_t i = 1; i < known.size(); ++i) {
        if (log10_sensitivity > known[i].first) continue;
        const double t = (log10_sensitivity - known[i - 1].first) / (known[i].first - known[i - 1].first);
        return std::lerp(known[i - 1].second, known[i].second, t);
    }
    return known.back().second;
}

// By sigma and alpha: the mean over scenes, and each scene's.
struct Cell {
    double sum = 0;
    int scenes = 0;
    double mean() const { return sum / scenes; }
};
using Table = std::map<double, std::map<double, Cell>>;

Table table_of(const std::vector<ConditionPrediction>& predictions, const std::string& scene) {
    Table table;
    for (const ConditionPrediction& one : predictions) {
        if (!scene.empty() && one.scene != scene) continue;
        Cell& cell = table[number_of(one.condition, "sigma")][number_of(one.condition, "alpha")];
        cell.sum += one.p_identical;
        ++cell.scenes;
    }
    return table;
}

// The first sigma at which the share falls through the criterion; absent where it never does.
std::optional<double> threshold_sigma(const Table& table, double alpha, double criterion) {
    std::optional<std::pair<double, double>> before;
    for (const auto& [sigma, row] : table) {
        const auto cell = row.find(alpha);
        if (cell == row.end()) continue;
        const double p = cell->second.mean();
        if (p < criterion)
            return before ? std::optional(std::lerp(before->first, sigma,
                                                    (before->second - criterion) / (before->second - p)))
                          : std::nullopt;
        before = {sigma, p};
    }
    return std::nullopt;
}

std::set<double> alphas_of(const Table& table) {
    std::set<double> alphas;
    for (const auto& [sigma, row] : table)
        for (const auto& [alpha, cell] : row) alphas.insert(alpha);
    return alphas;
}

std::string markdown_table(const Table& table, const std::map<double, double>& power) {
    const std::set<double> alphas = alphas_of(table);
    std::string text = "| sigma |", rule = "|---|";
    for (const double alpha : alphas) {
        text += " alpha " + short_text(alpha) + " |";
        rule += "---|";
    }
    text += " largest difference |";
    rule += "---|";
    if (!power.empty()) {
        text += " studies with an effect of alpha |";
        rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const auto& [sigma, row] : table) {
        text += "| " + short_text(sigma) + " |";
        double low = 1, high = 0;
        for (const double alpha : alphas) {
            const auto cell = row.find(alpha);
            text += cell == row.end() ? " – |" : " " + fixed_text(100 * cell->second.mean(), 1) + " % |";
            if (cell == row.end()) continue;
            low = std::min(low, cell->second.mean());
            high = std::max(high, cell->second.mean());
        }
        text += " " + fixed_text(100 * (high - low), 1) + " |";
        if (!power.empty()) text += " " + fixed_text(100 * power.at(sigma), 0) + " % |";
        text += "\n";
    }
    return text + "\n";
}

}  // namespace

std::vector<ConditionPrediction> predict_conditions(
    const Protocol& protocol, PictureSource& pictures,
    const std::function<void(int, const std::string&)>& progress) {
    if (protocol.procedure)
        throw std::runtime_error(protocol.file_name +
                                 ": its procedure chooses the levels; a prediction needs listed conditions");
    PicturePairJudge judge(display_model(protocol.display.view, protocol.display.peak_luminance_cd_m2),
                           std::size_t{256} << 20);
    const PointPx centre = centre_of(protocol.display.view.size);
    std::vector<ConditionPrediction> predictions;
    for (const std::string& scene : protocol.scenes)
        for (const MethodSetting& condition : protocol.conditions)
            predictions.push_back({scene, condition, 10, 1, {}});

    std::mutex mutex;
    int done = 0;
    parallel_for(predictions.size(), [&](std::size_t i) {
        ConditionPrediction& one = predictions[i];
        const RenderedPicture full = pictures.picture(one.scene, protocol.reference, centre);
        const RenderedPicture reduced = pictures.picture(one.scene, one.condition, centre);
        const PictureOnDisplay a{full.rgba, full.size, full.hash},
            b{reduced.rgba, reduced.size, reduced.hash};
        one.jod = judge.jod(a, b, centre);
        one.p_identical = expected_share_identical([&](double sensitivity) {
            const double jod = judge.jod(a, b, centre, sensitivity);
            one.jod_by_log10_sensitivity.emplace_back(std::log10(sensitivity), jod);
            return jod;
        });
        std::ranges::sort(one.jod_by_log10_sensitivity);
        const std::scoped_lock lock(mutex);
        progress(++done, one.scene + " " + to_text(one.condition));
    });
    return predictions;
}

double share_of_studies_with_alpha_effect(const std::vector<ConditionPrediction>& predictions,
                                          const Protocol& protocol, int people, int studies,
                                          std::uint64_t seed) {
    // Columns are alphas; each session's scene has one prediction for each.
    std::vector<double> alphas;
    for (const ConditionPrediction& one : predictions) {
        const double alpha = number_of(one.condition, "alpha");
        if (std::ranges::find(alphas, alpha) == alphas.end()) alphas.push_back(alpha);
    }
    const auto find = [&](const std::string& scene, double alpha) -> const ConditionPrediction& {
        const auto found = std::ranges::find_if(predictions, [&](const ConditionPrediction& one) {
            return one.scene == scene && number_of(one.condition, "alpha") == alpha;
        });
        if (found == predictions.end())
            throw std::runtime_error("a prediction of scene " + scene + " is missing");
        return *found;
    };
    std::vector<std::vector<const ConditionPrediction*>> of_session;
    for (int session = 0; session < protocol.design.sessions; ++session) {
        const std::string& scene =
            protocol.scenes[static_cast<std::size_t>(session) % protocol.scenes.size()];
        auto& row = of_session.emplace_back();
        for (const double alpha : alphas) row.push_back(&find(scene, alpha));
    }

    Random random(seed);
    CochranQOptions options;
    options.exact = false;
    int found = 0;
    for (int study = 0; study < studies; ++study) {
        BinaryTable table{alphas.size(), {}};
        for (int person = 0; person < people; ++person) {
            const ObserverTraits traits = draw_observer_traits(random);
            for (const auto& session : of_session)
                for (const ConditionPrediction* one : session) {
                    const double jod = jod_for(*one, std::log10(traits.sensitivity));
                    table.values.push_back(random.chance(probability_of_different(jod, traits)) ? 0 : 1);
                }
        }
        const CochranQ q = cochran_q(table, options);
        found += q.p_chi2 && *q.p_chi2 < kLevel ? 1 : 0;
    }
    return static_cast<double>(found) / studies;
}

std::string predictions_csv(const std::vector<ConditionPrediction>& predictions) {
    std::string csv = "scene,sigma,alpha,jod,p_identical\n";
    for (const ConditionPrediction& one : predictions)
        csv += csv_field(one.scene) + "," + short_text(number_of(one.condition, "sigma")) + "," +
               short_text(number_of(one.condition, "alpha")) + "," + fixed_text(one.jod, 4) + "," +
               fixed_text(one.p_identical, 4) + "\n";
    return csv;
}

std::string predictions_markdown(const std::vector<ConditionPrediction>& predictions,
                                 const Protocol& protocol, int people, const std::string& machine) {
    constexpr double kCriterion = 0.8;
    const Table all = table_of(predictions, "");
    std::map<double, double> power;
    for (const auto& [sigma, row] : all) {
        std::vector<ConditionPrediction> own;
        std::ranges::copy_if(predictions, std::back_inserter(own), [&, at = sigma](const auto& one) {
            return number_of(one.condition, "sigma") == at;
        });
        power[sigma] = share_of_studies_with_alpha_effect(own, protocol, people, kStudies, 1);
    }
    std::string text =
        "# Predicted answers to " + protocol.name +
        "\n\nShare of simulated people who call the condition identical to the reference, at " +
        std::to_string(protocol.display.view.size.width) + " x " +
        std::to_string(protocol.display.view.size.height) + " pixels, " +
        general_text(protocol.display.view.horizontal_fov_deg, 4) + "°, looking at the centre. Drawn by " +
        machine + ".\n\n## Mean over scenes\n\n" + markdown_table(all, power);
    text += "Last column: share of " + std::to_string(kStudies) + " simulated studies with " +
            std::to_string(people) + " people and " + std::to_string(protocol.design.sessions) +
            " sessions in which Cochran's Q finds an effect of alpha (p < " + general_text(kLevel, 2) +
            ").\n\n";
    for (const double alpha : alphas_of(all)) {
        const auto sigma = threshold_sigma(all, alpha, kCriterion);
        text += "At alpha " + short_text(alpha) + " the share falls below 80 % " +
                (sigma ? "at sigma " + fixed_text(*sigma, 2) : std::string("nowhere between two sigmas")) +
                ".\n";
    }
    text += "\n";
    if (protocol.scenes.size() > 1)
        for (const std::string& scene : protocol.scenes)
            text += "## " + scene + "\n\n" + markdown_table(table_of(predictions, scene), {});
    return text +
           "These are predictions of a model whose constants come from the literature; people may differ.\n";
}

}  // namespace parafovea
