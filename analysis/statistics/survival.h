// Times until something happens, some of which were cut off before it did: a run that never converged lasted
// "longer than the run", which is neither the run's length nor nothing.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/interval.h"

namespace gauntlet::analysis {

struct Duration {
  double time = 0.0;     // >= 0, finite
  bool happened = true;  // false: had not happened by then
};

// From `time` on, until the next step.
struct SurvivalStep {
  double time = 0.0;
  std::size_t at_risk = 0;   // not yet happened nor cut off just before
  std::size_t happened = 0;  // at this time; at least one
  double survival = 1.0;     // share to which it has not happened yet
  Interval interval;         // of it; at survival 0 that of the step before, from 0
};

struct SurvivalCurve {
  std::vector<SurvivalStep> steps;
  // When it has happened to half of them; none where the curve, or an end of its interval, stays above one
  // half.
  std::optional<double> median;
  std::optional<double> median_low;
  std::optional<double> median_high;
};

// Kaplan and Meier 1958; intervals by Greenwood's formula on the logarithm, the median's where they reach one
// half (Brookmeyer and Crowley 1982): R's survfit. At least one duration, confidence in (0, 1).
SurvivalCurve KaplanMeier(std::span<const Duration> durations, double confidence);

}  // namespace gauntlet::analysis
