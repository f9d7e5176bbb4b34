#include "analysis/statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_EQ(ClusterBootstrapA(a, b, 0.9, 300, 7).low, ClusterBootstrapA(a, b, 0.9, 300, 7).low);
}

}  // namespace
}  // namespace gauntlet::analysis
