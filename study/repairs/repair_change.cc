#include "study/repairs/repair_change.h"

#include <numeric>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/paired_tests.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/rank_test.h"

namespace gauntlet {
namespace {

constexpr std::size_t kFewestIntervalUnits = 10;

// Values whose plain mean and spread are those of `values` where each counts as many cases as its unit has
// (the linearised ratio, Cochran 1977, section 6.3), so that an interval is one of the share of all runs.
std::vector<double> Weighted(std::vector<double> values, const std::vector<std::size_t>& units) {
  const double cases = std::accumulate(units.begin(), units.end(), 0.0);
  double mean = 0.0;
  for (std::size_t i = 0; i < units.size(); ++i) mean += values[i] * static_cast<double>(units[i]) / cases;
  const auto count = static_cast<double>(units.size());
  for (std::size_t i = 0; i < units.size(); ++i)
    values[i] = mean + (values[i] - mean) * static_cast<double>(units[i]) * count / cases;
  return values;
}

}  // namespace

double FitnessA(const std::vector<double>& before, const std::vector<double>& after) {
  return before.empty() || after.empty() ? 0.5 : analysis::MannWhitney(after, before).a;
}

std::optional<RepairChange> ChangeOf(const RepairCourse& course, std::size_t first, std::size_t count,
                                     std::vector<std::size_t> units) {
  const auto repaired = course.repaired();
  if (!repaired || count == 0) return std::nullopt;
  if (units.size() < kFewestIntervalUnits) units.assign(count, 1);
  const RepairTally all_before = course.TallyOf(RepairCourse::kOriginal, first, count);
  const RepairTally all_after = course.TallyOf(*repaired, first, count);
  if (all_after.runs == 0) return std::nullopt;
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> less;
  for (std::size_t at = first; const std::size_t unit : units) {
    before.push_back(course.TallyOf(RepairCourse::kOriginal, at, unit).Share());
    after.push_back(course.TallyOf(*repaired, at, unit).Share());
    less.push_back(before.back() - after.back());
    at += unit;
  }
  const double runs = static_cast<double>(all_after.runs) / static_cast<double>(units.size());
  const auto interval = [&](const std::vector<double>& shares) {
    return analysis::MeanShareInterval(Weighted(shares, units), runs, analysis::kConfidence);
  };
  return RepairChange{
      .cases = count,
      .before = all_before.Share(),
      .after = all_after.Share(),
      .before_interval = interval(before),
      .after_interval = interval(after),
      .a = FitnessA(all_before.fitness, all_after.fitness),
      .less = all_before.Share() - all_after.Share(),
      .less_interval = analysis::MeanShareDifferenceInterval(Weighted(less, units), analysis::kConfidence)};
}

}  // namespace gauntlet
