// What a fit is held against: statistics of runs as somebody has measured them, bounds, and what every run
// has to keep to.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/generic/formula.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// Of a run in which there was nothing to measure.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Runs of one kind that a setting is judged by.
struct FitCases {
  enum class Kind {
    kEmpty,   // the arena without obstacles
    kRandom,  // random test cases, fresh ones for each setting
    kGiven,   // those first to last of the cases that were handed in, from 1
  };
  Kind kind = Kind::kRandom;
  std::size_t first = 0;
  std::size_t last = 0;
  int count = 0;  // random cases for each setting; 0 = as many as the budget allows

  std::size_t given() const { return kind == Kind::kGiven ? last - first + 1 : 0; }
  // "random", "random:200", "empty", "given:1-12".
  std::string ToText() const;
  bool operator==(const FitCases&) const = default;
};
Result<FitCases> ParseFitCases(const std::string& text);

struct FitTarget {
  enum class Statistic { kMean, kSd, kQuantile, kShare, kDistribution, kEvery };
  enum class Demand { kEquals, kAtMost, kAtLeast, kEvery };

  FitCases cases;
  std::string metric;   // "fitness", "total_failure" or one of the scenario's; "" = formula
  std::string formula;  // of metrics, 1 or 0: kShare and kEvery
  Statistic statistic = Statistic::kMean;
  double quantile = 0.5;
  Demand demand = Demand::kEquals;
  // One number; of kDistribution the means of kBlocks equal parts of the sorted measured values.
  std::vector<double> values;
  double n = 0;  // runs that `values` come from; of kEvery those that all have to keep to it; 0 = exact
  double spread = 0.0;  // of kDistribution: the standard deviation of the measured values

  // As files of targets have it: "median", "quantile:0.9", "share:birds_left == 0"; besides "distribution",
  // and "every:birds_left == 10" of what every run has to keep to.
  std::string StatisticText() const;
  // "mean of fitness, random": without the value.
  std::string Title() const;
  // "at most 0.05", "0.654 (n = 100)".
  std::string Wanted() const;
  std::string ToText() const;
};

// Parts of a distribution that are compared: their mean absolute difference is the Wasserstein-1 distance of
// the two step functions (Vallender 1973), and their differences, with signs, are what a fit can move.
inline constexpr std::size_t kBlocks = 6;
// Means of kBlocks equal parts of the sorted values, of which there is at least one; parts may share a value.
// Each value stands at the quantile that it has on average (Blom 1958), so that 20 simulated runs and 100
// measured ones can be compared. Their mean is that of the values.
std::vector<double> BlockMeans(std::vector<double> values);

// Targets of a resolved experiment (fit.targets): FitTarget::ToText with "; " in between. Error: not of this
// form; a metric or a name in a formula that the scenario does not report; numbers that no run can give.
Result<std::vector<FitTarget>> ParseFitTargets(const std::string& text,
                                               const controllers::ScenarioInfo& scenario);

// Reads values of targets out of runs. Not for sharing between threads.
class TargetReader {
 public:
  // `targets` as ParseFitTargets gives them.
  TargetReader(std::span<const FitTarget> targets, const controllers::ScenarioInfo& scenario);
  // A number for each target; NaN where there was nothing to measure. The run is completed.
  std::vector<double> Read(const RunOutcome& run);

 private:
  struct Source {
    std::string metric;
    const controllers::MetricInfo* info = nullptr;
    std::vector<controllers::generic::Formula> formula;  // one or none
  };
  std::vector<std::string> names_;  // that formulas may use
  std::vector<Source> sources_;
};

// The statistic of values, as many numbers as FitTarget::values. NaN ones are left out; nothing when fewer
// than two are left.
std::vector<double> StatisticOf(const FitTarget& target, std::vector<double> values);

}  // namespace gauntlet
