// Covers: report/figures/shown_run.cc
#include "report/figures/run_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "report/figures/shown_run.h"
#include "tests/report/pages/facts.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(RunMapTest, FlockingsTypesStandInTwoRowsOfTen) {
  CampaignFacts facts = FactsOf("flocking");
  facts.runs = {RunOf(1, 0.0, 3), RunOf(2, 0.0, 13), RunOf(3, 0.0, 13), RunOf(4, 0.9), RunOf(5, 0.0, -1)};
  const std::vector<RunMap> maps = MapsOf(facts);
  ASSERT_FALSE(maps.empty());
  const RunMap& map = maps.front();
  EXPECT_EQ(map.name, "failure-types");
  ASSERT_EQ(map.rows.size(), 2U);
  ASSERT_EQ(map.columns.size(), 10U);
  EXPECT_EQ(map.columns.back(), "over 90");
  EXPECT_EQ(map.cells[0][3].count, 1U);
  EXPECT_EQ(map.cells[1][3].count, 2U);
  EXPECT_EQ(map.cells[1][3].meaning, "30-40 degrees apart, one cluster slower than half the other");
  EXPECT_EQ(map.Largest(), 2U);
  EXPECT_EQ(map.outcome, "2 of 20 types came up, in 3 runs; 1 more total failures without a split");
}

TEST(RunMapTest, TypesWithoutAnOrderStandBelowOneAnother) {
  CampaignFacts facts = FactsOf("foraging");
  facts.runs = {RunOf(1, 0.0, 1, {kNone, kNone})};
  const RunMap map = MapsOf(facts).front();
  EXPECT_EQ(map.rows.size(), 3U);
  EXPECT_THAT(map.columns, ElementsAre("runs"));
}

TEST(RunMapTest, AFieldLeadsToItsToughestRun) {
  CampaignFacts facts = FactsOf("flocking");
  facts.runs = {RunOf(1, 0.4, 3), RunOf(2, 0.0, 3), RunOf(3, 0.0, 3)};
  // Runs 2 and 3 are equally tough, but the case of run 3 is the tougher one.
  facts.cases = {{.search = 1, .individual = 3, .fitness = FitnessOf(0.0)},
                 {.search = 1, .individual = 2, .fitness = FitnessOf(0.5)}};
  EXPECT_EQ(MapsOf(facts).front().toughest[0][3], 3U);
}

TEST(RunMapTest, BehaviourIsCutIntoRoundRanges) {
  CampaignFacts facts = FactsOf("flocking");  // its descriptors: split_time in s, split_angle in rad
  facts.runs = {RunOf(1, 1.0, -2, {12.5, 0.0}), RunOf(2, 1.0, -2, {47.0, 3.1}),
                RunOf(3, 1.0, -2, {kNone, 1.0})};
  const std::vector<RunMap> maps = MapsOf(facts);
  ASSERT_EQ(maps.size(), 1U) << "there is no failure, so no map of failures";
  EXPECT_EQ(maps[0].name, "behaviour");
  EXPECT_EQ(maps[0].columns.front(), "10-15");
  EXPECT_EQ(maps[0].columns.back(), "45-50");
  EXPECT_EQ(maps[0].rows.back(), "0-50") << "values grow upwards";
  EXPECT_EQ(maps[0].toughest.back().front(), 1U);
  EXPECT_EQ(maps[0].toughest.front().back(), 2U);
  EXPECT_EQ(maps[0].down_name, "split_angle, degrees");
}

TEST(RunMapTest, RangesBelowZeroAreReadWithoutDoubt) {
  CampaignFacts facts = FactsOf("flocking");
  facts.runs = {RunOf(1, 1.0, -2, {-0.9, 0.0}), RunOf(2, 1.0, -2, {0.9, 0.0})};
  EXPECT_EQ(MapsOf(facts).front().columns.front(), "-1 to -0.5");
}

TEST(RunMapTest, NoRunsGiveNoMap) {
  EXPECT_THAT(MapsOf(FactsOf("flocking")), IsEmpty());
  EXPECT_THAT(MapsOf(FactsOf("task-partitioning")), IsEmpty());
}

TEST(RunsToShowTest, GoFromTheFieldsToTheToughestCasesEachOnce) {
  CampaignFacts facts = FactsOf("flocking");
  facts.runs = {RunOf(1, 0.0, 3), RunOf(2, 0.0, 13), RunOf(3, 0.5), RunOf(4, 0.6)};
  facts.cases = {{.search = 1, .individual = 2, .toughest = 2},
                 {.search = 1, .individual = 3, .toughest = 3},
                 {.search = 1, .individual = 4, .toughest = 4},
                 {.search = 1, .individual = 5, .toughest = 0}};
  const std::vector<RunMap> maps = MapsOf(facts);
  EXPECT_THAT(RunsToShow(facts, maps, 10), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(RunsToShow(facts, maps, 3), ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace gauntlet
