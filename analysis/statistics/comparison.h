// Two sets of values held against each other with everything a reader asks for.
#pragma once

#include <optional>
#include <string>

#include "analysis/statistics/bootstrap.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"

namespace gauntlet::analysis {

struct ComparedSet {
  std::string name;   // for errors and words
  Clusters clusters;  // relatives belong together; independent values are clusters of one
};

struct Comparison {
  Description first;
  Description second;
  BoxPlot first_box;
  BoxPlot second_box;
  RankTest test;
  std::optional<ExactRankTest> exact;  // where it can be computed
  std::string method;                  // of `test`, and of `exact` where there is one
  // The p that words and pictures name: of `exact` where there is one, else of `test`.
  double p_two_sided = 1.0;
  std::string_view p_by;    // "exact" or "normal approximation"
  std::string_view effect;  // EffectOf(test.a)
  // Of A at 95 %, every value on its own: by the bootstrap up to kMostResampled values, by the variance of
  // the placements beyond. None of a set of a single value.
  std::optional<Interval> interval;
  std::string interval_method;  // or why there is none
  // Of A at 95 %, whole clusters as sampling units. None where every cluster is a single value, and where a
  // set is a single cluster.
  std::optional<Interval> cluster_interval;
  std::string cluster_method;  // or why there is none
};

inline constexpr double kConfidence = 0.95;
inline constexpr int kResamples = 4000;
inline constexpr std::size_t kMostResampled = 20'000;

// The same numbers for the same sets. Error: a set is empty, or holds a value that is not finite
// (CheckSample).
Result<Comparison> Compare(const ComparedSet& first, const ComparedSet& second);

// What the figures say in one sentence; with clusters, why their interval matters in another. `first` and
// `second` are what the sets are called in it.
std::string InWords(const Comparison& comparison, const std::string& first, const std::string& second);

}  // namespace gauntlet::analysis
