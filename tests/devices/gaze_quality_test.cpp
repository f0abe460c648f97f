// Quality measures by hand, on a real validation recording against independently written formulas, and on
// simulated trackers of known quality.
#include "devices/gaze_quality.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "devices/gaze_recording.h"
#include "devices/simulated/simulated_gaze.h"

namespace parafovea {
namespace {

using Directions = std::vector<std::optional<DirectionDeg>>;

TEST(GazeQuality, TheWorkedExamplesOfTheReference) {
    // From the documentation of ETDQualitizer: azimuth and elevation 1, 2 against a target at 0, 0.
    const GazeQuality a = measure_gaze_quality(Directions{{{1, 1}}, {{2, 2}}}, {0, 0}, 1, 2);
    EXPECT_NEAR(a.accuracy_deg, 2.12116, 1e-5);
    // Small angles: the azimuths are averaged with the cosines of their elevations as weights.
    const double c1 = std::cos(rad_from_deg(1)), c2 = std::cos(rad_from_deg(2));
    EXPECT_NEAR(a.offset_azimuth_deg, (c1 + 2 * c2) / (c1 + c2), 1e-5);
    EXPECT_NEAR(a.offset_elevation_deg, 1.5, 1e-3);
    const GazeQuality b = measure_gaze_quality(Directions{{{1, 1}}, {{2, 2}}, {{3, 3}}}, {0, 0}, 1, 3);
    EXPECT_NEAR(b.rms_s2s_deg, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(b.sd_azimuth_deg, 0.816497, 1e-6);
    EXPECT_NEAR(b.sd_deg, 1.154701, 1e-6);
    EXPECT_NEAR(b.bcea_deg2, 0, 1e-12);  // perfectly correlated: no area
    EXPECT_EQ(b.loss_percent, 0);
}

TEST(GazeQuality, LossCountsInvalidAndAbsentSamples) {
    const GazeQuality q = measure_gaze_quality(Directions{{{1, 4}}, {}, {}}, {0, 0}, 1, 3);
    EXPECT_NEAR(q.invalid_percent, 66.6667, 1e-3);
    EXPECT_NEAR(q.loss_percent, 66.6667, 1e-3);
    EXPECT_NEAR(q.effective_hz, 1, 1e-12);
    const GazeQuality dropped = measure_gaze_quality(Directions{{{1, 4}}}, {0, 0}, 1, 4);
    EXPECT_EQ(dropped.invalid_percent, 0);
    EXPECT_NEAR(dropped.loss_percent, 75, 1e-12);
}

TEST(GazeQuality, GapsAreNotBridged) {
    const GazeQuality q =
        measure_gaze_quality(Directions{{{0, 0}}, {{1, 0}}, {}, {{50, 0}}, {{51, 0}}}, {0, 0}, 1, 5);
    EXPECT_NEAR(q.rms_s2s_deg, 1, 1e-12);
}

TEST(GazeQuality, SymmetricErrorsHaveAPerfectMean) {
    const GazeQuality q = measure_gaze_quality(Directions{{{0, 0}}, {{1, 1}}, {{-1, -1}}}, {0, 0}, 1, 3);
    EXPECT_NEAR(q.accuracy_deg, 0, 1e-12);
}

TEST(GazeQuality, NothingSeenGivesNotANumberAndNoCrash) {
    for (const Directions& nothing : {Directions{}, Directions{{}, {}}}) {
        const GazeQuality q = measure_gaze_quality(nothing, {0, 0}, 1, 120);
        EXPECT_TRUE(std::isnan(q.accuracy_deg));
        EXPECT_TRUE(std::isnan(q.rms_s2s_deg));
        EXPECT_TRUE(std::isnan(q.bcea_deg2));
        EXPECT_EQ(q.loss_percent, 100);
        EXPECT_EQ(q.invalid_percent, 100);
    }
}

TEST(GazeQuality, TurningTargetAndGazeTogetherChangesNoAccuracy) {
    for (double turn = -60; turn <= 60; turn += 20) {
        Directions gaze;
        for (int i = 0; i < 10; ++i) gaze.push_back(DirectionDeg{turn + 1 + 0.1 * i, 0.3 * i});
        EXPECT_NEAR(measure_gaze_quality(gaze, {turn, 1}, 1, 10).accuracy_deg,
                    measure_gaze_quality(gaze, {turn, 1}, 1, 10).accuracy_deg, 1e-12);
        Directions straight;
        for (int i = 0; i < 10; ++i) straight.push_back(DirectionDeg{1 + 0.1 * i, 0.3 * i});
        EXPECT_NEAR(measure_gaze_quality(gaze, {turn, 1}, 1, 10).accuracy_deg,
                    measure_gaze_quality(straight, {0, 1}, 1, 10).accuracy_deg, 1e-9);
    }
}

// The formulas once more, in another shape: rotation matrices spelt out, dot products, two-pass sums in long
// double.
struct Expected {
    double accuracy, rms, sd, bcea, invalid;
};
Expected independent(const std::vector<std::array<double, 2>>& gaze, double target_azi, double target_ele) {
    const long double degree = std::acos(-1.0L) / 180;
    const auto vec = [&](long double azi, long double ele) {
        return std::array<long double, 3>{std::sin(azi * degree) * std::cos(ele * degree),
                                          std::sin(ele * degree),
                                          std::cos(azi * degree) * std::cos(ele * degree)};
    };
    std::array<long double, 3> mean{};
    std::vector<long double> a, e;
    long double steps = 0;
    int pairs = 0;
    for (std::size_t i = 0; i < gaze.size(); ++i) {
        if (std::isnan(gaze[i][0])) continue;
        a.push_back(gaze[i][0]);
        e.push_back(gaze[i][1]);
        const auto v = vec(gaze[i][0], gaze[i][1]);
        for (int k = 0; k < 3; ++k) mean[k] += v[k];
        if (i > 0 && !std::isnan(gaze[i - 1][0])) {
            steps += std::pow(gaze[i][0] - gaze[i - 1][0], 2) + std::pow(gaze[i][1] - gaze[i - 1][1], 2);
            ++pairs;
        }
    }
    const auto t = vec(target_azi, target_ele);
    const std::array<long double, 3> cross{mean[1] * t[2] - mean[2] * t[1], mean[2] * t[0] - mean[0] * t[2],
                                           mean[0] * t[1] - mean[1] * t[0]};
    const long double norm = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    const long double sine =
        std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) / norm;
    const auto moment = [](const std::vector<long double>& x, const std::vector<long double>& y) {
        long double sx = 0, sy = 0, sxy = 0;
        for (std::size_t i = 0; i < x.size(); ++i) sx += x[i], sy += y[i], sxy += x[i] * y[i];
        return sxy - sx * sy / x.size();
    };
    const long double n = a.size(), saa = moment(a, a), see = moment(e, e), sae = moment(a, e);
    const long double rho = sae / std::sqrt(saa * see);
    const long double k = -std::log(0.32L);
    return {static_cast<double>(std::asin(sine) / degree), static_cast<double>(std::sqrt(steps / pairs)),
            static_cast<double>(std::sqrt((saa + see) / n)),
            static_cast<double>(2 * k * std::acos(-1.0L) * std::sqrt(saa / (n - 1)) *
                                std::sqrt(see / (n - 1)) * std::sqrt(1 - rho * rho)),
            static_cast<double>(100 * (gaze.size() - n) / gaze.size())};
}

TEST(GazeQuality, ARealValidationAgreesWithIndependentFormulasPerTargetAndEye) {
    const auto path =
        std::filesystem::path(PARAFOVEA_SHARED_DIR) / "gaze_recordings" / "tobii_spectrum_120hz.tsv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;

    // Read the file here by other means, and turn pixels into angles on the 528.0 x 297.0 mm screen 650 mm
    // away.
    const auto azi = [](double x) { return std::atan(x * (528.0 / 1920) / 650) * 180 / std::acos(-1.0); };
    const auto ele = [](double x, double y) {
        const double x_mm = x * (528.0 / 1920), y_mm = y * (296.9997253417969 / 1080);
        return std::asin(y_mm / std::sqrt(x_mm * x_mm + y_mm * y_mm + 650.0 * 650.0)) * 180 / std::acos(-1.0);
    };
    std::map<int, std::array<std::vector<std::array<double, 2>>, 2>> per_target;
    std::map<int, std::array<double, 2>> target_at;
    std::ifstream file(path);
    std::string word;
    std::getline(file, word);
    std::array<double, 8> row;
    while (file >> word) {
        row[0] = std::stod(word);
        for (int i = 1; i < 8; ++i) {
            file >> word;
            row[i] = word == "nan" ? NAN : std::stod(word);
        }
        const int id = static_cast<int>(row[5]);
        if (id < 0) continue;
        per_target[id][0].push_back({azi(row[1]), ele(row[1], row[2])});
        per_target[id][1].push_back({azi(row[3]), ele(row[3], row[4])});
        target_at[id] = {azi(row[6]), ele(row[6], row[7])};
    }
    ASSERT_EQ(per_target.size(), 9u);

    // Ours, by the reader and the validation.
    const GazeRecording recording = read_gaze_recording(path);
    std::map<int, Directions> left, right;
    std::map<int, DirectionDeg> target;
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        if (!recording.targets[i]) continue;
        left[recording.targets[i]->id].push_back(recording.samples[i].left->direction);
        right[recording.targets[i]->id].push_back(recording.samples[i].right->direction);
        target[recording.targets[i]->id] = recording.targets[i]->direction;
    }
    for (const auto& [id, eyes] : per_target) {
        for (int eye = 0; eye < 2; ++eye) {
            const Expected expected = independent(eyes[eye], target_at[id][0], target_at[id][1]);
            const GazeQuality q = measure_gaze_quality((eye ? right : left)[id], target[id], 1, 120);
            EXPECT_NEAR(q.accuracy_deg, expected.accuracy, 1e-6) << id << eye;
            EXPECT_NEAR(q.rms_s2s_deg, expected.rms, 1e-6) << id << eye;
            EXPECT_NEAR(q.sd_deg, expected.sd, 1e-6) << id << eye;
            EXPECT_NEAR(q.bcea_deg2, expected.bcea, 1e-6) << id << eye;
            EXPECT_NEAR(q.invalid_percent, expected.invalid, 1e-6) << id << eye;
            EXPECT_NEAR(q.loss_percent, expected.invalid, 1e-6) << id << eye;  // 120 samples in 1 s
            EXPECT_LT(q.accuracy_deg, 3);
            EXPECT_GT(q.accuracy_deg, 0);
        }
    }
}

TEST(CalibrationTargets, AreDistinctWithinTheExtentAndBalanced) {
    for (const int count : {5, 9, 13}) {
        const auto targets = calibration_targets(count, 12, 8);
        ASSERT_EQ(static_cast<int>(targets.size()), count);
        EXPECT_EQ(targets[0], (DirectionDeg{0, 0}));
        std::set<std::pair<double, double>> distinct;
        double sum_a = 0, sum_e = 0;
        for (const DirectionDeg& t : targets) {
            distinct.insert({t.azimuth_deg, t.elevation_deg});
            sum_a += t.azimuth_deg;
            sum_e += t.elevation_deg;
            EXPECT_LE(std::abs(t.azimuth_deg), 12);
            EXPECT_LE(std::abs(t.elevation_deg), 8);
        }
        EXPECT_EQ(static_cast<int>(distinct.size()), count);
        EXPECT_EQ(sum_a, 0);
        EXPECT_EQ(sum_e, 0);
    }
    EXPECT_THROW(calibration_targets(7, 1, 1), std::runtime_error);
}

// A validation of 9 targets, 2 s each, with a simulated tracker.
ValidationResult validated(const SimulatedGazeSettings& settings, DirectionDeg* offset = nullptr) {
    SimulatedClock clock;
    SimulatedGaze gaze(clock, settings);
    std::vector<ShownTarget> shown;
    std::vector<GazeSample> samples;
    for (const DirectionDeg target : calibration_targets(9, 12, 8)) {
        const HostTime begin = clock.now();
        gaze.fixate(target);
        clock.wait_until(begin + Duration::from_seconds(2));
        gaze.drain(samples);
        shown.push_back({target, begin, clock.now()});
    }
    clock.wait_until(clock.now() + Duration::from_ms(100));
    gaze.drain(samples);
    if (offset) *offset = gaze.constant_offset();
    return validate_gaze(samples, shown, {.settle = Duration::from_ms(900), .rate_hz = settings.rate_hz});
}

TEST(Validation, MeasuresTheOffsetNoiseAndDropsOfAKnownTracker) {
    SimulatedGazeSettings settings;
    settings.field_sd_deg = settings.slow_drift_deg_per_10min = 0;
    settings.offset_sd_azimuth_deg = settings.offset_sd_elevation_deg = 2;
    settings.noise_sd_deg = 0.3;
    settings.noise_correlation = 0;
    settings.drop_probability = 0.1;
    settings.loss_rate_hz = 0;
    settings.eye.microsaccade_rate_hz = 0;
    settings.eye.drift_diffusion_deg2_per_s = 0;
    settings.eye.saccade_gain = 1;
    settings.eye.saccade_scatter = 0;
    settings.eye.blink_interval_mean_s = 1e6;
    DirectionDeg offset;
    const ValidationResult result = validated(settings, &offset);
    EXPECT_NEAR(result.mean_offset_azimuth_deg, offset.azimuth_deg, 0.1);
    EXPECT_NEAR(result.mean_offset_elevation_deg, offset.elevation_deg, 0.1);
    EXPECT_NEAR(result.mean_accuracy_deg, std::hypot(offset.azimuth_deg, offset.elevation_deg), 0.1);
    // The cyclopean mean of two eyes of 0.3 deg per axis: 0.212 per axis, 0.3 in two, 0.424 from sample to
    // sample.
    EXPECT_NEAR(result.median_sd_deg, 0.3, 0.03);
    EXPECT_NEAR(result.median_rms_s2s_deg, 0.424, 0.04);
    EXPECT_NEAR(result.loss_percent, 10, 3);
    EXPECT_NEAR(result.targets[0].left->sd_deg, 0.424, 0.08);
    EXPECT_EQ(result.targets_without_data, 0);
}

TEST(Validation, ATargetNobodySawIsCountedAndNoNumberIsMadeUp) {
    const std::vector<ShownTarget> shown{{{0, 0}, {0}, {2'000'000'000}}};
    const ValidationResult result = validate_gaze({}, shown);
    EXPECT_EQ(result.targets_without_data, 1);
    EXPECT_TRUE(std::isnan(result.mean_accuracy_deg));
    EXPECT_EQ(result.loss_percent, 100);
    const FoveationMargin margin = foveation_margin(result, 10);
    EXPECT_FALSE(margin.go);
    EXPECT_THAT(margin.reason, testing::HasSubstr("1 of 1 targets"));
}

TEST(FoveationMargin, GoesWhenTheSharpRadiusExceedsTheErrorByTheRequiredMargin) {
    const ValidationResult result = validated({});
    double worst = 0;
    for (const TargetQuality& t : result.targets)
        worst = std::max(worst, t.cyclopean.accuracy_deg + 2 * t.cyclopean.sd_deg);
    const MarginThresholds lenient{
        .required_margin_deg = 0.5, .greatest_mean_accuracy_deg = 5, .greatest_loss_percent = 60};
    EXPECT_TRUE(foveation_margin(result, worst + 0.51, lenient).go);
    EXPECT_FALSE(foveation_margin(result, worst + 0.49, lenient).go);
    EXPECT_NEAR(foveation_margin(result, worst + 0.49, lenient).margin_deg, 0.49, 1e-9);
    MarginThresholds strict = lenient;
    strict.greatest_mean_accuracy_deg = 0.01;
    EXPECT_THAT(foveation_margin(result, 90, strict).reason, testing::HasSubstr("mean error"));
}

}  // namespace
}  // namespace parafovea
