#include "analysis/statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/statistics/distributions.h"
#include "sim/random/random_stream.h"

namespace gauntlet::analysis {
namespace {

std::vector<std::vector<double>> Singletons(const std::vector<double>& values) {
  std::vector<std::vector<double>> clusters;
  for (const double value : values) clusters.push_back({value});
  return clusters;
}

std::vector<double> Normal(int count, double mean, std::uint64_t seed) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(mean + random.Gaussian());
  return values;
}

TEST(ClusterBootstrapTest, SeparatedSetsGiveCertainty) {
  const Interval interval = ClusterBootstrapA({{5, 6}, {7, 8}}, {{1}, {2}, {3}}, 0.9, 500, 1);
  EXPECT_EQ(interval.low, 1.0);
  EXPECT_EQ(interval.high, 1.0);
}

// For independent values the width agrees with A's asymptotic standard error, sqrt((n + m + 1) / (12 n m))
// near A = 0.5.
TEST(ClusterBootstrapTest, IndependentValuesGiveTheAsymptoticWidth) {
  const Interval interval =
      ClusterBootstrapA(Singletons(Normal(100, 0, 1)), Singletons(Normal(100, 0, 2)), 0.9, 2000, 1);
  const double standard_error = std::sqrt(201.0 / (12.0 * 100.0 * 100.0));
  EXPECT_NEAR(interval.high - interval.low, 2.0 * 1.645 * standard_error, 0.2 * 2.0 * 1.645 * standard_error);
}

// Twenty copies of ten values are ten observations, not two hundred.
TEST(ClusterBootstrapTest, RelativesDoNotCountAsEvidence) {
  const std::vector<double> founders = Normal(10, 0.4, 3);
  std::vector<std::vector<double>> families;
  std::vector<double> flat;
  for (const double founder : founders) {
    families.emplace_back(20, founder);
    flat.insert(flat.end(), 20, founder);
  }
  const auto other = Singletons(Normal(200, 0, 4));
  const Interval clustered = ClusterBootstrapA(families, other, 0.9, 1000, 1);
  const Interval pretended = ClusterBootstrapA(Singletons(flat), other, 0.9, 1000, 1);
  EXPECT_GT(clustered.high - clustered.low, 2.0 * (pretended.high - pretended.low));
}

TEST(ClusterBootstrapTest, IsAFunctionOfItsSeed) {
  const auto a = Singletons(Normal(30, 0.5, 5));
  const auto b = Singletons(Normal(30, 0, 6));
  const Interval interval = ClusterBootstrapA(a, b, 0.9, 300, 7);
  EXPECT_EQ(ClusterBootstrapA(a, b, 0.9, 300, 7).low, interval.low);
  EXPECT_NE(ClusterBootstrapA(a, b, 0.9, 300, 8).low, interval.low);
}

TEST(BootstrapTest, IndependentValuesAreClustersOfOne) {
  const auto a = Normal(30, 0.5, 5);
  const auto b = Normal(40, 0, 6);
  const Interval interval = BootstrapA(a, b, 0.95, 500, 1);
  const Interval clustered = ClusterBootstrapA(Singletons(a), Singletons(b), 0.95, 500, 1);
  EXPECT_EQ(interval.low, clustered.low);
  EXPECT_EQ(interval.high, clustered.high);
}

// With ties and far from 1/2, where the variance of U under equality would be wrong.
TEST(LargeSampleIntervalTest, AgreesWithTheBootstrap) {
  auto a = Normal(2000, 1.0, 7);
  auto b = Normal(1500, 0.0, 8);
  for (std::vector<double>* values : {&a, &b}) {
    for (double& value : *values) value = std::round(2.0 * value);
  }
  const Interval normal = LargeSampleIntervalA(a, b, 0.95);
  const Interval bootstrap = BootstrapA(a, b, 0.95, 4000, 1);
  const double width = bootstrap.high - bootstrap.low;
  EXPECT_NEAR(normal.low, bootstrap.low, 0.05 * width);
  EXPECT_NEAR(normal.high, bootstrap.high, 0.05 * width);
}

TEST(LargeSampleIntervalTest, SeparatedSetsGiveCertainty) {
  const Interval interval = LargeSampleIntervalA(std::vector<double>{3, 4}, std::vector<double>{1, 2}, 0.95);
  EXPECT_EQ(interval.low, 1.0);
  EXPECT_EQ(interval.high, 1.0);
}

// How often an interval holds the true A of two normal distributions one standard deviation apart.
TEST(BootstrapTest, HoldsItsConfidence) {
  const double truth = 1.0 - NormalUpperTail(1.0 / std::sqrt(2.0));
  int held_by_bootstrap = 0;
  int held_by_normal = 0;
  constexpr int kTrials = 400;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const auto a = Normal(40, 1.0, 1000 + 2 * trial);
    const auto b = Normal(40, 0.0, 1001 + 2 * trial);
    const Interval bootstrap = BootstrapA(a, b, 0.9, 200, trial);
    const Interval normal = LargeSampleIntervalA(a, b, 0.9);
    if (bootstrap.low <= truth && truth <= bootstrap.high) ++held_by_bootstrap;
    if (normal.low <= truth && truth <= normal.high) ++held_by_normal;
  }
  // 0.9 of 400 is 360, with a standard deviation of 6; the percentile interval of small sets is a little
  // short.
  EXPECT_NEAR(held_by_bootstrap, 360, 20);
  EXPECT_NEAR(held_by_normal, 360, 20);
}

}  // namespace
}  // namespace gauntlet::analysis
