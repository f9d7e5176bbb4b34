// Covers: analysis/statistics/exact_rank_test.cc
#include "analysis/statistics/rank_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/random/random_stream.h"
#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(MannWhitneyTest, AgreesWithRAndIsExactInRanks) {
  const auto samples = ReadMannWhitneySamples();
  int compared = 0;
  for (const ReferenceRow& row : ReadReference("mannwhitney_results.csv")) {
    const std::string& name = row.Text("case");
    const RankTest test = MannWhitney(samples.at(name).x, samples.at(name).y);
    EXPECT_EQ(test.rank_sum1, row.Number("R1")) << name;
    EXPECT_EQ(test.rank_sum2, row.Number("R2")) << name;
    EXPECT_EQ(test.u1, row.Number("W_R_U1")) << name;
    EXPECT_EQ(test.u2, row.Number("U2")) << name;
    EXPECT_NEAR(test.a, row.Number("A_xy"), 1e-12) << name;
    if (std::isnan(row.Number("p_asym_cc_two"))) {  // R's answer when all values are equal
      EXPECT_EQ(test.p_less, 1.0) << name;
      EXPECT_EQ(test.p_greater, 1.0) << name;
      EXPECT_EQ(test.p_two_sided, 1.0) << name;
      EXPECT_EQ(test.method, "no test: all values are equal") << name;
      continue;
    }
    EXPECT_EQ(std::string(test.method),
              "Mann-Whitney U, normal approximation, corrected for ties and continuity")
        << name;
    ExpectRelativelyNear(test.p_greater, row.Number("p_asym_cc_greater"), 1e-10, name);
    ExpectRelativelyNear(test.p_less, row.Number("p_asym_cc_less"), 1e-10, name);
    ExpectRelativelyNear(test.p_two_sided, row.Number("p_asym_cc_two"), 1e-10, name);
    ++compared;
  }
  EXPECT_GE(compared, 9);
}

TEST(MannWhitneyTest, TiedValuesShareTheMeanOfTheirRanks) {
  EXPECT_THAT(MidRanks(std::vector<double>{3, 1, 3, 2, 3}), testing::ElementsAre(4, 1, 4, 2, 4));
}

TEST(ExactMannWhitneyTest, AgreesWithRWithTiesAndWithout) {
  const auto samples = ReadMannWhitneySamples();
  for (const ReferenceRow& row : ReadReference("mannwhitney_results.csv")) {
    const std::string& name = row.Text("case");
    const auto exact = ExactMannWhitney(samples.at(name).x, samples.at(name).y);
    ASSERT_TRUE(exact.has_value()) << name;
    ExpectRelativelyNear(exact->p_greater, row.Number("p_exact_perm_greater"), 1e-10, name);
    ExpectRelativelyNear(exact->p_less, row.Number("p_exact_perm_less"), 1e-10, name);
    ExpectRelativelyNear(exact->p_two_sided, row.Number("p_exact_perm_two_doubled"), 1e-10, name);
    if (std::isnan(row.Number("p_exact_R_greater"))) continue;  // R computes it without ties only
    ExpectRelativelyNear(exact->p_greater, row.Number("p_exact_R_greater"), 1e-10, name);
    ExpectRelativelyNear(exact->p_less, row.Number("p_exact_R_less"), 1e-10, name);
  }
}

// Two sets that give this U: each value of the first exceeds as many of the second as asked for. Without
// ties, but for one where U is no whole number.
SamplePair SetsWithU(int nx, int ny, double u) {
  const int whole = static_cast<int>(u);
  SamplePair pair;
  for (int i = 0; i < nx; ++i) {
    const int exceeded = std::clamp(whole - i * ny, 0, ny);
    pair.x.push_back(exceeded + 0.5 + 0.001 * i);
  }
  if (whole != u) pair.x.back() = std::ceil(pair.x.back());
  for (int i = 1; i <= ny; ++i) pair.y.push_back(i);
  return pair;
}

RankTest MannWhitneyFromRankSum(double rank_sum1, int n1, int n2) {
  const SamplePair pair = SetsWithU(n1, n2, rank_sum1 - n1 * (n1 + 1) / 2.0);
  return MannWhitney(pair.x, pair.y);
}

TEST(ExactMannWhitneyTest, GivesTheWholeNullDistribution) {
  for (const ReferenceRow& row : ReadReference("pwilcox_null_distribution.csv")) {
    const SamplePair pair =
        SetsWithU(static_cast<int>(row.Count("nx")), static_cast<int>(row.Count("ny")), row.Number("U"));
    const std::string what = row.Text("nx") + " against " + row.Text("ny") + ", U = " + row.Text("U");
    ASSERT_EQ(MannWhitney(pair.x, pair.y).u1, row.Number("U")) << what;
    const auto exact = ExactMannWhitney(pair.x, pair.y);
    ExpectRelativelyNear(exact->p_less, row.Number("p_le"), 1e-10, what);
    ExpectRelativelyNear(exact->p_greater, row.Number("p_ge"), 1e-10, what);
  }
}

TEST(ExactMannWhitneyTest, AgreesWithTheApproximationForLargeSets) {
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::vector<double> x(100);
  std::vector<double> y(100);
  for (double& value : x) value = std::floor(20.0 * random.Uniform()) + 1.0;
  for (double& value : y) value = std::floor(20.0 * random.Uniform());
  const RankTest test = MannWhitney(x, y);
  EXPECT_NEAR(ExactMannWhitney(x, y)->p_greater, test.p_greater, 2e-4);
  EXPECT_NEAR(ExactMannWhitney(y, x)->p_greater, test.p_less, 2e-4);
}

TEST(ExactMannWhitneyTest, IsLeftOutWhereItWouldTakeLong) {
  EXPECT_TRUE(ExactMannWhitney(std::vector<double>(100, 1.0), std::vector<double>(100, 1.0)).has_value());
  EXPECT_FALSE(ExactMannWhitney(std::vector<double>(100, 1.0), std::vector<double>(101, 1.0)).has_value());
}

// Every U and every rank sum that the thesis prints, from the other; what does not hold is a misprint of it
// (data/README.md).
TEST(ThesisTables, FollowFromTheirRankSums) {
  for (const ReferenceRow& row : ReadReference("thesis_rank_tests.csv")) {
    const std::string& table = row.Text("table");
    const RankTest test = MannWhitneyFromRankSum(row.Number("rank_sum1"), 100, 100);
    EXPECT_EQ(test.rank_sum2, row.Number("rank_sum2")) << table;
    EXPECT_EQ(test.u1, row.Number("u2")) << table;  // the thesis prints the complement
    EXPECT_EQ(test.u2, row.Number("u1")) << table;
    const bool misprinted_mean_rank = table == "4.7-3";  // 8172 for 81.72
    EXPECT_NEAR(row.Number("mean_rank1") / (misprinted_mean_rank ? 100.0 : 1.0),
                row.Number("rank_sum1") / 100.0, 0.005 + 1e-9)
        << table;
    EXPECT_NEAR(row.Number("mean_rank2"), row.Number("rank_sum2") / 100.0, 0.005 + 1e-9) << table;

    const bool swapped_rows = table.starts_with("6.4");  // the larger ranks beside the smaller mean
    EXPECT_EQ(row.Number("mean1") < row.Number("mean2"), (test.a < 0.5) != swapped_rows) << table;
    EXPECT_NEAR(std::max(test.a, 1.0 - test.a), row.Number("a"), 5e-5 + 1e-9) << table;
    const double p = std::min(test.p_less, test.p_greater);
    EXPECT_NEAR(p / row.Number("p"), 1.0, 0.05) << table;  // of which two digits are given
    const bool misprinted_p = table == "4.7-2";            // 6e-4
    EXPECT_EQ(p < 1e-5, !misprinted_p) << table;
    EXPECT_LT(p, 0.01) << table;  // which changes no verdict
  }
}

TEST(ThesisTables, AgreeWithR) {
  for (const ReferenceRow& row : ReadReference("thesis_consistency.csv")) {
    const RankTest test = MannWhitneyFromRankSum(row.Number("R1"), static_cast<int>(row.Count("n1")),
                                                 static_cast<int>(row.Count("n2")));
    EXPECT_EQ(test.u1, row.Number("U_from_R1"));
    EXPECT_EQ(test.u2, row.Number("U_from_R2"));
    EXPECT_NEAR(test.a, row.Number("A_1gt2"), 1e-12);
    ExpectRelativelyNear(test.p_less, row.Number("p_one_cc"), 1e-4, "p, of which R knows no tie");
  }
}

TEST(EffectTest, AIsNamedByItsSize) {
  const auto samples = ReadMannWhitneySamples();
  for (const ReferenceRow& row : ReadReference("vargha_delaney.csv")) {
    const std::string& name = row.Text("case");
    const double a = MannWhitney(samples.at(name).x, samples.at(name).y).a;
    EXPECT_NEAR(a, row.Number("A_spartan"), 1e-12) << name;
    EXPECT_NEAR(a, row.Number("A_pairs"), 1e-12) << name;
    EXPECT_EQ(EffectOf(a), row.Text("effect_vd2000_056_064_071")) << name;
  }
  EXPECT_EQ(EffectOf(0.64), "medium");
  EXPECT_EQ(EffectOf(0.36), "medium");
  EXPECT_EQ(EffectOf(0.5), "none");
}

std::vector<double> SomeValues() {
  const auto value = rc::gen::map(rc::gen::inRange(0, 6), [](int i) { return static_cast<double>(i); });
  const auto size = *rc::gen::inRange<std::size_t>(1, 8);
  return *rc::gen::container<std::vector<double>>(size, value);
}

RC_GTEST_PROP(MannWhitneyProperty, AIsTheShareOfPairsWithTiesCountingHalf, ()) {
  const auto x = SomeValues();
  const auto y = SomeValues();
  double pairs = 0.0;
  for (const double a : x) {
    for (const double b : y) pairs += a > b ? 1.0 : (a == b ? 0.5 : 0.0);
  }
  const RankTest test = MannWhitney(x, y);
  RC_ASSERT(test.u1 == pairs);
  RC_ASSERT(test.u1 + test.u2 == static_cast<double>(x.size() * y.size()));
  for (const double p : {test.p_less, test.p_greater, test.p_two_sided}) RC_ASSERT(p >= 0.0 && p <= 1.0);
}

RC_GTEST_PROP(MannWhitneyProperty, ExchangingTheSetsExchangesTheAnswers, ()) {
  const auto x = SomeValues();
  const auto y = SomeValues();
  const RankTest test = MannWhitney(x, y);
  const RankTest mirrored = MannWhitney(y, x);
  RC_ASSERT(std::abs(test.a + mirrored.a - 1.0) < 1e-12);
  RC_ASSERT(std::abs(test.p_less - mirrored.p_greater) < 1e-12);
  RC_ASSERT(std::abs(test.p_two_sided - mirrored.p_two_sided) < 1e-12);
  RC_ASSERT(std::abs(ExactMannWhitney(x, y)->p_less - ExactMannWhitney(y, x)->p_greater) < 1e-12);
}

RC_GTEST_PROP(MannWhitneyProperty, OnlyTheOrderOfTheValuesMatters, ()) {
  const auto x = SomeValues();
  const auto y = SomeValues();
  const auto stretched = [](std::vector<double> values) {
    for (double& value : values) value = std::exp(value) - 1e3;
    return values;
  };
  const RankTest test = MannWhitney(x, y);
  const RankTest other = MannWhitney(stretched(x), stretched(y));
  RC_ASSERT(test.u1 == other.u1);
  RC_ASSERT(test.p_two_sided == other.p_two_sided);
  RC_ASSERT(ExactMannWhitney(x, y)->p_less == ExactMannWhitney(stretched(x), stretched(y))->p_less);
}

// All ways to deal the values to sets of the same sizes, one after the other.
RC_GTEST_PROP(ExactMannWhitneyProperty, IsTheShareOfDealsThatAreAtLeastAsExtreme, ()) {
  const auto x = SomeValues();
  const auto y = SomeValues();
  std::vector<double> all = x;
  all.insert(all.end(), y.begin(), y.end());
  const double observed = MannWhitney(x, y).u1;
  double deals = 0.0;
  double at_most = 0.0;
  double at_least = 0.0;
  for (unsigned picked = 0; picked < 1U << all.size(); ++picked) {
    if (static_cast<std::size_t>(__builtin_popcount(picked)) != x.size()) continue;
    double u = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        if ((picked >> i & 1U) == 0 || (picked >> j & 1U) != 0) continue;
        u += all[i] > all[j] ? 1.0 : (all[i] == all[j] ? 0.5 : 0.0);
      }
    }
    ++deals;
    if (u <= observed) ++at_most;
    if (u >= observed) ++at_least;
  }
  const auto exact = ExactMannWhitney(x, y);
  RC_ASSERT(std::abs(exact->p_less - at_most / deals) < 1e-12);
  RC_ASSERT(std::abs(exact->p_greater - at_least / deals) < 1e-12);
  RC_ASSERT(std::abs(exact->p_two_sided - std::min(1.0, 2.0 * std::min(at_most, at_least) / deals)) < 1e-12);
}

}  // namespace
}  // namespace gauntlet::analysis
