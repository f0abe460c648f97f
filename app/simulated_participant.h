// A simulated person in a same/different trial: looks at the two pictures of this trial, and answers.
//
// It sees two pictures and where its eyes were, nothing else: not how a picture was made, nor which is the
// reference. Its constants come from the literature and were fixed before any picture was judged; none is
// fitted to a result.
//
//   Visibility.  The foveated visible difference of the two pictures at the gaze of each interval
//       (analysis/visible_difference.h), contrast relative to the mean of both. The smaller of the two
//       counts: a detail must be resolved in both intervals to be compared.
//   Evidence.  10 - JOD, in units d' = sqrt(2) z(0.75) = 0.954 for each JOD, because one JOD is by definition
//   a 75 %
//       preference in a two-alternative choice (Mantiuk et al. 2021), and such a choice reaches Phi(d' /
//       sqrt(2)) (Green and Swets 1966). No further loss is assumed for holding the first picture in memory.
//   Decision.  Differencing rule (Macmillan and Creelman 2005, chapter 9): each interval is perceived with
//   unit
//       normal noise, and "different" is said when the two percepts are further apart than a criterion k:
//           P(different) = Phi((d' - k) / sqrt(2)) + Phi((-d' - k) / sqrt(2))
//       The average person's k says "different" to 5 % of identical pairs, the usual false-alarm rate of
//       careful observers who are told that many pairs are identical. People differ in k with SD 0.3, the
//       order of the SD of the criterion c between people in yes/no tasks; this figure is a judgement, no
//       measurement of this task.
//   Lapses.  A share of trials, uniform between people on 1 to 2 % (Wichmann and Hill 2001 constrain it to at
//   most
//       about 6 % and find a few percent), is answered by tossing a coin.
//   Keenness.  Contrast sensitivity differs between people with normal vision with an SD of 0.15 log10 units,
//   the
//       order of letter-chart norms (Pelli-Robson: Mantyjarvi and Laitinen 2001), and enters the visible
//       difference itself.
//   Response time.  Ex-Gaussian (Luce 1986): normal of mean 0.45 s and SD 0.08 s plus exponential of mean
//   0.25 s,
//       the order of published two-choice times (Heathcote, Popiel and Mewhort 1991), all times a personal
//       factor with SD 0.2 in its logarithm. The exponential part doubles where the evidence is at the
//       criterion. Nothing else depends on response times.
#pragma once

#include <functional>
#include <optional>

#include "app/picture_pair_judge.h"
#include "devices/random.h"
#include "devices/time.h"

namespace parafovea {

// What one person is like.
struct ObserverTraits {
    double sensitivity = 1;  // contrast sensitivity relative to the average person's
    double criterion =
        2.7718;  // k, in SDs of one percept; this one says "different" to 5 % of identical pairs
    double lapse_rate = 0.015;
    double normal_response_s = 0.45;
    double normal_response_sd_s = 0.08;
    double exponential_response_s = 0.25;
};

// Draws a person from the population described above.
ObserverTraits draw_observer_traits(Random& random);

// d' of a JOD of at most 10.
double sensitivity_index(double jod);

// The share of trials in which this person says "different" to pictures of this JOD.
double probability_of_different(double jod, const ObserverTraits& traits);

// What was seen in one interval.
struct SeenPicture {
    PictureOnDisplay picture;
    std::optional<PointPx> gaze;  // where the eyes were for most of it; absent if they were shut
};

struct SameDifferentAnswer {
    bool identical = false;
    Duration response_time;  // from the question
    double jod = 10;         // what the person based it on; 10 if an interval was not seen
};

class SimulatedParticipant {
  public:
    // Borrows the judge for its lifetime; owns its random stream.
    SimulatedParticipant(const ObserverTraits& traits, Random random, PicturePairJudge& judge);

    SameDifferentAnswer answer(const SeenPicture& first, const SeenPicture& second);

    const ObserverTraits& traits() const { return traits_; }

  private:
    ObserverTraits traits_;
    Random random_;
    PicturePairJudge& judge_;
};

// The share of the population above that calls a pair identical at a gaze: the mean of 1 -
// probability_of_different over people, by quadrature (absolute error below 0.002).
double expected_share_identical(const PictureOnDisplay& a, const PictureOnDisplay& b, PointPx gaze,
                                PicturePairJudge& judge);

// The same for whatever can be judged: `jod_at` is told a contrast sensitivity relative to the average
// person's.
double expected_share_identical(const std::function<double(double)>& jod_at);

}  // namespace parafovea
