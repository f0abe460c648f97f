// Predicted answers: tables whose contents can be read off, and simulated studies with a known answer.
#include "app/condition_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace parafovea {
namespace {

Protocol two_scene_protocol() {
    Protocol protocol = load_protocol(PARAFOVEA_SOURCE_DIR "/protocols/demo.toml");
    protocol.scenes = {"one", "two"};
    protocol.design.sessions = 2;
    return protocol;
}

// Every alpha at one sigma, in both scenes, with a JOD for each alpha that all people share.
std::vector<ConditionPrediction> at_sigma(double sigma, const std::vector<double>& jod, double p_identical) {
    std::vector<ConditionPrediction> predictions;
    for (const char* scene : {"one", "two"})
        for (std::size_t a = 0; a < jod.size(); ++a)
            predictions.push_back({scene,
                                   {"kfr", {{"sigma", sigma}, {"alpha", static_cast<double>(a + 1)}}, {}},
                                   jod[a],
                                   p_identical,
                                   {{-0.5, jod[a]}, {0, jod[a]}, {0.5, jod[a]}}});
    return predictions;
}

TEST(ConditionPrediction, AlphaIsFoundWhereItMattersAndHardlyEverWhereItDoesNot) {
    const Protocol protocol = two_scene_protocol();
    const auto share = [&](const std::vector<double>& jod) {
        return share_of_studies_with_alpha_effect(at_sigma(1.8, jod, 0.8), protocol, 18, 200, 3);
    };
    // Chi-square's p keeps its level only roughly at these counts: 0.05 and four standard errors.
    EXPECT_LT(share({9, 9, 9, 9}), 0.05 + 4 * 0.0155);
    EXPECT_GT(share({6, 7.5, 9, 9.5}), 0.95);
    EXPECT_LT(share({8.9, 9, 9, 9.1}), share({8, 8.5, 9, 9.5}));
}

TEST(ConditionPrediction, TheTableNamesTheThresholdAndTheDifference) {
    std::vector<ConditionPrediction> predictions;
    for (const auto& [sigma, p] : {std::pair(1.6, 0.9), std::pair(1.8, 0.85), std::pair(2.0, 0.75)})
        for (const ConditionPrediction& one : at_sigma(sigma, {9, 9}, p)) predictions.push_back(one);
    predictions.front().p_identical = 0.7;
    const std::string text = predictions_markdown(predictions, two_scene_protocol(), 6, "a test");
    EXPECT_NE(text.find("| 1.6 | 80.0 % | 90.0 % | 10.0 |"), std::string::npos) << text;
    EXPECT_NE(text.find("At alpha 2 the share falls below 80 % at sigma 1.90."), std::string::npos) << text;
    EXPECT_NE(text.find("## two"), std::string::npos);
    EXPECT_TRUE(
        predictions_csv(predictions).starts_with("scene,sigma,alpha,jod,p_identical\none,1.6,1,9.0000,"));
}

TEST(ConditionPrediction, MoreReductionIsPredictedToBeSeenMore) {
    Protocol protocol = load_protocol(PARAFOVEA_SOURCE_DIR "/protocols/demo.toml");
    protocol.scenes = {"primitives"};
    protocol.display.view.size = {160, 180};
    std::erase_if(protocol.conditions, [](const MethodSetting& condition) {
        return condition.numbers.at("alpha") != 4 ||
               (condition.numbers.at("sigma") > 1.3 && condition.numbers.at("sigma") < 2.3);
    });
    ASSERT_EQ(protocol.conditions.size(), 2u);
    PictureSource pictures(protocol.display.view);
    int done = 0;
    const auto predictions =
        predict_conditions(protocol, pictures, [&](int now, const std::string&) { done = now; });
    EXPECT_EQ(done, 2);
    ASSERT_EQ(predictions.size(), 2u);
    EXPECT_GT(predictions[0].p_identical, predictions[1].p_identical);
    EXPECT_GT(predictions[0].jod, predictions[1].jod);
    // Keener people see more.
    EXPECT_GT(predictions[1].jod_by_log10_sensitivity.front().second,
              predictions[1].jod_by_log10_sensitivity.back().second);
}

}  // namespace
}  // namespace parafovea
