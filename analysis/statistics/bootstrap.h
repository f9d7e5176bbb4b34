// Intervals for Vargha and Delaney's A, of independent values and of values some of which are relatives.
// Values are finite, at least one in either set; confidence in (0, 1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/statistics/interval.h"

namespace gauntlet::analysis {

// Values that belong together, e.g. the final population of one evolution; independent values are clusters of
// one.
using Clusters = std::vector<std::vector<double>>;

// Percentile bootstrap interval of A = P(first > second), e.g. at confidence 0.90, when its low end is the
// one-sided 95 % lower bound. Whole clusters are drawn with replacement, so that the similarity of relatives
// is not mistaken for evidence (Davison and Hinkley 1997, 3.8). Deterministic in `seed`. No cluster is empty.
// A set of a single cluster does not vary: its share of the uncertainty is missing.
Interval ClusterBootstrapA(const Clusters& first, const Clusters& second, double confidence, int resamples,
                           std::uint64_t seed);

// The same of independent values.
Interval BootstrapA(std::span<const double> first, std::span<const double> second, double confidence,
                    int resamples, std::uint64_t seed);

// Normal interval of A of independent values from the variance of their placements (DeLong, DeLong and
// Clarke-Pearson 1988), cut at 0 and 1: for sets so large that drawing them again takes long, where it agrees
// with the bootstrap. At least two values in either set.
Interval LargeSampleIntervalA(std::span<const double> first, std::span<const double> second,
                              double confidence);

}  // namespace gauntlet::analysis
