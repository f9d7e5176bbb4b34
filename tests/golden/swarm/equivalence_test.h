// Are paired values equal for practical purposes? Two one-sided tests (Schuirmann 1987).
#pragma once

#include <span>

#include "analysis/statistics/interval.h"

namespace gauntlet::analysis {

struct EquivalenceTest {
  double mean = 0.0;        // of the differences
  double sd = 0.0;          // of the differences, n - 1
  Interval interval;        // 1 - 2 alpha for the mean: equivalent when it lies inside the margin
  double p = 1.0;           // the larger one of the two one-sided p-values
  bool equivalent = false;  // p < alpha
};

// Paired t-tests of the null hypotheses "the mean difference is at least `margin`" and "at most -margin",
// each at level `alpha` in (0, 0.5). Equal differences are taken for exact. At least two differences, margin
// > 0.
EquivalenceTest TestEquivalence(std::span<const double> differences, double margin, double alpha);

}  // namespace gauntlet::analysis
