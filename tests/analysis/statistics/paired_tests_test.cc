#include "analysis/statistics/paired_tests.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/random/random_stream.h"
#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(PairedTests, AgreeWithR) {
  for (const ReferenceRow& row : ReadReference("paired_tests.csv")) {
    const std::string& what = row.Text("case");
    const std::vector<double> differences = row.List("differences");
    const std::string wilcoxon =
        differences.size() > kMostExactDifferences ? "wilcoxon_normal" : "wilcoxon_exact";
    ExpectRelativelyNear(WilcoxonSignedRank(differences).p_two_sided, row.Number(wilcoxon), 1e-9, what);
    if (const double flips = row.Number("sign_flip"); !std::isnan(flips))
      ExpectRelativelyNear(SignFlips(differences).Test().p_two_sided, flips, 1e-9, what);
  }
}

TEST(PairedTests, OfYesAndNoAgreeWithRAndBonettAndPrice) {
  for (const ReferenceRow& row : ReadReference("paired_shares.csv")) {
    const std::size_t first = row.Count("only_first");
    const std::size_t second = row.Count("only_second");
    const std::size_t pairs = row.Count("pairs");
    ExpectRelativelyNear(McNemarExact(first, second).p_two_sided, row.Number("p"), 1e-9, row.Text("pairs"));
    std::vector<double> differences(pairs, 0.0);
    std::fill_n(differences.begin(), first, 1.0);
    std::fill_n(differences.begin() + static_cast<std::ptrdiff_t>(first), second, -1.0);
    const Interval interval = MeanShareDifferenceInterval(differences, 0.95);
    EXPECT_NEAR(interval.low, std::max(-1.0, row.Number("low")), 1e-9);
    EXPECT_NEAR(interval.high, std::min(1.0, row.Number("high")), 1e-9);
  }
}

TEST(PairedTests, SayWhereNothingDiffers) {
  EXPECT_EQ(McNemarExact(0, 0).p_two_sided, 1.0);
  EXPECT_EQ(WilcoxonSignedRank(std::vector<double>{0, 0}).method, "no test: no pair differs");
  EXPECT_EQ(SignFlips(std::vector<double>{0, 0, 0}).Test().p_two_sided, 1.0);
}

TEST(SignFlips, NeedSixDifferencesForALevelOfFivePercent) {
  const std::vector<double> five = {1, 2, 3, 4, 5};
  EXPECT_EQ(SignFlips(five).Test().p_two_sided, 0.0625);
  EXPECT_TRUE(std::isinf(SignFlips(five).IntervalOf(0.95).low));
  const std::vector<double> six = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(SignFlips(six).Test().p_two_sided, 0.03125);
  EXPECT_EQ(SignFlips(six).IntervalOf(0.95).low, 1.0);
  EXPECT_EQ(SignFlips(six).IntervalOf(0.95).high, 6.0);
}

// All of a list of differences, or drawn ones.
RC_GTEST_PROP(SignFlips, ExcludeZeroWhereTheyRejectIt, ()) {
  const auto numbers =
      *rc::gen::container<std::vector<int>>(*rc::gen::inRange(6, 20), rc::gen::inRange(-20, 40));
  const std::vector<double> differences(numbers.begin(), numbers.end());
  const SignFlips flips(differences);
  const Interval interval = flips.IntervalOf(0.95);
  RC_ASSERT((flips.Test().p_two_sided <= 0.05) == (interval.low > 0.0 || interval.high < 0.0));
}

// Chances of `k` of `n`.
std::vector<double> Binomial(int n, double p) {
  std::vector<double> chances;
  for (int k = 0; k <= n; ++k)
    chances.push_back(std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                               k * std::log(p) + (n - k) * std::log1p(-p)));
  return chances;
}

TEST(McNemar, RejectsAtMostFivePercentOfEqualShares) {
  for (int discordant = 1; discordant <= 60; ++discordant) {
    double rejected = 0.0;
    const std::vector<double> chances = Binomial(discordant, 0.5);
    for (int first = 0; first <= discordant; ++first) {
      if (McNemarExact(first, discordant - first).p_two_sided <= 0.05) rejected += chances[first];
    }
    EXPECT_LE(rejected, 0.05) << discordant;
  }
}

// Of 100 pairs, by all counts of discordant ones. `p12`: only the first is hit.
double Coverage(double p12, double p21) {
  constexpr int kPairs = 100;
  const std::vector<double> firsts = Binomial(kPairs, p12);
  double covered = 0.0;
  for (int first = 0; first <= kPairs; ++first) {
    if (firsts[first] < 1e-9) continue;
    const std::vector<double> seconds = Binomial(kPairs - first, p21 / (1.0 - p12));
    for (int second = 0; second <= kPairs - first; ++second) {
      if (seconds[second] < 1e-7) continue;
      std::vector<double> differences(kPairs, 0.0);
      std::fill_n(differences.begin(), first, 1.0);
      std::fill_n(differences.rbegin(), second, -1.0);
      const Interval interval = MeanShareDifferenceInterval(differences, 0.95);
      if (interval.low <= p12 - p21 && p12 - p21 <= interval.high) covered += firsts[first] * seconds[second];
    }
  }
  return covered;
}

constexpr double kShares[] = {0.05, 0.1, 0.25, 0.5, 0.75, 0.95};

// At least 5 expected failures and passes; shares that are independent, and as alike as they can be.
TEST(MeanShareDifference, HoldsItsConfidenceOfSingleRuns) {
  double sum = 0.0;
  int count = 0;
  for (const double a : kShares) {
    for (const double b : kShares) {
      for (const double both : {a * b, std::min(a, b) - 0.01}) {
        const double coverage = Coverage(a - both, b - both);
        EXPECT_GE(coverage, 0.93) << a << " " << b << " " << both;
        sum += coverage;
        ++count;
      }
    }
  }
  EXPECT_GE(sum / count, 0.94);
  EXPECT_LE(sum / count, 0.97);
}

// Of four runs a case, in cases that always fail or never, and in cases that are all alike.
TEST(MeanShareDifference, HoldsItsConfidenceOfSeveralRuns) {
  constexpr int kCases = 100;
  constexpr int kRuns = 4;
  constexpr int kRepeats = 1500;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  double sum = 0.0;
  int count = 0;
  for (const bool alike : {false, true}) {
    for (const double a : {0.05, 0.25, 0.5}) {
      for (const double b : {0.05, 0.5, 0.95}) {
        int covered = 0;
        for (int repeat = 0; repeat < kRepeats; ++repeat) {
          std::vector<double> differences;
          for (int i = 0; i < kCases; ++i) {
            const double u = random.Uniform();  // the same case is hard for both
            const auto share = [&](double p) {
              if (!alike) return u < p ? 1.0 : 0.0;
              int failed = 0;
              for (int run = 0; run < kRuns; ++run) failed += random.Uniform() < p ? 1 : 0;
              return failed / static_cast<double>(kRuns);
            };
            const double of_a = share(a);
            differences.push_back(of_a - share(b));
          }
          const Interval interval = MeanShareDifferenceInterval(differences, 0.95);
          covered += interval.low <= a - b && a - b <= interval.high ? 1 : 0;
        }
        EXPECT_GE(covered, 0.93 * kRepeats) << a << " " << b << " " << alike;
        sum += covered / static_cast<double>(kRepeats);
        ++count;
      }
    }
  }
  EXPECT_GE(sum / count, 0.94);
}

TEST(UnitsNeeded, AreWhatStudentsTWouldTake) {
  EXPECT_EQ(UnitsNeeded(std::vector<double>{0.2, 0.3, 0.25}), SignFlips::kFewest);
  // Mean .1, standard deviation .2: t(.975, 17) .2 / sqrt(18) = .0995.
  EXPECT_EQ(UnitsNeeded(std::vector<double>{-0.1, 0.1, 0.3}), 18U);
  EXPECT_EQ(UnitsNeeded(std::vector<double>{-1, 1}), 0U);
}

}  // namespace
}  // namespace gauntlet::analysis
