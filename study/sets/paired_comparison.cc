#include "study/sets/paired_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/paired_tests.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"
#include "analysis/tables/cell.h"
#include "base/check.h"

namespace gauntlet {
namespace {

using analysis::PairedTest;
using analysis::SignFlips;

constexpr double kConfidence = 0.95;

// Mean difference of each unit, in the order of their numbers.
std::vector<double> OfUnits(const PairedValues& values) {
  std::map<std::size_t, std::pair<double, std::size_t>> sums;
  for (std::size_t i = 0; i < values.cases.size(); ++i) {
    auto& [sum, count] = sums[values.units[i]];
    sum += values.cases[i][0] - values.cases[i][1];
    ++count;
  }
  std::vector<double> means;
  for (const auto& [unit, total] : sums) means.push_back(total.first / static_cast<double>(total.second));
  return means;
}

double RankBiserial(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double one : differences) sizes.push_back(std::abs(one));
  const std::vector<double> ranks = analysis::MidRanks(sizes);
  double signed_sum = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (differences[i] == 0.0) continue;
    sum += ranks[i];
    signed_sum += differences[i] > 0.0 ? ranks[i] : -ranks[i];
  }
  return sum == 0.0 ? 0.0 : signed_sum / sum;
}

void TestUnits(const std::vector<double>& differences, PairedComparison& made) {
  made.relatives = true;
  made.difference = analysis::Describe(differences).mean;
  if (differences.size() >= SignFlips::kFewest) {
    const SignFlips flips(differences);
    const PairedTest test = flips.Test();
    made.p = test.p_two_sided;
    made.method = test.method;
    made.interval = flips.IntervalOf(kConfidence);
    return;
  }
  const std::string evolutions =
      fmt::format("{} evolution{}", differences.size(), differences.size() == 1 ? "" : "s");
  made.method =
      fmt::format("no p: {} say too little, at least {} are needed", evolutions, SignFlips::kFewest);
  if (differences.size() < 2) return;
  made.interval = analysis::MeanInterval(differences, kConfidence);
  const std::size_t needed = analysis::UnitsNeeded(differences);
  if (needed > SignFlips::kFewest)
    made.method =
        fmt::format("no p: {} say too little; for such a difference about {} are needed", evolutions, needed);
}

void TestCases(const PairedValues& values, const std::vector<double>& differences, PairedComparison& made) {
  PairedTest test;
  if (!values.yes_no) {
    test = analysis::WilcoxonSignedRank(differences);
    if (differences.size() > 1) made.interval = analysis::MeanInterval(differences, kConfidence);
  } else {
    test = values.single ? analysis::McNemarExact(made.larger, made.smaller) : SignFlips(differences).Test();
    made.interval = analysis::MeanShareDifferenceInterval(differences, kConfidence);
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<double> shares;
      for (const PairedValue& one : values.cases) shares.push_back(one[side]);
      made.intervals[side] = analysis::MeanShareInterval(shares, values.runs_each[side], kConfidence);
    }
  }
  made.p = test.p_two_sided;
  made.method = test.method;
}

}  // namespace

PairedComparison ComparePairs(const PairedValues& values) {
  GAUNTLET_CHECK(!values.cases.empty() && values.units.size() == values.cases.size(),
                 "a comparison of pairs needs one, and a unit for each");
  PairedComparison made{.cases = values.cases.size()};
  std::vector<double> differences;
  for (const PairedValue& one : values.cases) {
    differences.push_back(one[0] - one[1]);
    for (std::size_t side = 0; side < 2; ++side) made.means[side] += one[side];
    made.larger += one[0] > one[1] ? 1 : 0;
    made.smaller += one[0] < one[1] ? 1 : 0;
  }
  for (double& mean : made.means) mean /= static_cast<double>(made.cases);
  made.difference = made.means[0] - made.means[1];
  made.effect = RankBiserial(differences);
  const std::vector<double> of_units = OfUnits(values);
  made.units = of_units.size();
  if (made.units < made.cases) {
    TestUnits(of_units, made);
  } else {
    TestCases(values, differences, made);
  }
  return made;
}

std::string DifferenceInWords(const PairedComparison& comparison, bool yes_no) {
  const auto number = [yes_no](double value) {
    const std::string text = yes_no ? fmt::format("{:.1f}", 100.0 * value) : FormatFitness(value);
    return text == "-0.0" ? "0.0" : text;
  };
  std::string words = number(comparison.difference) + (yes_no ? " points" : "");
  if (comparison.interval)
    words += fmt::format(" ({} to {})", number(comparison.interval->low), number(comparison.interval->high));
  return words;
}

}  // namespace gauntlet
