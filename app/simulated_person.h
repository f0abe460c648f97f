// A simulated participant in front of a stage: eyes, the tracker that watches them, judgement and hand.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/headless_stage.h"
#include "app/simulated_participant.h"
#include "devices/simulated/simulated_controller.h"
#include "devices/simulated/simulated_gaze.h"

namespace parafovea {

struct SimulatedPersonSettings {
    std::uint64_t seed = 1;
    // In real time frames go on while the person thinks; otherwise they wait, so that a session repeats.
    bool thinks_in_background = false;
};

// Looks at each interval once, presses the answer's button after the question appears, follows calibration
// targets, and leaves pages of text after a while. What it does in a trial depends on its seed and on which
// showing of which trial it is, not on what came before, so that a session that was broken off and resumed
// ends like one that was not.
class SimulatedPerson final : public Audience {
  public:
    // How long into an interval the one look lies that the judgement rests on: after the first fixation on a
    // new picture, whose length is 0.2 to 0.4 s in scene viewing (Henderson 2003).
    static constexpr Duration kLookAfter{500'000'000};
    static constexpr Duration kReadingTime{2'000'000'000};

    // Borrows all but the settings for its lifetime.
    SimulatedPerson(const Protocol& protocol, Clock& clock, PicturePairJudge& judge,
                    const SimulatedPersonSettings& settings);
    ~SimulatedPerson() override;

    // The tracker that watches this person's eyes, and the controller in this person's hand.
    GazeSource& tracker();
    ControllerSource& hand() { return controller_; }

    // To be called before each showing of a trial.
    void begin_trial(int number, int attempt);

    bool looks_at(const Picture& picture, HostTime display_time) override;
    void sees(const RenderedPicture& picture, HostTime display_time) override;

  private:
    class Tracker;
    struct Look {
        RenderedPicture picture;
        std::optional<PointPx> gaze;

        SeenPicture seen() const { return {{picture.rgba, picture.size, picture.hash}, gaze}; }
    };

    SimulatedGaze& eyes();
    void look_towards(PointPx point);
    void think();
    void press_when_decided(HostTime display_time);

    const Protocol& protocol_;
    Clock& clock_;
    PicturePairJudge& judge_;
    SimulatedPersonSettings settings_;
    ObserverTraits traits_;
    std::unique_ptr<Tracker> tracker_;
    SimulatedController controller_;
    std::uint64_t trial_seed_ = 0;
    PictureKind last_kind_ = PictureKind::black;
    std::string last_text_;
    PointPx looks_towards_;
    HostTime began_, next_press_;
    bool looked_ = false;
    int intervals_seen_ = 0;
    std::array<Look, 2> looks_;
    std::future<SameDifferentAnswer> decision_;
};

}  // namespace parafovea
