// The simulated headset's settings: what is read, and what is refused.
#include "tests/openxr_runtime/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace parafovea::headset {
namespace {

std::string refusal(const std::string& text) {
    try {
        parse_settings(text);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(HeadsetSettings, NothingSaidIsAFoveLikeHeadsetInRealTime) {
    const Settings settings = parse_settings("");
    EXPECT_FALSE(settings.simulated_pacing);
    EXPECT_EQ(settings.views, 2);
    EXPECT_EQ(settings.refresh_hz, 70);
    EXPECT_EQ(settings.gaze, GazeKind::fixed);
    EXPECT_TRUE(settings.plugged_in);
    EXPECT_TRUE(settings.events.empty());
}

TEST(HeadsetSettings, EntriesAreReadFromOneLineOrMany) {
    for (const char* const separator : {";", "\n", " ; ", ";;\n"}) {
        std::string text = "pacing=simulated";
        for (const char* const entry : {"views=4", "gaze=fixed:5,-3.5", "late@20:3", "session_lost@7"})
            text.append(separator).append(entry);
        const Settings settings = parse_settings(text);
        EXPECT_TRUE(settings.simulated_pacing);
        EXPECT_EQ(settings.views, 4);
        EXPECT_EQ(settings.fixed_gaze, (DirectionDeg{5, -3.5}));
        ASSERT_EQ(settings.events.size(), 2u);
        EXPECT_EQ(settings.events[0].kind, EventKind::late);
        EXPECT_EQ(settings.events[0].frame, 20);
        EXPECT_EQ(settings.events[0].count, 3);
        EXPECT_EQ(settings.events[1].kind, EventKind::session_lost);
        EXPECT_EQ(settings.events[1].count, 1);
    }
}

TEST(HeadsetSettings, APathMayHoldAnyCharacterButTheSeparators) {
    const Settings settings = parse_settings("gaze=/data/a@b:c d,e.csv;log=x=y.csv");
    EXPECT_EQ(settings.gaze, GazeKind::recording);
    EXPECT_EQ(settings.recording, "/data/a@b:c d,e.csv");
    EXPECT_EQ(settings.log, "x=y.csv");
}

TEST(HeadsetSettings, EveryMistakeIsNamed) {
    EXPECT_THAT(refusal("views=3"), testing::HasSubstr("'views=3': expected views=1, views=2 or views=4"));
    EXPECT_THAT(refusal("refresh_hz=0"), testing::HasSubstr("a rate in 1..1000"));
    EXPECT_THAT(refusal("refresh_hz=nan"), testing::HasSubstr("a rate in 1..1000"));
    EXPECT_THAT(refusal("refresh_hz=70x"), testing::HasSubstr("expected a number"));
    EXPECT_THAT(refusal("gaze=fixed:5"), testing::HasSubstr("gaze=fixed:AZIMUTH,ELEVATION"));
    EXPECT_THAT(refusal("colour=red"), testing::HasSubstr("a known setting"));
    EXPECT_THAT(refusal("explodes@5"), testing::HasSubstr("a known event"));
    EXPECT_THAT(refusal("late@"), testing::HasSubstr("expected a number"));
    EXPECT_THAT(refusal("late@5:0"), testing::HasSubstr("a count of at least 1"));
    EXPECT_THAT(refusal("late"), testing::HasSubstr("NAME=VALUE or KIND@FRAME"));
}

}  // namespace
}  // namespace parafovea::headset
