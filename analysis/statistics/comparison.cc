#include "analysis/statistics/comparison.h"

#include <algorithm>

#include <fmt/format.h>

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

std::string IntervalText(const std::optional<Interval>& interval) {
  return interval ? fmt::format(" ({:.3f} to {:.3f} at 95 %)", interval->low, interval->high) : "";
}

}  // namespace

Result<Comparison> Compare(const ComparedSet& first, const ComparedSet& second) {
  const std::vector<double> values1 = ValuesOf(first.clusters);
  const std::vector<double> values2 = ValuesOf(second.clusters);
  TRY(CheckSample(values1, first.name));
  TRY(CheckSample(values2, second.name));
  Comparison comparison;
  comparison.first = Describe(values1);
  comparison.second = Describe(values2);
  comparison.first_box = MakeBoxPlot(values1);
  comparison.second_box = MakeBoxPlot(values2);
  comparison.test = MannWhitney(values1, values2);
  comparison.exact = ExactMannWhitney(values1, values2);
  comparison.method = comparison.test.method;
  if (comparison.exact) comparison.method += fmt::format("; beside it {}", comparison.exact->method);
  comparison.p_two_sided = comparison.exact ? comparison.exact->p_two_sided : comparison.test.p_two_sided;
  comparison.p_by = comparison.exact ? "exact" : "normal approximation";
  comparison.effect = EffectOf(comparison.test.a);
  AddInterval(values1, values2, comparison);
  AddClusterInterval(first, second, comparison);
  return comparison;
}

std::string InWords(const Comparison& comparison, const std::string& first, const std::string& second) {
  const RankTest& test = comparison.test;
  if (std::min(comparison.first.minimum, comparison.second.minimum) ==
      std::max(comparison.first.maximum, comparison.second.maximum)) {
    return fmt::format("All values are equal: nothing tells {} from {}.", first, second);
  }
  std::string words = fmt::format("A value of {} exceeds one of {} with probability A = {:.3f}{}, ", first,
                                  second, test.a, IntervalText(comparison.interval));
  words += comparison.effect == "none" ? std::string("which is no effect worth a name")
                                       : fmt::format("a {} effect: {} tends to be {}", comparison.effect,
                                                     first, test.a > 0.5 ? "larger" : "smaller");
  const double p = comparison.p_two_sided;
  words += fmt::format("; {} of chance at the level 0.01 (two-sided p = {:.3g}, {}).",
                       p < 0.01 ? "not a matter" : "it may be a matter", p, comparison.p_by);
  if (!comparison.cluster_interval) return words;
  return words +
         fmt::format(
             " With whole units drawn instead of single values A lies between {:.3f} and {:.3f}: values of "
             "one unit are relatives, and a test that takes them for independent is too sure of itself.",
             comparison.cluster_interval->low, comparison.cluster_interval->high);
}

}  // namespace gauntlet::analysis
