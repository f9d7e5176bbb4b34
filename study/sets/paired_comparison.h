// One quantity of two sets of runs of the same cases, held against each other case by case.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/interval.h"

namespace gauntlet {

// Means over the runs of a case with A and with B.
using PairedValue = std::array<double, 2>;

// Finite; shares of runs are in [0, 1].
struct PairedValues {
  std::vector<PairedValue> cases;
  std::vector<std::size_t> units;        // [case]: those of one evolution's population share a number
  bool yes_no = false;                   // the values are shares of runs
  bool single = false;                   // each is of one run
  std::array<double, 2> runs_each = {};  // mean number of runs of a case

  void Add(const PairedValue& value, std::size_t unit) {
    cases.push_back(value);
    units.push_back(unit);
  }
};

struct PairedComparison {
  std::size_t cases = 0;
  std::size_t units = 0;
  bool relatives = false;  // the units are evolutions, else the cases
  PairedValue means = {};
  std::array<std::optional<analysis::Interval>, 2> intervals = {};  // of shares, where cases are the units
  double difference = 0.0;                                          // mean of A less B
  std::optional<analysis::Interval> interval = {};                  // of it, 95 %
  std::optional<double> p = {};  // two-sided; none of fewer than SignFlips::kFewest evolutions
  std::string method = {};       // of p, or why there is none
  std::size_t larger = 0;        // cases in which A's value is the larger one
  std::size_t smaller = 0;
  // Signed ranks that speak for A less those that speak for B, as a share of all: -1 to 1 (Kerby 2014).
  double effect = 0.0;
};

// At least one case. The unit of inference is the case, or the evolution where one has several cases. Of
// yes/no values: McNemar where each stands for one run, else exchanged signs; interval by Bonett and Price.
// Of others: Wilcoxon, and Student's t. Of evolutions: exchanged signs of their mean differences and the
// interval of that test; of fewer than six no p, and Student's t.
PairedComparison ComparePairs(const PairedValues& values);

// The difference: "-10.5 points (-16.1 to -4.9)" of shares, "0.051 (0.020 to 0.083)" of others.
std::string DifferenceInWords(const PairedComparison& comparison, bool yes_no);

}  // namespace gauntlet
