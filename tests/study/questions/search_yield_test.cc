#include "study/questions/search_yield.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

Experiment SmallFlocking(const std::vector<std::string>& settings) {
  return LoadExperiment("flocking", settings, BuiltInCatalogue()).value();
}

SearchYield Yield(const Experiment& experiment, std::uint64_t runs) {
  return {.place = "campaign", .experiment = experiment, .runs = runs, .confirmed = {}};
}

TEST(SearchYieldTest, ACellCountsOnceByItsSmallestCase) {
  SearchYield yield = Yield(SmallFlocking({}), 1000);
  EXPECT_EQ(CellsWith(yield, 8), 0U);
  yield.confirmed = {{.cell = 3, .obstacles = 8, .found = 10},
                     {.cell = 3, .obstacles = 2, .found = 50},
                     {.cell = 4, .obstacles = 3, .found = 20}};
  EXPECT_EQ(CellsWith(yield, 8), 2U);
  EXPECT_EQ(CellsWith(yield, 3), 2U);
  EXPECT_EQ(CellsWith(yield, 2), 1U);
  EXPECT_EQ(CellsWith(yield, 1), 0U);
}

TEST(SearchYieldTest, TheRunsUntilSoManyCellsAreThoseOfTheirFirstCases) {
  SearchYield yield = Yield(SmallFlocking({}), 1000);
  EXPECT_EQ(RunsUntil(yield, 1, 8), std::nullopt);
  yield.confirmed = {{.cell = 3, .obstacles = 2, .found = 50},
                     {.cell = 3, .obstacles = 8, .found = 10},
                     {.cell = 4, .obstacles = 3, .found = 20}};
  EXPECT_EQ(RunsUntil(yield, 1, 8), 10U);
  EXPECT_EQ(RunsUntil(yield, 2, 8), 20U);
  EXPECT_EQ(RunsUntil(yield, 3, 8), std::nullopt);
  EXPECT_EQ(RunsUntil(yield, 2, 3), 50U) << "the one of eight obstacles does not count";
}

TEST(SearchYieldTest, OnlyEqualBudgetsOfTheSameTestAreCompared) {
  const Experiment genetic = SmallFlocking({});
  const Experiment archive = SmallFlocking({"search.algorithm=archive", "seed=7"});
  const YieldSet first{"first", "genetic search", {Yield(genetic, 1000)}};
  EXPECT_TRUE(CheckSameBudget({first, {"second", "archive search", {Yield(archive, 1000)}}}).ok())
      << "seeds and searches may differ";
  EXPECT_EQ(CheckSameBudget({first, {"second", "archive search", {Yield(archive, 999)}}}).error().message,
            "campaign has 1000 runs and campaign has 999: searches are compared at equal runs");
  const Experiment other = SmallFlocking({"controller=flocking-improved"});
  EXPECT_EQ(CheckSameBudget({first, {"second", "genetic search", {Yield(other, 1000)}}}).error().message,
            "campaign and campaign do not test the same: 'controller = \"flocking\"' and 'controller = "
            "\"flocking-improved\"'");
}

}  // namespace
}  // namespace gauntlet
