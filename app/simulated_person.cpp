// How a simulated person behaves from frame to frame.
#include "app/simulated_person.h"

#include <algorithm>
#include <chrono>

#include "devices/random.h"

namespace parafovea {

namespace {

std::uint64_t seed_of_trial(std::uint64_t seed, int number, int attempt) {
    return Random::stream(seed, "trial " + std::to_string(number) + " attempt " + std::to_string(attempt))
        .next();
}

}  // namespace

// One tracker for the whole session, though each trial begins with the eye at rest and noise of its own.
class SimulatedPerson::Tracker final : public GazeSource {
  public:
    Tracker(Clock& clock, std::uint64_t seed) : clock_(clock), start_(clock.now()) {
        settings_.person_seed = Random::stream(seed, "eye").next();
        settings_.fit_seed = Random::stream(seed, "fit of the headset").next();
        begin(Random::stream(seed, "before the first trial").next());
    }

    void begin(std::uint64_t seed) {
        settings_.seed = seed;
        // The tracker's own clock and counter run on.
        settings_.clock_epoch = SimulatedGazeSettings().clock_epoch + (clock_.now() - start_);
        first_sequence_ = next_sequence_;
        gaze_.emplace(clock_, settings_);
    }

    void drain(std::vector<GazeSample>& samples) override {
        const std::size_t known = samples.size();
        gaze_->drain(samples);
        for (std::size_t i = known; i < samples.size(); ++i) {
            samples[i].sequence += first_sequence_;
            next_sequence_ = samples[i].sequence + 1;
        }
    }

    std::string description() const override { return gaze_->description(); }
    SimulatedGaze& gaze() { return *gaze_; }

  private:
    Clock& clock_;
    HostTime start_;
    SimulatedGazeSettings settings_;
    std::optional<SimulatedGaze> gaze_;
    std::int64_t first_sequence_ = 0, next_sequence_ = 0;
};

SimulatedPerson::SimulatedPerson(const Protocol& protocol, Clock& clock, PicturePairJudge& judge,
                                 const SimulatedPersonSettings& settings)
    : protocol_(protocol),
      clock_(clock),
      judge_(judge),
      settings_(settings),
      tracker_(std::make_unique<Tracker>(clock, settings.seed)),
      controller_(clock),
      looks_towards_(centre_of(protocol.display.view.size)) {
    Random random = Random::stream(settings.seed, "traits");
    traits_ = draw_observer_traits(random);
}

SimulatedPerson::~SimulatedPerson() = default;

GazeSource& SimulatedPerson::tracker() {
    return *tracker_;
}

SimulatedGaze& SimulatedPerson::eyes() {
    return tracker_->gaze();
}

void SimulatedPerson::begin_trial(int number, int attempt) {
    trial_seed_ = seed_of_trial(settings_.seed, number, attempt);
    tracker_->begin(Random::stream(trial_seed_, "tracker").next());
    looks_towards_ = centre_of(protocol_.display.view.size);
    decision_ = {};
    intervals_seen_ = 0;
}

void SimulatedPerson::look_towards(PointPx point) {
    if (point == looks_towards_) return;
    looks_towards_ = point;
    eyes().fixate(protocol_.display.view.direction_from_point(point));
}

bool SimulatedPerson::looks_at(const Picture& picture, HostTime display_time) {
    const bool begins = picture.kind != last_kind_ || picture.text != last_text_;
    last_kind_ = picture.kind;
    last_text_ = picture.text;
    if (begins) began_ = display_time;
    look_towards(picture.kind == PictureKind::target ? picture.fovea
                                                     : centre_of(protocol_.display.view.size));

    switch (picture.kind) {
        case PictureKind::stimulus:
            if (begins) looked_ = false;
            if (looked_ || display_time - began_ < kLookAfter) return false;
            looked_ = true;
            return true;
        case PictureKind::question:
            press_when_decided(display_time);
            return false;
        case PictureKind::text:
            if (begins || display_time >= next_press_) {
                next_press_ = display_time + kReadingTime;
                controller_.press(protocol_.keys.proceed, next_press_ - Duration::from_ms(500));
            }
            return false;
        case PictureKind::fixation:
        case PictureKind::black:
        case PictureKind::target:
            return false;
    }
    return false;
}

void SimulatedPerson::sees(const RenderedPicture& picture, HostTime display_time) {
    Look& look = looks_[intervals_seen_ == 0 ? 0 : 1];
    look.picture = picture;
    look.gaze.reset();
    // A frame may be announced a little before it is seen.
    const HostTime time = std::min(display_time, clock_.now());
    if (!eyes().eye_closed(time))
        look.gaze = protocol_.display.view.point_from_direction(eyes().true_direction(time));
    if (++intervals_seen_ == 2) think();
}

void SimulatedPerson::think() {
    const auto policy = settings_.thinks_in_background ? std::launch::async : std::launch::deferred;
    decision_ = std::async(policy, [this, seed = trial_seed_, first = looks_[0], second = looks_[1]] {
        SimulatedParticipant participant(traits_, Random::stream(seed, "answer"), judge_);
        return participant.answer(first.seen(), second.seen());
    });
}

void SimulatedPerson::press_when_decided(HostTime display_time) {
    if (!decision_.valid()) return;
    if (settings_.thinks_in_background &&
        decision_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return;
    const SameDifferentAnswer decided = decision_.get();
    controller_.press(decided.identical ? protocol_.keys.same : protocol_.keys.different,
                      std::max(began_ + decided.response_time, display_time));
}

}  // namespace parafovea
