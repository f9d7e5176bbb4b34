// How often runs fail along a range on which failures only become more frequent, and where they cross a
// share.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace gauntlet {

// Runs at one place of the range.
struct LevelTally {
  double place = 0.0;
  int runs = 0;
  int failures = 0;
};

// Isotonic regression by pooling adjacent violators (Ayer et al. 1955): the likeliest failure probabilities
// that never fall, one for each level. Levels ascend and have runs.
std::vector<double> MonotoneFit(std::span<const LevelTally> levels);

// Where the probability crosses a share. Beyond the levels nothing is known: there the ends are infinite.
struct Crossing {
  static constexpr double kBelow = -std::numeric_limits<double>::infinity();
  static constexpr double kAbove = std::numeric_limits<double>::infinity();

  double low = kBelow;
  double high = kAbove;
  double estimate = 0.0;  // between the levels of the fit around it; infinite as the ends are
};

// `share` in (0, 1). The interval holds every place whose hypothesis "here is the crossing" a
// likelihood-ratio test does not reject at 5 %: constrained fits as in Banerjee and Wellner 2001, held
// against the chi-square quantile of one degree of freedom, which is more cautious than their limit and takes
// account of few and adaptively chosen levels. The statistic is divided by `design_effect` (DesignEffect), at
// least 1.
Crossing CrossingOf(std::span<const LevelTally> levels, double share, double design_effect);
// The likelihood of the monotone fit, as a logarithm.
double LogLikelihood(std::span<const LevelTally> levels);

// A run and what it has in common with others.
struct CaseOutcome {
  std::size_t level = 0;  // of the levels
  std::size_t of_case = 0;
  bool failed = false;
};
// By how much runs of the same case, which resemble each other, tell less than as many different ones: the
// variance of the residuals' sum over cases against that of independent runs (Kish 1965), at least 1.
double DesignEffect(std::span<const CaseOutcome> outcomes, std::span<const double> fit);

}  // namespace gauntlet
