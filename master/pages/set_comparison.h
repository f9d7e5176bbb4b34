// Sets of runs held against each other, as many as a report is given.
#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/comparison.h"
#include "base/result.h"
#include "master/report/run_set.h"

namespace gauntlet::master {

struct ComparedPair {
  std::size_t first = 0;  // of SetComparison::sets
  std::size_t second = 0;
  analysis::Comparison comparison;
  double p_adjusted = 0.0;  // two-sided, by Holm over all pairs
  std::string words;
  std::vector<std::string> differences;  // why they are not like for like; empty = they are
};

// Sets of one scenario.
struct SetComparison {
  std::string scenario;
  std::vector<RunSet> sets;         // at least two
  std::vector<ComparedPair> pairs;  // each two of up to four sets; of more, each with the first
  std::string box_plots;            // SVG
};

struct SetComparisons {
  std::vector<SetComparison> comparisons;
  std::vector<std::string> notes;  // why something is not compared, or what a reader has to know
};

// By their fitness; `names` as `compare` takes them. Sets of scenarios that no other set has, and sets
// without a value, are not compared, which is noted. Errors: those of ReadRunSet.
Result<SetComparisons> CompareSets(const std::vector<std::string>& names);

}  // namespace gauntlet::master
