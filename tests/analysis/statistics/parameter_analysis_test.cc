#include "analysis/statistics/parameter_analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

using Sets = std::vector<std::vector<double>>;

// By size, in the order of their numbers.
std::map<std::size_t, Sets> ReadConsistencySamples(const std::string& measure) {
  std::map<std::size_t, Sets> by_size;
  for (const ReferenceRow& row : ReadReference("consistency_samples.csv")) {
    Sets& sets = by_size[row.Count("SampleSize")];
    const std::size_t number = row.Count("Set");
    if (sets.size() < number) sets.resize(number);
    sets[number - 1].push_back(row.Number(measure));
  }
  return by_size;
}

TEST(ConsistencyTest, AgreesWithSpartan) {
  for (const std::string measure : {"Food", "Split"}) {
    const auto samples = ReadConsistencySamples(measure);
    std::map<std::size_t, std::vector<double>> scores;
    std::map<std::size_t, Consistency> results;
    for (const auto& [size, sets] : samples) {
      ASSERT_THAT(sets, SizeIs(20));
      results[size] = AnalyseConsistency(sets, &scores[size]);
      EXPECT_EQ(results[size].size, size);
    }
    std::size_t compared = 0;
    for (const ReferenceRow& row : ReadReference("consistency_atests.csv")) {
      const double a = scores.at(row.Count("SampleSize")).at(row.Count("Sample") - 2);
      EXPECT_NEAR(a, row.Number("ATest" + measure), 1e-12);
      EXPECT_NEAR(NormalisedA(a), row.Number("ATest" + measure + "Norm"), 1e-12);
      ++compared;
    }
    EXPECT_EQ(compared, 4U * 19U);
    for (const ReferenceRow& row : ReadReference("consistency_summary.csv")) {
      const Consistency& of_size = results.at(row.Count("samplesize"));
      EXPECT_NEAR(of_size.max_a, row.Number(measure + "MaxA"), 1e-12);
      EXPECT_NEAR(of_size.median_a, row.Number(measure + "MedianA"), 1e-12);
    }
  }
}

TEST(EnoughRepeatsTest, NeedsTheLargerSizesToBeConsistentToo) {
  std::vector<Consistency> sizes = {{1, 1.0, 1.0}, {5, 0.54, 0.66}, {20, 0.6, 0.7}, {50, 0.53, 0.59}};
  EXPECT_EQ(EnoughRepeats(sizes), 5U);
  sizes[2].max_a = 0.71;
  EXPECT_EQ(EnoughRepeats(sizes), 50U);
  sizes[3].max_a = 0.75;
  EXPECT_EQ(EnoughRepeats(sizes), std::nullopt);
}

TEST(DrawSetsTest, DrawsTheMeasuredValuesAlwaysTheSame) {
  const std::vector<double> values = {0.5, 1.5, 2.5, 3.5};
  const Sets sets = DrawSets(values, 30, 3, 1);
  EXPECT_EQ(sets, DrawSets(values, 30, 3, 1));
  EXPECT_NE(sets, DrawSets(values, 30, 3, 2));
  ASSERT_THAT(sets, SizeIs(3));
  EXPECT_THAT(sets, Each(SizeIs(30)));
  EXPECT_NE(sets[0], sets[1]);
  std::set<double> drawn;
  for (const auto& set : sets) drawn.insert(set.begin(), set.end());
  EXPECT_EQ(drawn, std::set<double>(values.begin(), values.end()));
}

// Without ties A of equal distributions has the standard deviation sqrt((2 n + 1) / (12 n^2)), whatever they
// are; drawing with replacement must not change much of that.
TEST(DrawSetsTest, GivesTheSpreadOfSetsThatWereMeasuredAnew) {
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(i);
  constexpr std::size_t kPairs = 2000;
  constexpr std::size_t kSize = 20;
  const Sets sets = DrawSets(values, kSize, 2 * kPairs, 7);
  double squares = 0.0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const double away = MannWhitney(sets[2 * i], sets[2 * i + 1]).a - 0.5;
    squares += away * away / kPairs;
  }
  EXPECT_NEAR(std::sqrt(squares), std::sqrt((2.0 * kSize + 1.0) / (12.0 * kSize * kSize)), 0.005);
}

TEST(RobustnessTest, AgreesWithSpartan) {
  std::map<std::pair<std::string, std::string>, std::vector<double>> samples;
  for (const ReferenceRow& row : ReadReference("robustness_samples.csv"))
    samples[{row.Text("speed"), row.Text("gain")}].push_back(row.Number("Food"));
  const std::vector<ReferenceRow> rows = ReadReference("robustness_atests.csv");
  Sets changed;
  for (const ReferenceRow& row : rows) changed.push_back(samples.at({row.Text("speed"), row.Text("gain")}));
  const auto results = AnalyseRobustness(samples.at({"10", "1000"}), changed);
  ASSERT_TRUE(results.ok());
  ASSERT_EQ(results->size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double a = (*results)[i].comparison.test.a;
    EXPECT_NEAR(a, rows[i].Number("ATestFood"), 1e-12);
    EXPECT_NEAR(NormalisedA(a), rows[i].Number("ATestFoodNorm"), 1e-12);
    EXPECT_EQ((*results)[i].exceeds, rows[i].Number("ATestFoodNorm") >= 0.71) << i;
    EXPECT_GE((*results)[i].p_holm, (*results)[i].comparison.p.value());
  }
}

TEST(RobustnessTest, RefusesSetsWithoutValues) {
  const Sets empty = {{}};
  const auto results = AnalyseRobustness({1.0, 2.0}, empty);
  ASSERT_FALSE(results.ok());
  EXPECT_EQ(results.error().message, "a changed parameter is empty: at least one value is needed");
}

}  // namespace
}  // namespace gauntlet::analysis
