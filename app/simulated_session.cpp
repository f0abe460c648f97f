// Wires one simulated participant to the real session.
#include "app/simulated_session.h"

#include <array>
#include <cstdio>
#include <optional>

#include "app/headless_stage.h"
#include "app/simulated_participant.h"
#include "devices/random.h"
#include "devices/simulated/simulated_controller.h"
#include "devices/simulated/simulated_gaze.h"

namespace parafovea {

namespace {

// The participant in front of the stage: looks at each interval once, presses the answer's button after the
// question appears, and leaves pages of text after a while.
class SimulatedAudience final : public Audience {
  public:
    // How long into an interval the one look lies that the judgement rests on: after the first fixation on a
    // new picture, whose length is 0.2 to 0.4 s in scene viewing (Henderson 2003).
    static constexpr Duration kLookAfter{500'000'000};
    static constexpr Duration kReadingTime{2'000'000'000};

    SimulatedAudience(const Protocol& protocol, SimulatedParticipant& participant, SimulatedGaze& gaze,
                      SimulatedController& controller)
        : protocol_(protocol), participant_(participant), gaze_(gaze), controller_(controller) {}

    bool looks_at(const Picture& picture, HostTime display_time) override {
        const bool begins = picture.kind != last_kind_ || picture.text != last_text_;
        last_kind_ = picture.kind;
        last_text_ = picture.text;
        if (begins) began_ = display_time;

        switch (picture.kind) {
            case PictureKind::fixation:
                if (begins) intervals_seen_ = 0;
                return false;
            case PictureKind::stimulus:
                if (begins && intervals_seen_ == 2)
                    intervals_seen_ = 0;  // a trial without a fixation mark before it
                if (begins) looked_ = false;
                if (looked_ || display_time - began_ < kLookAfter) return false;
                looked_ = true;
                return true;
            case PictureKind::question:
                if (begins) answer(display_time);
                return false;
            case PictureKind::text:
                if (begins || display_time >= next_press_) {
                    next_press_ = display_time + kReadingTime;
                    controller_.press(protocol_.keys.proceed, next_press_ - Duration::from_ms(500));
                }
                return false;
            case PictureKind::black:
            case PictureKind::target:
                return false;
        }
        return false;
    }

    void sees(const RenderedPicture& picture, HostTime display_time) override {
        Look& look = looks_[intervals_seen_ == 0 ? 0 : 1];
        look.picture = picture;
        look.gaze.reset();
        if (!gaze_.eye_closed(display_time))
            look.gaze = protocol_.display.view.point_from_direction(gaze_.true_direction(display_time));
        ++intervals_seen_;
    }

  private:
    struct Look {
        RenderedPicture picture;
        std::optional<PointPx> gaze;

        SeenPicture seen() const { return {{picture.rgba, picture.size, picture.hash}, gaze}; }
    };

    void answer(HostTime question_time) {
        const SameDifferentAnswer decided = participant_.answer(looks_[0].seen(), looks_[1].seen());
        controller_.press(decided.identical ? protocol_.keys.same : protocol_.keys.different,
                          question_time + decided.response_time);
    }

    const Protocol& protocol_;
    SimulatedParticipant& participant_;
    SimulatedGaze& gaze_;
    SimulatedController& controller_;
    PictureKind last_kind_ = PictureKind::black;
    std::string last_text_;
    HostTime began_, next_press_;
    bool looked_ = false;
    int intervals_seen_ = 0;
    std::array<Look, 2> looks_;
};

}  // namespace

std::string simulated_participant_id(int participant_index) {
    char text[32];
    std::snprintf(text, sizeof text, "simulated-%02d", participant_index + 1);
    return text;
}

void run_simulated_session(const Protocol& protocol, const SimulatedSessionRequest& request,
                           PictureSource& pictures, PicturePairJudge& judge,
                           const std::function<void(const SessionProgress&)>& on_progress) {
    const std::string id = simulated_participant_id(request.participant_index);
    const std::uint64_t seed = Random::stream(request.study_seed, id).next();

    // The person: eye, tracker, hand and judgement, each with a random stream of its own.
    SimulatedClock clock;
    SimulatedGazeSettings gaze_settings;
    gaze_settings.seed = Random::stream(seed, "tracker").next();
    gaze_settings.person_seed = Random::stream(seed, "eye").next();
    SimulatedGaze gaze(clock, gaze_settings);
    SimulatedController controller(clock);
    Random traits_random = Random::stream(seed, "traits");
    SimulatedParticipant participant(draw_observer_traits(traits_random), Random::stream(seed, "answers"),
                                     judge);

    // The session.
    SimulatedAudience audience(protocol, participant, gaze, controller);
    HeadlessStage stage(protocol.display.view, protocol.display.refresh_hz, clock, pictures, audience);
    SessionFacts facts;
    facts.uuid = make_uuid();
    facts.participant = id;
    facts.program_version = PARAFOVEA_VERSION;
    facts.display = "headless, simulated clock";
    facts.gaze_source = gaze.description();
    facts.controller = controller.description();
    facts.device = pictures.device_name();
    facts.driver = pictures.driver_name();
    facts.refresh_hz = stage.refresh_hz();
    facts.simulated_people = true;
    SessionLog log = SessionLog::create(request.file, facts, protocol,
                                        make_plan(protocol, request.participant_index, seed),
                                        read_clock_anchor(clock.now()));
    SessionHooks hooks;
    hooks.on_progress = on_progress;
    run_session(log, stage, gaze, controller, clock, hooks);
}

}  // namespace parafovea
