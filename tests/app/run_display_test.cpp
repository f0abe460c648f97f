// What a session shows beside its stimuli, and on which refreshes: pages, questions, grids of refreshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/participant_pages.h"
#include "app/questionnaire_page.h"
#include "app/window_surface.h"
#include "app/window_timing.h"
#include "devices/random.h"

namespace parafovea {
namespace {

constexpr ViewGeometry kView{{1280, 1440}, 76.7};  // one eye of a FOVE 0, 14 px a degree

struct Ink {
    int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
    int height() const { return bottom - top + 1; }
};

Ink ink_of(const Image& image) {
    Ink ink;
    for (int y = 0; y < image.size.height; ++y)
        for (int x = 0; x < image.size.width; ++x) {
            if (image.rgba[4 * static_cast<std::size_t>(y * image.size.width + x)] < 100) continue;
            ink = {std::min(ink.left, x), std::min(ink.top, y), std::max(ink.right, x),
                   std::max(ink.bottom, y)};
        }
    return ink;
}

Picture page(const std::string& text) {
    Picture picture;
    picture.kind = PictureKind::text;
    picture.text = text;
    return picture;
}

TEST(ParticipantPages, ALowerCaseXIsAtLeastHalfADegreeHighInAFove) {
    const Image image = ParticipantPages(kView).draw(page("xxx"));
    EXPECT_GE(ink_of(image).height(), std::ceil(0.5 * kView.pixels_per_degree()));
}

TEST(ParticipantPages, TextStandsInTheMiddleAndLongLinesAreBroken) {
    std::string text;
    for (int i = 0; i < 60; ++i) text += "Wörter ";
    const Ink ink = ink_of(ParticipantPages(kView).draw(page(text)));
    EXPECT_LE(ink.right - ink.left, ParticipantPages::kTextWidthDeg * kView.pixels_per_degree());
    EXPECT_NEAR(ink.left + ink.right, kView.size.width, 60);
    EXPECT_NEAR(ink.top + ink.bottom, kView.size.height, 60);
}

TEST(ParticipantPages, UmlautsAreLettersOfTheirOwn) {
    const ParticipantPages pages(kView);
    EXPECT_NE(pages.draw(page("Größe")), pages.draw(page("Grosse")));
    EXPECT_NE(pages.draw(page("ä")), pages.draw(page("\xff")));
    EXPECT_EQ(pages.draw(page("\xff")), pages.draw(page("\xef\xbf\xbd")))
        << "a broken byte is drawn as U+FFFD";
}

TEST(ParticipantPages, ATargetIsDrawnWhereItIsAsked) {
    Picture target;
    target.kind = PictureKind::target;
    target.fovea = {300, 1000};
    const Ink ink = ink_of(ParticipantPages(kView).draw(target));
    EXPECT_NEAR((ink.left + ink.right + 1) / 2.0, 300, 0.6);
    EXPECT_NEAR((ink.top + ink.bottom + 1) / 2.0, 1000, 0.6);
}

TEST(Utf8, OverlongSurrogateAndCutSequencesAreReplaced) {
    EXPECT_EQ(code_points("a\u00e9\u20ac\U0001F600"), (std::vector<char32_t>{'a', 0xe9, 0x20ac, 0x1f600}));
    for (const char* broken : {"\xc0\x80", "\xed\xa0\x80", "\xe2\x82", "\xf8\x88\x80\x80\x80", "\x80"})
        for (const char32_t point : code_points(broken)) EXPECT_EQ(point, 0xFFFDu);
}

TEST(Font, AMissingFileIsOneLineThatSaysWhatToInstall) {
    try {
        Font("/nowhere/font.ttf");
        FAIL();
    } catch (const std::runtime_error& error) {
        const std::string line = error.what();
        EXPECT_NE(line.find("/nowhere/font.ttf"), std::string::npos);
        EXPECT_NE(line.find("fonts-dejavu-core"), std::string::npos);
        EXPECT_EQ(line.find('\n'), std::string::npos);
    }
}

TEST(PacedRefreshes, AFrameInTimeMissesNothingAndALateOneEveryRefreshThatWentBy) {
    const HostTime start{1'000'000'000};
    PacedRefreshes refreshes(start, 70);
    const auto at = [&](double periods) { return start + Duration::from_seconds(periods / 70); };
    EXPECT_EQ(refreshes.next(at(0.5)).time, at(1));
    EXPECT_EQ(refreshes.next(at(1.2)).missed, 0);
    EXPECT_EQ(refreshes.next(at(3.05)).time, at(3)) << "a tenth of a period late is in time";
    const Refresh late = refreshes.next(at(6.5));
    EXPECT_EQ(late.time, at(7));
    EXPECT_EQ(late.missed, 3);
}

TEST(PacedRefreshes, TheGridDoesNotDriftOverAnHour) {
    PacedRefreshes refreshes({}, 70);
    Refresh last;
    for (int i = 0; i < 70 * 3600; ++i) last = refreshes.next(last.time);
    EXPECT_EQ(last.time.ns, 3'600'000'000'000);
}

TEST(ObservedRefreshes, JitterIsAveragedDriftFollowedAndMissesCounted) {
    Random random(3);
    const double true_period_ns = 1e9 / 60.006;  // the crystal is 100 ppm off
    ObservedRefreshes refreshes({}, 60);
    double worst_ns = 0;
    int missed = 0, dropped = 0;
    std::int64_t vsync = 0;
    for (int i = 0; i < 20000; ++i) {
        const int skipped = i % 500 == 499 ? 2 : 0;
        dropped += skipped;
        vsync += 1 + skipped;
        const double truth_ns = static_cast<double>(vsync) * true_period_ns;
        const Refresh refresh =
            refreshes.next({std::llround(truth_ns + std::abs(random.normal(0, 0.05 * true_period_ns)))});
        missed += refresh.missed;
        if (i > 200) worst_ns = std::max(worst_ns, std::abs(static_cast<double>(refresh.time.ns) - truth_ns));
    }
    EXPECT_EQ(missed, dropped);
    EXPECT_LT(worst_ns, 0.15 * true_period_ns);
}

TEST(RefreshRate, AVirtualDisplayKeepsNone) {
    std::vector<HostTime> times;
    for (int i = 0; i < 61; ++i) times.push_back({i * 16'666'667});
    times[30].ns += 12'000'000;
    EXPECT_NEAR(median_rate_hz(times), 60, 0.001);
    EXPECT_TRUE(keeps_rate(59.94, 60));
    EXPECT_FALSE(keeps_rate(900, 60));
    EXPECT_FALSE(keeps_rate(60, 0));
    EXPECT_EQ(median_rate_hz({}), 0);
}

TEST(Placement, APictureThatFitsIsShownPixelByPixelAndAnotherIsReduced) {
    const Placement fits = placement_of({1280, 1440}, {2560, 1441});
    EXPECT_EQ(fits.scale, 1);
    EXPECT_EQ(fits.left_px, 640);
    EXPECT_EQ(fits.top_px, 0);
    EXPECT_DOUBLE_EQ(placement_of({1280, 1440}, {1920, 1080}).scale, 0.75);
}

// A hand that presses one button after another, one a frame.
class PressingHand final : public ControllerSource {
  public:
    explicit PressingHand(std::vector<Button> presses) : presses_(std::move(presses)) {}
    void drain(std::vector<ControllerEvent>& events) override {
        if (first_drain_) {
            first_drain_ = false;
            return;
        }
        if (next_ < presses_.size())
            events.push_back({ControllerEventKind::press, presses_[next_++], {}, {}});
        first_drain_ =
            next_ > 0 && presses_[next_ - 1] == Button::a;  // the next question drains before it begins
    }
    std::string description() const override { return "presses"; }

  private:
    std::vector<Button> presses_;
    std::size_t next_ = 0;
    bool first_drain_ = true;
};

class RememberingStage final : public Stage {
  public:
    ShownFrame show(const Picture& picture) override {
        texts.push_back(picture.text);
        return {};
    }
    double refresh_hz() const override { return 70; }
    ViewGeometry view() const override { return kView; }
    std::vector<std::string> texts;
};

TEST(QuestionnairePage, UpAndDownChooseAndProceedConfirms) {
    Questionnaire questionnaire{"participant", "About you", {}};
    Question sight{"vision", "Do you see well?", {"yes", "with glasses", "no"}};
    Question age{"age", "How old are you?", {}, 18, 99};
    questionnaire.questions = {sight, age};
    Protocol protocol;
    RememberingStage stage;
    PressingHand hand({Button::up, Button::down, Button::a, Button::right, Button::up, Button::down,
                       Button::down, Button::left, Button::up, Button::a});
    const auto answers = ask_questionnaire(questionnaire, protocol, stage, hand, {});
    ASSERT_TRUE(answers.has_value());
    EXPECT_EQ(answers->at("vision"), "1");
    EXPECT_EQ(answers->at("age"), "19") << "18 + 10 + 1 - 1 - 1, no lower than 18, + 1";
    EXPECT_NE(stage.texts.front().find("Do you see well?"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
