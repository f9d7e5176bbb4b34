#include "analysis/statistics/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "sim/random/random_stream.h"
#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

ComparedSet Alone(const std::string& name, const std::vector<double>& values) {
  ComparedSet set{name, {}};
  for (const double value : values) set.clusters.push_back({value});
  return set;
}

std::vector<double> Uniform(int count, double shift, std::uint64_t seed) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(shift + random.Uniform());
  return values;
}

TEST(CompareTest, GivesTheSameNumbersEveryTimeAndNamesItsMethods) {
  const ComparedSet a = Alone("A", Uniform(100, 0.2, 1));
  const ComparedSet b = Alone("B", Uniform(100, 0.0, 2));
  const auto comparison = Compare(a, b);
  ASSERT_TRUE(comparison.ok());
  EXPECT_EQ(comparison->first.n, 100U);
  EXPECT_EQ(comparison->test.a, MannWhitney(Uniform(100, 0.2, 1), Uniform(100, 0.0, 2)).a);
  ASSERT_TRUE(comparison->interval.has_value());
  EXPECT_LT(comparison->interval->low, comparison->test.a);
  EXPECT_GT(comparison->interval->high, comparison->test.a);
  EXPECT_EQ(comparison->interval->low, Compare(a, b)->interval->low);
  EXPECT_EQ(comparison->method,
            "Mann-Whitney U, normal approximation, corrected for ties and continuity; beside it Mann-Whitney "
            "U, exact distribution of the observed mid-ranks");
  EXPECT_EQ(comparison->interval_method, "95 %, percentile bootstrap of single values, 4000 resamples");
  EXPECT_EQ(comparison->cluster_interval, std::nullopt);
  EXPECT_EQ(comparison->cluster_method, "none: every value stands alone");
}

TEST(CompareTest, LargeSetsAreNotDrawnAgain) {
  const auto comparison = Compare(Alone("A", Uniform(15'000, 0.2, 1)), Alone("B", Uniform(15'000, 0.0, 2)));
  ASSERT_TRUE(comparison.ok());
  EXPECT_FALSE(comparison->exact.has_value());
  EXPECT_EQ(comparison->interval_method, "95 %, normal, by the variance of the placements (DeLong)");
}

TEST(CompareTest, RelativesHaveAnIntervalOfTheirOwnAndAReason) {
  ComparedSet families{"families", {}};
  for (const double founder : Uniform(12, 0.0, 3)) families.clusters.emplace_back(20, founder);
  const auto comparison = Compare(families, Alone("B", Uniform(100, 0.0, 4)));
  ASSERT_TRUE(comparison.ok());
  ASSERT_TRUE(comparison->cluster_interval.has_value());
  EXPECT_GT(comparison->cluster_interval->high - comparison->cluster_interval->low,
            1.5 * (comparison->interval->high - comparison->interval->low));
  EXPECT_EQ(comparison->cluster_method,
            "95 %, percentile bootstrap of whole units (12 against 100), 4000 resamples");
  EXPECT_TRUE(comparison->relatives);
  EXPECT_EQ(comparison->p_by, "Welch's t of the means of 12 against 100 units");

  families.clusters.resize(3);
  EXPECT_EQ(Compare(families, Alone("B", {1, 2}))->cluster_method,
            "95 %, percentile bootstrap of whole units (3 against 2), 4000 resamples; so few units make it "
            "too short");
  families.clusters.resize(1);
  const auto alone = Compare(families, Alone("B", {1, 2}));
  EXPECT_EQ(alone->cluster_interval, std::nullopt);
  EXPECT_EQ(
      alone->cluster_method,
      "none: all values of families are of one unit, which says nothing of how another one would turn out");
}

TEST(CompareTest, MeansOfUnitsAgreeWithR) {
  for (const ReferenceRow& row : ReadReference("unit_means.csv")) {
    ComparedSet first{"A", {}};
    for (const double mean : row.List("x")) first.clusters.push_back({mean - 0.5, mean + 0.5});
    const Comparison c = Compare(first, Alone("B", row.List("y"))).value();
    ASSERT_TRUE(c.difference_interval.has_value());
    ExpectRelativelyNear(c.difference_interval->low, row.Number("low"), 1e-9, row.Text("case"));
    ExpectRelativelyNear(c.difference_interval->high, row.Number("high"), 1e-9, row.Text("case"));
    const bool enough = std::min(first.clusters.size(), row.List("y").size()) >= kFewestUnits;
    ASSERT_EQ(c.p.has_value(), enough) << row.Text("case");
    if (enough) ExpectRelativelyNear(*c.p, row.Number("p"), 1e-9, row.Text("case"));
  }
}

TEST(CompareTest, FewUnitsGiveNoPWhateverTheirRunsAre) {
  ComparedSet few{"few", {}};
  ComparedSet other{"other", {}};
  for (int unit = 0; unit < 5; ++unit) {
    few.clusters.emplace_back(20, 0.1 + 0.01 * unit);
    other.clusters.emplace_back(20, 0.8 + 0.01 * unit);
  }
  EXPECT_EQ(
      InWords(Compare(few, other).value(), "X", "Y"),
      "X is 0.700 lower than Y on average (X less Y: -0.723 to -0.677 at 95 %); no p: 5 against 5 units say "
      "too little, at least 6 of each are needed.");
}

// Families of like runs, no difference between the sets.
TEST(CompareTest, UnitsThatDoNotDifferAreSeldomFoundToDiffer) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    sim::RandomStream random(seed, sim::StreamPurpose::kTest);
    ComparedSet sets[2] = {{"A", {}}, {"B", {}}};
    for (ComparedSet& set : sets) {
      for (int unit = 0; unit < 6; ++unit) {
        const double founder = std::max(0.0, random.Uniform() - 0.3);
        std::vector<double>& family = set.clusters.emplace_back();
        for (int run = 0; run < 3; ++run) family.push_back(founder + 0.05 * random.Uniform());
      }
    }
    const Comparison c = Compare(sets[0], sets[1]).value();
    found += *c.p <= 0.05 ? 1 : 0;
  }
  EXPECT_LE(found, 65);
}

TEST(CompareTest, YesAndNoAreSharesWithTheirDifferenceAndRatio) {
  std::vector<double> first(200, 0.0);
  std::vector<double> second(200, 0.0);
  std::fill_n(first.begin(), 28, 1.0);
  std::fill_n(second.begin(), 49, 1.0);
  EXPECT_EQ(
      InWords(Compare(Alone("A", first), Alone("B", second), /*yes_no=*/true).value(), "X", "Y"),
      "X is 10.5 percentage points lower than Y on average (X less Y: -18.1 to -2.8 at 95 %), 0.57 times as "
      "often; p = 0.011 (Fisher, exact).");
}

TEST(CompareTest, OneValueAndEqualValuesAreSaidToBeSo) {
  const auto one = Compare(Alone("A", {1}), Alone("B", {2, 3}));
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->interval, std::nullopt);
  EXPECT_EQ(one->interval_method, "none: a single value says nothing of the spread");
  EXPECT_FALSE(one->first.sd.has_value());

  const auto equal = Compare(Alone("A", {0.5, 0.5}), Alone("B", {0.5, 0.5, 0.5}));
  ASSERT_TRUE(equal.ok());
  EXPECT_EQ(equal->test.a, 0.5);
  EXPECT_EQ(equal->p, 1.0);
  EXPECT_EQ(equal->effect, "none");
  EXPECT_EQ(equal->method,
            "no test: all values are equal; beside it Mann-Whitney U, exact distribution of the observed "
            "mid-ranks");
  EXPECT_EQ(InWords(*equal, "X", "Y"), "All values are equal: nothing tells X from Y.");
}

TEST(CompareTest, RefusesEmptySetsAndWhatIsNoNumber) {
  EXPECT_EQ(Compare(Alone("A", {}), Alone("B", {1})).error().message,
            "A is empty: at least one value is needed");
  EXPECT_EQ(
      Compare(Alone("A", {1}), Alone("B", {1, std::numeric_limits<double>::quiet_NaN()})).error().message,
      "B: value 2 is not a number, only finite numbers can be compared");
}

TEST(CompareTest, WordsTellDirectionAndSize) {
  const auto comparison = Compare(Alone("A", {1, 2, 3, 4, 5, 6, 7}), Alone("B", {11, 12, 13, 14, 15, 16}));
  ASSERT_TRUE(comparison.ok());
  const std::string words = InWords(*comparison, "X", "Y");
  EXPECT_EQ(
      words,
      "A value of X exceeds one of Y with probability A = 0.000 (0.000 to 0.000 at 95 %), a large effect: X "
      "tends to be smaller; not a matter of chance at the level 0.01 (two-sided p = 0.00117, exact).");
  EXPECT_EQ(comparison->interval_method,
            "95 %, percentile bootstrap of single values, 4000 resamples; without overlap it has no width, "
            "however few the values are");
  EXPECT_EQ(
      InWords(*Compare(Alone("A", {1, 2}), Alone("B", {1, 3})), "X", "Y"),
      "A value of X exceeds one of Y with probability A = 0.375 (0.000 to 1.000 at 95 %), a small effect: X "
      "tends to be smaller; it may be a matter of chance at the level 0.01 (two-sided p = 1, exact).");
}

}  // namespace
}  // namespace gauntlet::analysis
