// Sessions on the simulated headset, through Debian's OpenXR loader and both validation layers.
#include "devices/openxr/openxr_session.h"

#include <array>
#include <cmath>

#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

TEST(OpenXrSession, WalksFromStartToFocusAndOutAgain) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_until_focused(session, headset.gpu());
    for (int i = 0; i < 10; ++i) {
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        ASSERT_TRUE(frame);
        EXPECT_TRUE(frame->should_render);
        EXPECT_EQ(frame->views.size(), 2u);
    }
    session.request_exit();
    for (int i = 0; i < 10 && session.update() != SessionState::exiting; ++i)
        run_frame(session, headset.gpu());
    EXPECT_EQ(session.state(), SessionState::exiting);
    EXPECT_FALSE(session.begin_frame());
}

}  // namespace
}  // namespace parafovea
