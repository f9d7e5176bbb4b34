// Adaptive multilevel splitting (Cerou and Guyader 2007; Au and Beck 2001 call it subset simulation): how
// probable it is that a score falls to failure, where plain samples hardly ever see one. A score is what a
// run of a sample gave; the lower, the nearer to failing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/random/random_stream.h"

namespace gauntlet {

inline constexpr std::uint64_t kFreshSample = 0;

// A sample to be run: one that was drawn, or one near another.
struct SplittingRun {
  std::size_t particle = 0;
  std::uint64_t near = kFreshSample;  // the number of the sample that it is near
};

// One estimate, whose expectation is the probability whatever the levels are: they are the scores themselves
// (Brehier et al. 2016), and all particles that share the level are given up together, so that ties do no
// harm. Pure: the same runs for the same outcomes.
class Splitting {
 public:
  // A stage gives up a tenth of the particles, the farthest from failing; each goes on from one that stays,
  // by so many steps, of which those are taken that stay below the level.
  static constexpr std::size_t kGivenUp = 10;
  static constexpr int kSteps = 3;

  // `particles`: 10 at least. `random`: chooses who goes on from whom.
  Splitting(std::size_t particles, sim::RandomStream random);

  // The next, once all of the last are told; empty at the end.
  std::vector<SplittingRun> Next();
  // Of what Next gave, in its order. `sample`: the number it has from now on. `score`: no NaN; that of
  // a run that failed is not looked at.
  void Tell(const SplittingRun& run, std::uint64_t sample, double score, bool failed);

  bool AtEnd() const { return estimate_.has_value(); }
  // Nothing before the end.
  std::optional<double> estimate() const { return estimate_; }
  // The probability to come as far as the last level: that of failing is at most as large.
  double reached() const { return reached_; }
  // The samples that stand for failing, those of which there are copies several times. At the end.
  std::vector<std::uint64_t> Failing() const;

 private:
  struct Particle {
    std::uint64_t sample = kFreshSample;
    double score = 0.0;  // -infinity: it failed
  };

  void BeginStage();

  std::vector<Particle> particles_;
  std::vector<std::size_t> moving_;  // those that were given up
  sim::RandomStream random_;
  double level_ = 0.0;
  int steps_left_ = 0;
  bool begun_ = false;
  std::size_t told_ = 0;  // of those that Next gave
  double reached_ = 1.0;
  std::optional<double> estimate_;
};

}  // namespace gauntlet
