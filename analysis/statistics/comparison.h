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
  // The two-sided p that words and pictures name, by the one test that is right here: Fisher's of yes/no
  // values, of others `exact` where there is one, else `test`; of relatives Welch's of the means of units,
  // none of fewer than kFewestUnits.
  std::optional<double> p;
  std::string p_by;        // its method, or why there is none
  bool relatives = false;  // some values are of one unit
  bool yes_no = false;     // the means are shares
  // Of the first mean less the second, of yes/no values (Newcombe 1998) and of relatives (Welch 1947, of the
  // means of units).
  double difference = 0.0;
  std::optional<Interval> difference_interval;
  std::string_view effect;  // EffectOf(test.a)
  // Of A at 95 %, every value on its own: by the bootstrap up to kMostResampled values, by the variance of
  // the placements beyond. None of a set of a single value.
  std::optional<Interval> interval;
  std::string interval_method;  // or why there is none
  // Of A at 95 %, whole clusters as sampling units, for claims of studies: of few it is too short, so it is
  // told nowhere else. None where every cluster is a single value, and where a set is a single cluster.
  std::optional<Interval> cluster_interval;
  std::string cluster_method;  // or why there is none
};

inline constexpr double kConfidence = 0.95;
inline constexpr std::size_t kFewestUnits = 6;
inline constexpr int kResamples = 4000;
inline constexpr std::size_t kMostResampled = 20'000;

// The same numbers for the same sets. Error: a set is empty, or holds a value that is not finite
// (CheckSample). `yes_no`: the values are 0 and 1.
Result<Comparison> Compare(const ComparedSet& first, const ComparedSet& second, bool yes_no = false);

// "p = 0.00017 (exact)", or why there is none.
std::string TestInWords(const std::optional<double>& p, std::string_view by);
// What the figures say in one sentence. `first` and `second` are what the sets are called in it.
std::string InWords(const Comparison& comparison, const std::string& first, const std::string& second);

}  // namespace gauntlet::analysis
