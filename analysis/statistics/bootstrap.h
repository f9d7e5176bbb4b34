// Intervals for Vargha and Delaney's A when the values of one set are relatives.
#pragma once

#include <cstdint>
#include <vector>

namespace gauntlet::analysis {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// Percentile bootstrap interval of A = P(first > second) at `confidence` (e.g. 0.90: its low end is the
// one-sided 95 % lower bound). Both sets are given as clusters (e.g. the final population of one evolution is
// one cluster; independent values are clusters of one): whole clusters are drawn with replacement, so that
// the similarity of relatives is not mistaken for evidence (Davison and Hinkley 1997, 3.8). Deterministic in
// `seed`.
Interval ClusterBootstrapA(const std::vector<std::vector<double>>& first,
                           const std::vector<std::vector<double>>& second, double confidence, int resamples,
                           std::uint64_t seed);

}  // namespace gauntlet::analysis
