#include "tests/golden/swarm/equivalence_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analysis/statistics/distributions.h"

namespace gauntlet::analysis {
namespace {

TEST(TestEquivalence, KnownExample) {
  // Mean 0.1, sd sqrt(0.025) and standard error sqrt(0.005); t quantile of 4 degrees of freedom at 5 %:
  // 2.131847.
  const std::vector<double> differences = {-0.1, 0.0, 0.1, 0.2, 0.3};
  const EquivalenceTest test = TestEquivalence(differences, 0.3, 0.05);
  EXPECT_NEAR(test.mean, 0.1, 1e-12);
  EXPECT_NEAR(test.sd, std::sqrt(0.025), 1e-12);
  EXPECT_NEAR(test.interval.low, 0.1 - 2.131847 * std::sqrt(0.005), 1e-6);
  EXPECT_NEAR(test.interval.high, 0.1 + 2.131847 * std::sqrt(0.005), 1e-6);
  EXPECT_NEAR(test.p, StudentUpperTail(0.2 / std::sqrt(0.005), 4), 1e-12);
  EXPECT_TRUE(test.equivalent);
}

TEST(TestEquivalence, HoldsExactlyWhenTheIntervalLiesInsideTheMargin) {
  const std::vector<double> differences = {-0.1, 0.0, 0.1, 0.2, 0.3};
  const double edge = TestEquivalence(differences, 1.0, 0.05).interval.high;
  EXPECT_TRUE(TestEquivalence(differences, edge + 1e-9, 0.05).equivalent);
  EXPECT_FALSE(TestEquivalence(differences, edge - 1e-9, 0.05).equivalent);
}

TEST(TestEquivalence, NoSignificantDifferenceIsNotEquivalence) {
  EXPECT_FALSE(TestEquivalence(std::vector<double>{-1.0, 1.0, -0.9, 0.9}, 0.3, 0.05).equivalent);
}

TEST(TestEquivalence, EqualDifferencesAreTakenForExact) {
  EXPECT_TRUE(TestEquivalence(std::vector<double>{0.1, 0.1, 0.1}, 0.2, 0.05).equivalent);
  EXPECT_FALSE(TestEquivalence(std::vector<double>{0.25, 0.25, 0.25}, 0.2, 0.05).equivalent);
}

}  // namespace
}  // namespace gauntlet::analysis
