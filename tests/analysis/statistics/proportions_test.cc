#include "analysis/statistics/proportions.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.h"
#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(ProportionIntervals, AgreeWithR) {
  for (const ReferenceRow& row : ReadReference("failure_probability_ci.csv")) {
    const std::string what = row.Text("k") + " of " + row.Text("n");
    const Interval wilson = WilsonInterval(row.Count("k"), row.Count("n"), 0.95);
    EXPECT_NEAR(wilson.low, row.Number("wilson_lo"), 1e-12) << what;
    EXPECT_NEAR(wilson.high, row.Number("wilson_hi"), 1e-12) << what;
  }
}

TEST(ProportionIntervals, OfCasesAreThoseOfTheirRunsWhereThoseAreAllAlike) {
  // 20 of 200 runs, one a case: the spread is that of single runs, so that 199 of them would show it.
  std::vector<double> single(200, 0.0);
  std::fill_n(single.begin(), 20, 1.0);
  const Interval of_runs = AgrestiCoullInterval(20, 200, 0.95);
  EXPECT_NEAR(MeanShareInterval(single, 1.0, 0.95).low, of_runs.low, 1e-3);
  EXPECT_NEAR(of_runs.low, 0.0650, 1e-4);
  EXPECT_NEAR(of_runs.high, 0.1501, 1e-4);
  // Ten runs a case, in cases that always fail or never: they are worth one each.
  EXPECT_NEAR(MeanShareInterval(single, 10.0, 0.95).low, of_runs.low, 1e-3);
  EXPECT_EQ(MeanShareInterval(std::vector<double>(20, 0.0), 10.0, 0.95).low, 0.0);
}

// Examples of Newcombe 1998, table II, method 10.
TEST(ProportionIntervals, OfADifferenceAreNewcombes) {
  const Interval many = DifferenceInterval(56, 70, 48, 80, 0.95);
  EXPECT_NEAR(many.low, 0.0524, 5e-5);
  EXPECT_NEAR(many.high, 0.3339, 5e-5);
  const Interval few = DifferenceInterval(9, 10, 3, 10, 0.95);
  EXPECT_NEAR(few.low, 0.1705, 5e-5);
  EXPECT_NEAR(few.high, 0.8090, 5e-5);
  const Interval clear = DifferenceInterval(10, 10, 0, 10, 0.95);
  EXPECT_NEAR(clear.low, 0.6075, 5e-5);
  EXPECT_NEAR(clear.high, 1.0, 5e-5);
}

// The chance that the interval of whatever count comes out holds the true `probability`.
double Coverage(const std::vector<Interval>& interval_of_count, double probability) {
  const auto trials = static_cast<double>(interval_of_count.size() - 1);
  double coverage = 0.0;
  for (std::size_t count = 0; count < interval_of_count.size(); ++count) {
    const Interval& interval = interval_of_count[count];
    if (probability < interval.low || probability > interval.high) continue;
    const auto k = static_cast<double>(count);
    coverage += std::exp(std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0) +
                         k * std::log(probability) + (trials - k) * std::log1p(-probability));
  }
  return coverage;
}

TEST(ProportionIntervals, HoldTheirConfidenceForSmallNumbersOfTrials) {
  for (const std::uint32_t trials : {1U, 3U, 10U, 20U}) {
    for (const double confidence : {0.9, 0.95}) {
      std::vector<Interval> wilson;
      for (std::uint32_t k = 0; k <= trials; ++k) wilson.push_back(WilsonInterval(k, trials, confidence));
      double mean = 0.0;
      constexpr int kSteps = 400;
      for (int i = 1; i < kSteps; ++i) {
        const double probability = i / static_cast<double>(kSteps);
        mean += Coverage(wilson, probability) / (kSteps - 1);
      }
      if (trials >= 10) {
        EXPECT_NEAR(mean, confidence, 0.015) << trials << " trials";
      }
    }
  }
}

TEST(FisherExactTest, AgreesWithR) {
  for (const ReferenceRow& row : ReadReference("fisher.csv")) {
    const FisherTest test = FisherExact(row.Count("fail1"), row.Count("fail1") + row.Count("ok1"),
                                        row.Count("fail2"), row.Count("fail2") + row.Count("ok2"));
    const std::string what = row.Text("fail1") + " against " + row.Text("fail2");
    ExpectRelativelyNear(test.p_greater, row.Number("fisher_greater"), 1e-10, what);
    ExpectRelativelyNear(test.p_two_sided, row.Number("fisher_two"), 1e-10, what);
    ExpectRelativelyNear(test.odds_ratio, row.Number("psi_halfcorrected"), 1e-12, what);
  }
}

TEST(FisherExactTest, StandsLargeCounts) {
  const FisherTest test = FisherExact(50'000, 100'000, 49'000, 100'000);
  // The normal approximation with continuity correction: z = 999 / sqrt(49,997.5).
  EXPECT_NEAR(test.p_greater / NormalUpperTail(999.0 / std::sqrt(49'995.25)), 1.0, 0.01);
  EXPECT_EQ(FisherExact(100'000, 100'000, 0, 100'000).p_greater, 0.0);  // less than any double
  EXPECT_EQ(FisherExact(100'000, 100'000, 0, 100'000).p_less, 1.0);
}

RC_GTEST_PROP(FisherProperty, ExchangingTheSetsExchangesTheAnswers, ()) {
  const auto trials1 = *rc::gen::inRange(1U, 40U);
  const auto trials2 = *rc::gen::inRange(1U, 40U);
  const auto hits1 = *rc::gen::inRange(0U, trials1 + 1);
  const auto hits2 = *rc::gen::inRange(0U, trials2 + 1);
  const FisherTest test = FisherExact(hits1, trials1, hits2, trials2);
  const FisherTest mirrored = FisherExact(hits2, trials2, hits1, trials1);
  RC_ASSERT(std::abs(test.p_less - mirrored.p_greater) < 1e-12);
  RC_ASSERT(std::abs(test.p_two_sided - mirrored.p_two_sided) < 1e-12);
  RC_ASSERT(std::abs(test.odds_ratio * mirrored.odds_ratio - 1.0) < 1e-12);
  RC_ASSERT(test.p_two_sided <= 1.0 && test.p_two_sided >= std::min(test.p_less, test.p_greater));
  RC_ASSERT(test.p_less + test.p_greater >= 1.0);
}

}  // namespace
}  // namespace gauntlet::analysis
