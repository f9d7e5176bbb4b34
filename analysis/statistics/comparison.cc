#include "analysis/statistics/comparison.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/proportions.h"

namespace gauntlet::analysis {
namespace {

constexpr std::uint64_t kSeed = 1;
// With fewer, intervals from clusters are too short (Cameron, Gelbach and Miller 2008).
constexpr std::size_t kFewUnits = 10;

std::vector<double> ValuesOf(const Clusters& clusters) {
  std::vector<double> values;
  for (const std::vector<double>& cluster : clusters) {
    values.insert(values.end(), cluster.begin(), cluster.end());
  }
  return values;
}

bool HasRelatives(const Clusters& clusters) {
  return std::ranges::any_of(clusters, [](const auto& cluster) { return cluster.size() > 1; });
}

void AddInterval(const std::vector<double>& first, const std::vector<double>& second,
                 Comparison& comparison) {
  if (first.size() < 2 || second.size() < 2) {
    comparison.interval_method = "none: a single value says nothing of the spread";
    return;
  }
  if (first.size() + second.size() > kMostResampled) {
    comparison.interval = LargeSampleIntervalA(first, second, kConfidence);
    comparison.interval_method = "95 %, normal, by the variance of the placements (DeLong)";
    return;
  }
  comparison.interval = BootstrapA(first, second, kConfidence, kResamples, kSeed);
  comparison.interval_method =
      fmt::format("95 %, percentile bootstrap of single values, {} resamples", kResamples);
  if (comparison.interval->low == comparison.interval->high) {
    comparison.interval_method += "; without overlap it has no width, however few the values are";
  }
}

void AddClusterInterval(const ComparedSet& first, const ComparedSet& second, Comparison& comparison) {
  if (!HasRelatives(first.clusters) && !HasRelatives(second.clusters)) {
    comparison.cluster_method = "none: every value stands alone";
    return;
  }
  for (const ComparedSet* set : {&first, &second}) {
    if (set->clusters.size() > 1) continue;
    comparison.cluster_method = fmt::format(
        "none: all values of {} are of one unit, which says nothing of how another one would turn out",
        set->name);
    return;
  }
  comparison.cluster_interval =
      ClusterBootstrapA(first.clusters, second.clusters, kConfidence, kResamples, kSeed);
  const std::size_t fewest = std::min(first.clusters.size(), second.clusters.size());
  comparison.cluster_method = fmt::format(
      "95 %, percentile bootstrap of whole units ({} against {}), {} resamples{}", first.clusters.size(),
      second.clusters.size(), kResamples, fewest < kFewUnits ? "; so few units make it too short" : "");
}

std::vector<double> MeansOf(const Clusters& clusters) {
  std::vector<double> means;
  for (const std::vector<double>& cluster : clusters) means.push_back(Describe(cluster).mean);
  return means;
}

std::string UnitCounts(const std::vector<double>& first, const std::vector<double>& second) {
  return fmt::format("{} against {} units", first.size(), second.size());
}

// Welch 1947.
void TestUnits(const std::vector<double>& first, const std::vector<double>& second, Comparison& comparison) {
  const Description of_first = Describe(first);
  const Description of_second = Describe(second);
  comparison.difference = of_first.mean - of_second.mean;
  const std::string counts = UnitCounts(first, second);
  const bool few = std::min(first.size(), second.size()) < kFewestUnits;
  comparison.p_by =
      few ? fmt::format("no p: {} say too little, at least {} of each are needed", counts, kFewestUnits)
          : fmt::format("Welch's t of the means of {}", counts);
  if (!of_first.sd || !of_second.sd) return;
  const double share1 = *of_first.sd * *of_first.sd / static_cast<double>(first.size());
  const double share2 = *of_second.sd * *of_second.sd / static_cast<double>(second.size());
  const double error = std::sqrt(share1 + share2);
  if (error == 0.0) {
    comparison.p_by = fmt::format("no p: the units of either set are equal ({})", counts);
    return;
  }
  const double freedom = (share1 + share2) * (share1 + share2) /
                         (share1 * share1 / static_cast<double>(first.size() - 1) +
                          share2 * share2 / static_cast<double>(second.size() - 1));
  const double half = StudentUpperQuantile((1.0 - kConfidence) / 2.0, freedom) * error;
  comparison.difference_interval = Interval{comparison.difference - half, comparison.difference + half};
  if (!few)
    comparison.p = std::min(1.0, 2.0 * StudentUpperTail(std::abs(comparison.difference) / error, freedom));
}

void TestShares(const Description& first, const Description& second, Comparison& comparison) {
  const auto hits = [](const Description& d) {
    return static_cast<std::uint32_t>(std::lround(d.mean * static_cast<double>(d.n)));
  };
  const auto n1 = static_cast<std::uint32_t>(first.n);
  const auto n2 = static_cast<std::uint32_t>(second.n);
  comparison.difference = first.mean - second.mean;
  comparison.difference_interval = DifferenceInterval(hits(first), n1, hits(second), n2, kConfidence);
  comparison.p = FisherExact(hits(first), n1, hits(second), n2).p_two_sided;
  comparison.p_by = "Fisher, exact";
}

void Test(const ComparedSet& first, const ComparedSet& second, Comparison& comparison) {
  if (comparison.relatives) return TestUnits(MeansOf(first.clusters), MeansOf(second.clusters), comparison);
  if (comparison.yes_no) return TestShares(comparison.first, comparison.second, comparison);
  comparison.p = comparison.exact ? comparison.exact->p_two_sided : comparison.test.p_two_sided;
  comparison.p_by = comparison.exact ? "exact" : "normal approximation";
}

std::string IntervalText(const std::optional<Interval>& interval) {
  return interval ? fmt::format(" ({:.3f} to {:.3f} at 95 %)", interval->low, interval->high) : "";
}

// Of shares and of units.
std::string DifferenceInWords(const Comparison& comparison, const std::string& first,
                              const std::string& second) {
  const double scale = comparison.yes_no ? 100.0 : 1.0;
  const std::string unit = comparison.yes_no ? " percentage points" : "";
  const auto number = [&](double value) {
    return fmt::format("{:.{}f}", scale * value, comparison.yes_no ? 1 : 3);
  };
  const double size = std::abs(comparison.difference);
  std::string words = size == 0.0 ? fmt::format("{} and {} have the same mean", first, second)
                                  : fmt::format("{} is {}{} {} than {} on average", first, number(size), unit,
                                                comparison.difference < 0.0 ? "lower" : "higher", second);
  if (comparison.difference_interval) {
    const Interval& interval = *comparison.difference_interval;
    words += fmt::format(" ({} less {}: {} to {} at 95 %)", first, second, number(interval.low),
                         number(interval.high));
  }
  if (comparison.yes_no && comparison.second.mean > 0.0 && !comparison.relatives)
    words += fmt::format(", {:.2f} times as often", comparison.first.mean / comparison.second.mean);
  return fmt::format("{}; {}.", words, TestInWords(comparison.p, comparison.p_by));
}

}  // namespace

std::string TestInWords(const std::optional<double>& p, std::string_view by) {
  if (!p) return std::string(by);
  return fmt::format("{} ({})", *p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", *p), by);
}

Result<Comparison> Compare(const ComparedSet& first, const ComparedSet& second, bool yes_no) {
  const std::vector<double> values1 = ValuesOf(first.clusters);
  const std::vector<double> values2 = ValuesOf(second.clusters);
  TRY(CheckSample(values1, first.name));
  TRY(CheckSample(values2, second.name));
  Comparison comparison;
  comparison.yes_no = yes_no;
  comparison.relatives = HasRelatives(first.clusters) || HasRelatives(second.clusters);
  comparison.first = Describe(values1);
  comparison.second = Describe(values2);
  comparison.first_box = MakeBoxPlot(values1);
  comparison.second_box = MakeBoxPlot(values2);
  comparison.test = MannWhitney(values1, values2);
  comparison.exact = ExactMannWhitney(values1, values2);
  comparison.method = comparison.test.method;
  if (comparison.exact) comparison.method += fmt::format("; beside it {}", comparison.exact->method);
  comparison.effect = EffectOf(comparison.test.a);
  AddInterval(values1, values2, comparison);
  AddClusterInterval(first, second, comparison);
  Test(first, second, comparison);
  return comparison;
}

std::string InWords(const Comparison& comparison, const std::string& first, const std::string& second) {
  const RankTest& test = comparison.test;
  if (std::min(comparison.first.minimum, comparison.second.minimum) ==
      std::max(comparison.first.maximum, comparison.second.maximum)) {
    return fmt::format("All values are equal: nothing tells {} from {}.", first, second);
  }
  if (comparison.relatives || comparison.yes_no) return DifferenceInWords(comparison, first, second);
  std::string words = fmt::format("A value of {} exceeds one of {} with probability A = {:.3f}{}, ", first,
                                  second, test.a, IntervalText(comparison.interval));
  words += comparison.effect == "none" ? std::string("which is no effect worth a name")
                                       : fmt::format("a {} effect: {} tends to be {}", comparison.effect,
                                                     first, test.a > 0.5 ? "larger" : "smaller");
  return fmt::format("{}; {} of chance at the level 0.01 (two-sided p = {:.3g}, {}).", words,
                     *comparison.p < 0.01 ? "not a matter" : "it may be a matter", *comparison.p,
                     comparison.p_by);
}

}  // namespace gauntlet::analysis
